//! The library's brushes.

use std::sync::OnceLock;

use maulstick_brush::BrushFile;
use maulstick_brush::file::library::LIBRARY;
use maulstick_ui_kit::language::{capitalized, known};

/// The brushes of the library, in their order.
pub(crate) fn library() -> &'static [BrushFile] {
    static FILES: OnceLock<Vec<BrushFile>> = OnceLock::new();
    FILES.get_or_init(|| {
        let files = LIBRARY.iter().map(|(kind, _)| BrushFile::library(kind));
        files.filter_map(Result::ok).collect()
    })
}

/// The library's brush of a kind.
#[must_use]
pub(crate) fn of_library(kind: &str) -> Option<&'static BrushFile> {
    library().iter().find(|file| file.kind == kind)
}

/// True if a brush differs from the library's only in its width.
#[must_use]
pub(crate) fn is_of_library(file: &BrushFile) -> bool {
    let own = of_library(&file.kind).map(|own| own.scaled_to(file.head.width_mm));
    own.is_some_and(|own| own.as_ref() == Ok(file))
}

/// A kind as a word in a sentence: its first letter large.
#[must_use]
pub(crate) fn called(kind: &str) -> String {
    capitalized(known(kind))
}
