//! Folder and name that dialogs propose, by those of the painting.

use std::path::{Path, PathBuf};

use crate::dialogs::paths::pictures;
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
