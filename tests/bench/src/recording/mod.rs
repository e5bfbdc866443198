//! A recording of ten minutes, opened and sought in, beside the reader of the `mcap` crate.

mod sample;

use std::fs::File;
use std::io::{Read as _, Seek as _};
use std::os::unix::fs::FileExt as _;
use std::path::Path;
use std::time::Instant;

use maulstick_rig::UserError;
use maulstick_streams::Recording;
use mcap::Summary;
use mcap::sans_io::indexed_reader::{IndexedReadEvent, IndexedReader, IndexedReaderOptions};
use mcap::sans_io::summary_reader::{SummaryReadEvent, SummaryReader};

use sample::{SECONDS, write};

use crate::report::{Report, quantile, sorted};

/// Openings, and places that are sought.
const ROUNDS: u64 = 41;
const OPEN_MS: f64 = 50.0;
const SEEK_MS: f64 = 5.0;
const PEER: &str = "mcap";

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}

fn ms(since: Instant) -> f64 {
    1e3 * since.elapsed().as_secs_f64()
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let folder = tempfile::tempdir().map_err(fault)?;
    let path = folder.path().join("session.mcap");
    write(&path)?;
    let megabytes = std::fs::metadata(&path).map_err(fault)?.len() as f64 * 1e-6;
    report.row("recording.size", megabytes, "MB");
    let (mut opened, mut sought) = (Vec::new(), Vec::new());
    for round in 0..ROUNDS {
        // Places in no order, none of them twice.
        let second = (round * 229) % SECONDS;
        let (own, first_ns) = ours(&path, second)?;
        let (theirs, their_first_ns) = theirs(&path, second)?;
        if first_ns != their_first_ns {
            return Err(fault(format!(
                "the first messages at {second} s are not the same: {first_ns} and {their_first_ns} ns"
            )));
        }
        opened.push((own[0], theirs[0]));
        sought.push((own[1], theirs[1]));
    }
    let median =
        |pairs: &[(f64, f64)]| quantile(&sorted(pairs.iter().map(|pair| pair.0).collect()), 0.5);
    let [open_ms, seek_ms] = [median(&opened), median(&sought)];
    report.paired("recording.open", "ms", PEER, &opened);
    report.paired("recording.seek", "ms", PEER, &sought);
    report.beside("recording.open.target", open_ms, "ms", ("target", OPEN_MS));
    report.beside("recording.seek.target", seek_ms, "ms", ("target", SEEK_MS));
    Ok(())
}

/// Time to open it and to seek in it, ms, and the time of the first message there, ns.
fn ours(path: &Path, second: u64) -> Result<([f64; 2], u64), UserError> {
    let begun = Instant::now();
    let mut recording = Recording::open(path)?;
    let opened = ms(begun);
    let begun = Instant::now();
    let (mut first_ns, from_ns) = (0, second * 1_000_000_000);
    recording.messages([from_ns, u64::MAX], &mut |message| {
        first_ns = message.arrived_ns;
        false
    })?;
    Ok(([opened, ms(begun)], first_ns))
}

/// The same of the peer.
fn theirs(path: &Path, second: u64) -> Result<([f64; 2], u64), UserError> {
    let begun = Instant::now();
    let mut file = File::open(path).map_err(fault)?;
    let summary = summary(&mut file)?;
    let opened = ms(begun);
    let begun = Instant::now();
    let options = IndexedReaderOptions::new().starting_at(second * 1_000_000_000);
    let mut reader = IndexedReader::new_with_options(&summary, options).map_err(fault)?;
    while let Some(event) = reader.next_event() {
        match event.map_err(fault)? {
            IndexedReadEvent::ReadChunkRequest { offset, length } => {
                let mut chunk = vec![0; length];
                file.read_exact_at(&mut chunk, offset).map_err(fault)?;
                reader
                    .insert_chunk_record_data(offset, &chunk)
                    .map_err(fault)?;
            }
            IndexedReadEvent::Message { header, .. } => {
                return Ok(([opened, ms(begun)], header.log_time));
            }
        }
    }
    Err(fault("the recording has no such message"))
}

fn summary(file: &mut File) -> Result<Summary, UserError> {
    let mut reader = SummaryReader::new();
    while let Some(event) = reader.next_event() {
        match event.map_err(fault)? {
            SummaryReadEvent::ReadRequest(bytes) => {
                let read = file.read(reader.insert(bytes)).map_err(fault)?;
                reader.notify_read(read);
            }
            SummaryReadEvent::SeekRequest(to) => {
                reader.notify_seeked(file.seek(to).map_err(fault)?);
            }
        }
    }
    reader.finish().ok_or_else(|| fault("it has no summary"))
}
