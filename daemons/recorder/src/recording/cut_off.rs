//! Recordings that were cut off as their recorder was killed: written anew, as far as they are intact.

use std::fs::File;
use std::io::{Error, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_streams::recovery::DamagedRecording;
use mcap::MAGIC;

use super::ring::ENDING;
use crate::error::RecorderError;

/// A recording that was cut off, and is whole now: a note says where it was damaged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CutOff {
    /// Its file.
    pub file: PathBuf,
    /// Number of its messages.
    pub messages: u64,
}

/// Completes the recordings of a folder that were cut off, in the order of their names; those that are being written
/// stay as they are, and so does what no recorder has written. One that cannot be completed is an error of its own.
///
/// # Errors
/// A [`RecorderError`] where the folder cannot be read.
pub fn complete_in(folder: &Path) -> Result<Vec<Result<CutOff, RecorderError>>, RecorderError> {
    let reading = |error: Error| UserError::reading(folder, &error);
    let entries = std::fs::read_dir(folder).map_err(reading)?;
    let paths = entries.map(|entry| Ok(entry.map_err(reading)?.path()));
    let mut paths: Vec<PathBuf> = paths.collect::<Result<_, UserError>>()?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
    paths.sort();
    Ok(paths
        .iter()
        .filter_map(|path| complete(path).transpose())
        .collect())
}

fn complete(path: &Path) -> Result<Option<CutOff>, RecorderError> {
    let locked = cut_off(path).map_err(|error| UserError::reading(path, &error))?;
    let Some(_locked) = locked else {
        return Ok(None);
    };
    let recording = DamagedRecording::open(path)?;
    if !recording.is_of_a_recorder() {
        return Ok(None);
    }
    let mut messages = 0;
    write_whole(path, Kind::Take, |file| {
        messages = recording.recover(file).map_err(Error::other)?.messages;
        Ok(())
    })
    .map_err(|error| UserError::writing(path, &error))?;
    Ok(Some(CutOff {
        file: path.to_owned(),
        messages,
    }))
}

/// The file, locked, if it begins as a recording, does not end as one, and nobody writes it.
fn cut_off(path: &Path) -> std::io::Result<Option<File>> {
    let mut file = File::open(path)?;
    if file.try_lock().is_err() {
        return Ok(None);
    }
    if file.metadata()?.len() < MAGIC.len() as u64 {
        return Ok(None);
    }
    let ends = [SeekFrom::Start(0), SeekFrom::End(-(MAGIC.len() as i64))].map(|at| {
        let mut bytes = [0; MAGIC.len()];
        file.seek(at)?;
        file.read_exact(&mut bytes)?;
        Ok::<bool, Error>(bytes == MAGIC)
    });
    let [begins, is_whole] = ends;
    Ok((begins? && !is_whole?).then_some(file))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use maulstick_streams::{Recording, RecordingWriter};
    use maulstick_types::stylus::StylusSample;
    use maulstick_types::{Flags, Header, Origin, encode};

    use super::*;

    /// Writes a recording of ten samples; without an end it is as after a crash.
    fn record(path: &Path, notes: &[&str], has_end: bool) -> File {
        let file = File::create(path).expect("created");
        let mut writer = RecordingWriter::begin(file.try_clone().expect("open")).expect("begun");
        for note in notes {
            writer.note(note, BTreeMap::new()).expect("noted");
        }
        let hand = Origin {
            source: 1,
            epoch: 1,
        };
        for seq in 0..10 {
            let bytes = encode(&hand, Flags::NONE, seq, seq, seq, &StylusSample::away());
            let bytes = bytes.expect("short");
            let header = Header::from_bytes(&bytes).expect("whole");
            let written = writer.write("stylus/pen/sample", &header, &bytes, seq);
            written.expect("written");
        }
        writer.flush().expect("flushed");
        if has_end {
            writer.finish().expect("ended");
        } else {
            // Dropped, a writer would end its file.
            std::mem::forget(writer);
        }
        file
    }

    #[test]
    fn a_recording_whose_recorder_was_killed_is_completed_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        record(&path("cut.mcap"), &["recording"], false);
        record(&path("foreign.mcap"), &[], false);
        record(&path("whole.mcap"), &["recording"], true);
        let written = record(&path("written.mcap"), &["recording"], false);
        written.lock().expect("locked");
        std::fs::write(path("short.mcap"), [0; 3]).expect("written");
        let bytes = |name: &str| std::fs::read(path(name)).expect("there");
        let others = ["foreign.mcap", "whole.mcap", "written.mcap", "short.mcap"];
        let before = others.map(bytes);

        let cut = CutOff {
            file: path("cut.mcap"),
            messages: 10,
        };
        assert_eq!(complete_in(folder.path()), Ok(vec![Ok(cut.clone())]));
        let recording = Recording::open(&cut.file).expect("a recording");
        assert!(recording.notes().contains_key("recovered"));
        assert_eq!(recording.damage(), None);
        assert_eq!(others.map(bytes), before);
        assert_eq!(complete_in(folder.path()), Ok(vec![]), "it is whole");

        record(&path("cut.mcap"), &["recording"], false);
        std::fs::create_dir(path("a.mcap")).expect("made");
        let found = complete_in(folder.path()).expect("read");
        assert!(matches!(&found[..], [Err(_), Ok(found)] if *found == cut));
    }
}
