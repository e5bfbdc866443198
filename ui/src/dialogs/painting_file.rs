//! The painting's file: folder and name for dialogs, and results of commands about it.

use std::path::{Path, PathBuf};

use maulstick_types::command::{Command, FileCommand, RigCommand};

use crate::dialogs::paths::{self, pictures};
use crate::widgets::context::PanelContext;

/// The folder in which a dialog begins: that of the painting, or of the one before.
pub(super) fn folder(work: &PanelContext<'_>) -> PathBuf {
    let status = work.rig.live.paint.as_ref().map(|node| &node.status);
    let open = status.filter(|status| !status.path.is_empty() && !work.rig.is_sketch());
    let open = open.map(|status| PathBuf::from(&status.path));
    let known = open.as_ref().or(work.preferences.recent.first());
    let folder = known.and_then(|path| path.parent());
    folder
        .filter(|folder| folder.is_dir())
        .map_or_else(pictures, Path::to_owned)
}

/// File stem of the painting.
pub(super) fn stem(work: &PanelContext<'_>) -> String {
    let node = work
        .rig
        .live
        .paint
        .as_ref()
        .filter(|_| !work.rig.is_sketch());
    let status = node.map(|node| &node.status);
    let stem = status.and_then(|status| Path::new(&status.path).file_stem());
    stem.map_or_else(
        || tr!("Painting").to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

/// True for a command that opens another painting, for which nodes are restarted.
pub(super) fn switches(command: &Command) -> bool {
    matches!(
        command,
        Command::Rig(RigCommand::Open { .. } | RigCommand::New { .. } | RigCommand::SaveAs(_))
    )
}

/// Result of a file command in words; `None` for any other command.
pub(super) fn done(command: &Command) -> Option<String> {
    let file = |path: &str| paths::shown(Path::new(path));
    Some(match command {
        Command::Rig(RigCommand::Open { path, .. }) => tr!("Opened {file}.", file = file(path)),
        Command::Rig(RigCommand::New { path, .. }) => match path {
            Some(path) => tr!("A new painting, kept in {file}.", file = file(path)),
            None => tr!("A new sketch, without a name for now.").to_owned(),
        },
        Command::Rig(RigCommand::SaveAs(save_as)) | Command::File(FileCommand::SaveAs(save_as)) => {
            tr!("The painting is in {file} now.", file = file(&save_as.path))
        }
        Command::File(FileCommand::Export(order)) => {
            tr!("Exported to {file}.", file = file(&order.path))
        }
        Command::File(FileCommand::StopExport) => {
            tr!("The export has ended without a file.").to_owned()
        }
        Command::Rig(RigCommand::PutDevice { .. } | RigCommand::RemoveDevice { .. })
        | Command::File(FileCommand::Copy { .. })
        | Command::Edit(_)
        | Command::Take(_)
        | Command::Brush(_)
        | Command::Session(_) => return None,
    })
}
