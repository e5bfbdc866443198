//! Files of the paint node: its document, exports, snapshots.

mod document_home;

use std::path::Path;

use maulstick_appearance::picture::Export;
use maulstick_document::DocumentError;
use maulstick_painting::Sequencer;
use maulstick_types::command::{CommandRequest, FileCommand, Outcome};
use maulstick_types::paint::ExportStatus;

use document_home::DocumentHome;

use crate::exporter::{Asker, Exporter};
use crate::refusal::Refusal;
use crate::snapshots::{Snapshot, Snapshots};

/// The document, and pictures that are written beside the painting.
#[derive(Debug, Default)]
pub(super) struct Files {
    home: DocumentHome,
    exporter: Exporter,
    snapshots: Snapshots,
    /// Conversion of pictures from the working space.
    export: Export,
}

impl Files {
    /// Sets the conversion of pictures from the working space.
    pub(super) fn set_export(&mut self, export: Export) {
        self.export = export;
    }

    /// The document.
    pub(super) fn home(&self) -> &DocumentHome {
        &self.home
    }

    /// The document.
    pub(super) fn home_mut(&mut self) -> &mut DocumentHome {
        &mut self.home
    }

    /// Progress of the export.
    pub(super) fn export_status(&self, now_ns: u64) -> Option<ExportStatus> {
        self.exporter.status(now_ns)
    }

    /// Begins what a command about files asks for.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn begin(
        &mut self,
        asked: &CommandRequest,
        command: &FileCommand,
        sequencer: &mut Sequencer,
        now_ns: u64,
    ) -> Result<Outcome, Refusal> {
        if asked.after.is_some() {
            return Err(Refusal::say(
                "this command has no place in the journal",
                "send the command without a position in the journal",
            ));
        }
        let asker = (asked.client, asked.number);
        match command {
            FileCommand::Export(order) => {
                let still = sequencer.painting_mut().still();
                self.exporter
                    .begin(asker, order, still, &self.export, now_ns)?;
                Ok(Outcome::Waiting)
            }
            FileCommand::SaveAs(asked) => self.home.save_as(asker, asked, sequencer),
            FileCommand::Copy { path } => self.home.copy(asker, Path::new(path.as_str())),
            FileCommand::StopExport => {
                self.exporter.stop()?;
                Ok(Outcome::done(""))
            }
        }
    }

    /// Queues a snapshot of the painting as it is, and of its ledger if a path is given for that.
    ///
    /// # Errors
    /// [`Refusal`] where too many wait.
    pub(super) fn snapshot(
        &mut self,
        asker: Asker,
        (path, ledger): (&str, Option<&str>),
        sequencer: &mut Sequencer,
    ) -> Result<(), Refusal> {
        let painting = sequencer.painting_mut();
        self.snapshots.add(Snapshot {
            asker,
            path: path.into(),
            ledger: ledger.map(|path| (path.into(), painting.report())),
            still: painting.still(),
            export: self.export.clone(),
        })
    }

    /// True while the snapshot that this client requested is pending.
    pub(super) fn has_snapshot(&self, asker: Asker) -> bool {
        self.snapshots.has(asker)
    }

    /// Outcome of an export that has ended.
    pub(super) fn poll_export(&mut self) -> Option<(Asker, Outcome)> {
        self.exporter.ended()
    }

    /// Begins the next snapshot; outcome of one that has failed.
    pub(super) fn poll_snapshots(&mut self) -> Option<(Asker, Outcome)> {
        self.snapshots.poll()
    }

    /// Writes everything pending and closes the document.
    ///
    /// # Errors
    /// As [`DocumentHome::close`].
    pub(super) fn close(&mut self, sequencer: &mut Sequencer) -> Result<(), DocumentError> {
        // Snapshots may show pages that only the document has.
        drop(std::mem::take(&mut self.snapshots));
        self.home.close(sequencer)
    }
}
