//! `maulstick record`: the streams of a running rig into a file, by a process of its own that no node waits for.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_streams::{RecordingWriter, Traffic};
use mcap::McapError;

use super::listener::{Heard, Listener};
use crate::commands::say;
use crate::commands::session::Target;
use crate::outputs::{UsedFile, check_outputs};

/// Options of `maulstick record`.
#[derive(Args, Clone, Debug)]
pub struct RecordOptions {
    /// Recording to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Topics to record, such as stylus/**: * stands for one part, ** for any number
    #[arg(long, value_name = "TOPIC", default_value = "**")]
    topic: String,
    /// End after so long, s; otherwise at Ctrl-C, or with the rig
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Begin another file after so many megabytes
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    split_mb: Option<u64>,
    /// Begin another file after so long, s
    #[arg(long, value_name = "S")]
    split_seconds: Option<f64>,
    #[command(flatten)]
    target: Target,
}

/// At most so much is lost with this process.
const FLUSH: Duration = Duration::from_millis(500);

/// Records until Ctrl-C, the end of the time, or that of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the file cannot be written: what was written until then can be read.
pub fn run(options: &RecordOptions) -> Result<i32, UserError> {
    let bounded = |name: &str, seconds: Option<f64>| match seconds {
        Some(s) if !(0.1..=1e7).contains(&s) => {
            Err(UserError::usage(format!("--{name} {s} is out of range"))
                .help("choose .1 s to 10,000,000 s"))
        }
        seconds => Ok(seconds.map(Duration::from_secs_f64)),
    };
    let lasts = bounded("seconds", options.seconds)?;
    let split_after = bounded("split-seconds", options.split_seconds)?;
    let output = UsedFile::new("the recording", &options.output).of(Kind::Take);
    check_outputs(&[output], &[])?;
    let mut listener = Listener::open(&options.target, &options.topic)?;
    say!(
        "recording into {}; Ctrl-C ends it",
        options.output.display()
    );
    let begun = Instant::now();
    let mut part = Part::begin(&options.output, &listener)?;
    let mut number = 1;
    let mut flush_at = begun + FLUSH;
    while !listener.is_over() && lasts.is_none_or(|lasts| begun.elapsed() < lasts) {
        if let Some(heard) = listener.next(flush_at) {
            part.write(&heard)?;
        }
        if Instant::now() < flush_at {
            continue;
        }
        flush_at = Instant::now() + FLUSH;
        part.flush()?;
        if !listener.has_rig() {
            break;
        }
        let is_full = options
            .split_mb
            .is_some_and(|mb| part.bytes >= mb * 1_000_000)
            || split_after.is_some_and(|after| part.begun.elapsed() >= after);
        if is_full {
            part.finish(&listener)?;
            number += 1;
            part = Part::begin(&numbered(&options.output, number), &listener)?;
        }
    }
    part.finish(&listener)?;
    Ok(0)
}

/// The name of a further file.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = match path.extension() {
        Some(ending) => format!("{stem}-{number}.{}", ending.to_string_lossy()),
        None => format!("{stem}-{number}"),
    };
    path.with_file_name(name)
}

/// A file of a recording.
struct Part {
    path: PathBuf,
    writer: RecordingWriter<BufWriter<File>>,
    traffic: Traffic,
    messages: u64,
    /// Bytes of its messages, before they are compressed.
    bytes: u64,
    begun: Instant,
    /// What the listener had dropped before.
    dropped_before: u64,
}

impl Part {
    /// Begins a file, with what it takes to understand it later.
    fn begin(path: &Path, listener: &Listener) -> Result<Self, UserError> {
        let writing = |error: std::io::Error| UserError::writing(path, &error);
        let file = File::create(path).map_err(writing)?;
        let member = &listener.member;
        let settings = std::fs::read(member.folder.join(CONFIG_FILE)).unwrap_or_default();
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let facts = [
            (
                "rig",
                member.topics.prefix().trim_end_matches('/').to_owned(),
            ),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("unix_ns", now.as_nanos().to_string()),
            ("rig_ns", member.bus.now_ns().to_string()),
        ];
        let facts: BTreeMap<String, String> = facts
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text))
            .collect();
        let begin = || {
            let mut writer = RecordingWriter::begin(BufWriter::new(file))?;
            writer.note("recording", facts)?;
            writer.attach("rig.toml", "application/toml", &settings)?;
            Ok(writer)
        };
        Ok(Self {
            writer: begin().map_err(|error| fault(path, error))?,
            path: path.to_owned(),
            traffic: Traffic::default(),
            messages: 0,
            bytes: 0,
            begun: Instant::now(),
            dropped_before: listener.dropped(),
        })
    }

    fn write(&mut self, heard: &Heard) -> Result<(), UserError> {
        let message = &heard.message;
        self.writer
            .write(
                &heard.topic,
                &message.header,
                &heard.bytes,
                message.arrived_ns,
            )
            .map_err(|error| fault(&self.path, error))?;
        self.traffic.add(&heard.topic, message);
        self.messages += 1;
        self.bytes += heard.bytes.len() as u64;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), UserError> {
        self.writer
            .flush()
            .map_err(|error| fault(&self.path, error))
    }

    /// Ends it, with what is missing in it.
    fn finish(mut self, listener: &Listener) -> Result<(), UserError> {
        let lost: u64 = self
            .traffic
            .streams()
            .map(|(_, _, stream)| stream.lost)
            .sum();
        let dropped = listener.dropped() - self.dropped_before;
        let counts = [
            ("messages", self.messages),
            ("lost", lost),
            ("dropped", dropped),
            ("foreign", listener.foreign),
        ];
        let counts = counts.map(|(name, count)| (name.to_owned(), count.to_string()));
        let path = self.path;
        let end = || {
            self.writer.note("counts", counts.into_iter().collect())?;
            self.writer.finish()
        };
        end().map_err(|error| fault(&path, error))?;
        let on_disk = std::fs::metadata(&path).map_or(0, |data| data.len());
        say!(
            "{}: {} messages in {:.1} s, {:.1} MB; {lost} lost on the way, {dropped} of them here",
            path.display(),
            self.messages,
            self.begun.elapsed().as_secs_f64(),
            on_disk as f64 * 1e-6
        );
        Ok(())
    }
}

/// Why a file could not be written.
fn fault(path: &Path, error: McapError) -> UserError {
    let error = match error {
        McapError::Io(error) => error,
        other => std::io::Error::other(other),
    };
    UserError::writing(path, &error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn further_files_are_numbered_before_their_ending() {
        let named = |path: &str| numbered(Path::new(path), 2);
        assert_eq!(
            named("/a/b.c/session.mcap"),
            Path::new("/a/b.c/session-2.mcap")
        );
        assert_eq!(named("session"), Path::new("session-2"));
    }
}
