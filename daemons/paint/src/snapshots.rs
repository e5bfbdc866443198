//! Snapshots as files: on a thread of their own, one after the other, of the painting as it was when each was
//! requested. A slow disk delays no brush.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;

use maulstick_appearance::picture::{Depth, Export};
use maulstick_exchange::{ExchangeError, write_lit_png};
use maulstick_files::{Kind, write_whole};
use maulstick_painting::Painting;
use maulstick_painting::ledger::LedgerReport;
use maulstick_types::command::Outcome;
use maulstick_types::scene::CANVAS;

use crate::exporter::{Asker, unwritable};
use crate::refusal::Refusal;

/// Snapshots that wait, at most: each keeps the tiles that it shows.
const WAITING: usize = 16;

/// Snapshots that are written, and those that wait.
#[derive(Debug, Default)]
pub struct Snapshots {
    waiting: VecDeque<Snapshot>,
    writing: Option<(Asker, JoinHandle<Result<(), Refusal>>)>,
}

/// A picture of the canvas and, if asked, the ledger, to be written.
#[derive(Debug)]
pub struct Snapshot {
    /// The client that requested it.
    pub asker: Asker,
    /// The painting, which is not changed any more.
    pub still: Painting,
    /// Path of the picture.
    pub path: PathBuf,
    /// The ledger, and where it goes.
    pub ledger: Option<(PathBuf, LedgerReport)>,
    /// Conversion of the picture from the working space.
    pub export: Export,
}

impl Snapshots {
    /// Adds a snapshot behind those that wait.
    ///
    /// # Errors
    /// [`Refusal`] where too many wait.
    pub fn add(&mut self, snapshot: Snapshot) -> Result<(), Refusal> {
        if self.waiting.len() >= WAITING {
            return Err(Refusal::say(
                format!("{WAITING} pictures wait to be written already"),
                "ask again when the disk has caught up",
            ));
        }
        self.waiting.push_back(snapshot);
        Ok(())
    }

    /// True while the snapshot that this client requested is pending.
    #[must_use]
    pub fn has(&self, asker: Asker) -> bool {
        let waits = self.waiting.iter().map(|snapshot| snapshot.asker);
        let writing = self.writing.iter().map(|(asker, _)| *asker);
        waits.chain(writing).any(|other| other == asker)
    }

    /// Begins the next one where none is being written, and says whose has failed since the last call.
    pub fn poll(&mut self) -> Option<(Asker, Outcome)> {
        let failed = match self.writing.take_if(|(_, thread)| thread.is_finished()) {
            Some((asker, thread)) => match thread.join() {
                Ok(Ok(())) => None,
                Ok(Err(refusal)) => Some((asker, refusal)),
                Err(_) => Some((
                    asker,
                    Refusal::say(
                        "internal error: the thread that writes pictures panicked",
                        "see the messages of the rig, and report the fault",
                    ),
                )),
            },
            None => None,
        };
        let failed = failed.or_else(|| self.begin_next());
        failed.map(|(asker, refusal)| (asker, refusal.into()))
    }

    /// Begins the next one; on failure says whose.
    fn begin_next(&mut self) -> Option<(Asker, Refusal)> {
        if self.writing.is_some() {
            return None;
        }
        let snapshot = self.waiting.pop_front()?;
        let asker = snapshot.asker;
        let thread = std::thread::Builder::new().name("snapshot".into());
        match thread.spawn(move || snapshot.write()) {
            Ok(thread) => {
                self.writing = Some((asker, thread));
                None
            }
            Err(error) => {
                let what = format!("no picture can be written: {error}");
                Some((asker, Refusal::say(what, "try again")))
            }
        }
    }
}

impl Drop for Snapshots {
    fn drop(&mut self) {
        // Requested snapshots are written before the node ends.
        if let Some((_, thread)) = self.writing.take() {
            thread.join().ok();
        }
        for snapshot in self.waiting.drain(..) {
            snapshot.write().ok();
        }
    }
}

impl Snapshot {
    fn write(mut self) -> Result<(), Refusal> {
        write(&mut self.still, &self.path, self.ledger, &self.export)
            .map_err(|(path, error)| unwritable(&path, &error))
    }
}

/// Writes the canvas and, if asked, the ledger; on failure says which file.
///
/// # Errors
/// The path and what the system says.
pub fn write_snapshot(
    painting: &mut Painting,
    path: &Path,
    ledger: Option<&Path>,
    export: &Export,
) -> Result<(), (PathBuf, std::io::Error)> {
    let ledger = ledger.map(|to| (to.to_owned(), painting.report()));
    write(painting, path, ledger, export)
}

fn write(
    painting: &mut Painting,
    path: &Path,
    ledger: Option<(PathBuf, LedgerReport)>,
    export: &Export,
) -> Result<(), (PathBuf, std::io::Error)> {
    if let Some((to, report)) = ledger {
        write_whole(&to, Kind::Ledger, |file| {
            Ok(serde_json::to_writer_pretty(file, &report)?)
        })
        .map_err(|error| (to, error))?;
    }
    write_whole(path, Kind::Png, |file| {
        // Row after row: the whole picture of a vast canvas is larger than most memories.
        let look = (export, Depth::Eight);
        write_lit_png(painting, CANVAS, look, file, &mut |_, _| {}).map_err(|error| match error {
            ExchangeError::Write(error) => error,
            error => std::io::Error::other(error.to_string()),
        })
    })
    .map_err(|error| (path.to_owned(), error))
}
