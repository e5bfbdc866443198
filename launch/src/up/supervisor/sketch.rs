//! The sketch of a rig with a window: the file of a painting without a name.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use jiff::Zoned;
use maulstick_document::{Access, Document, DocumentSettings, glance};
use maulstick_rig::UserError;
use maulstick_rig::files::companion;
use maulstick_rig::sketches::{Sketch, Sketches};

/// A file so young may be of a rig that is just being started.
const YOUNG: Duration = Duration::from_secs(60);
/// The file of a blank sketch takes less, bytes.
const BLANK_BYTES: u64 = 4 << 20;

/// The file of a new sketch, called by the time at which it was begun.
///
/// # Errors
/// As [`Sketches::fresh`].
fn fresh(sketches: &Sketches) -> Result<PathBuf, UserError> {
    sketches.fresh(&Zoned::now().strftime("%Y-%m-%d %H.%M.%S").to_string())
}

/// The sketches of this user, tidied up; `None` where the system has no room for them, which is reported.
pub(in crate::up) fn of_user() -> Option<Sketches> {
    let sketches = said(Sketches::of_user())?;
    tidy(&sketches);
    Some(sketches)
}

/// The file of another sketch; where it cannot be had the painting is in memory alone, as its status says.
pub(in crate::up) fn begin(sketches: &Sketches) -> Option<PathBuf> {
    said(fresh(sketches))
}

fn said<T>(result: Result<T, UserError>) -> Option<T> {
    let warn = |fault: &UserError| {
        let place = fault.place.as_deref().unwrap_or("sketches");
        tracing::warn!("{place}: {}: the sketch is in memory alone", fault.what);
    };
    result.inspect_err(warn).ok()
}

/// Removes the sketches whose removal was announced to the painter, and blank ones. One that is open in another rig
/// stays.
fn tidy(sketches: &Sketches) {
    for sketch in sketches.notified() {
        // An open one is locked.
        if glance(&sketch.path).is_ok() {
            tracing::info!("{} goes: the newer sketches stay", sketch.path.display());
            remove(sketches, &sketch.path);
        }
    }
    let now = SystemTime::now();
    let is_old = |sketch: &Sketch| {
        now.duration_since(sketch.changed)
            .is_ok_and(|age| age > YOUNG)
    };
    for sketch in sketches.all().iter().filter(|sketch| is_old(sketch)) {
        if is_blank(&sketch.path) {
            remove(sketches, &sketch.path);
        }
    }
}

fn remove(sketches: &Sketches, path: &Path) {
    if let Err(fault) = sketches.remove(path) {
        tracing::warn!("{}: {}", fault.place.unwrap_or_default(), fault.what);
    }
}

/// True if a painting is not open, and blank. A file beyond [`BLANK_BYTES`] is not read.
fn is_blank(path: &Path) -> bool {
    let bytes = |path: &Path| std::fs::metadata(path).map_or(0, |about| about.len());
    match (bytes(path), bytes(&companion(path, "-wal"))) {
        (0, 0) => return true,
        // Its journal may contain the missing part.
        (0, _) => return false,
        (file, journal) if file + journal >= BLANK_BYTES => return false,
        _ => {}
    }
    let settings = DocumentSettings::new(path, Access::Read);
    let Ok((document, opened)) = Document::open(&settings) else {
        return false;
    };
    let sequencer = opened.map(|opened| opened.sequencer());
    let is_blank = sequencer.is_some_and(|read| read.is_ok_and(|read| read.painting().is_blank()));
    document.close().is_ok() && is_blank
}

/// Removes a sketch that is no longer painted on, if nothing is lost with it.
pub(super) fn leave(sketches: &Sketches, path: &Path, why: Leave) {
    if why == Leave::Named || is_blank(path) {
        remove(sketches, path);
    }
}

/// Reasons to leave a sketch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leave {
    /// It was saved under a name.
    Named,
    /// Another painting is on the easel, or none.
    Left,
}

#[cfg(test)]
mod tests {
    use maulstick_document::Checkpoint;
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::edits::{Fill, FillPaint};
    use maulstick_painting::{Painting, PaintingSetup, Sequencer};
    use maulstick_types::scene::CANVAS;
    use maulstick_types::values::FilmThickness;

    use super::*;

    /// A painting in a file, painted on or blank, that was left ten minutes ago; it is open while the document lives.
    fn painting(path: &Path, is_painted: bool) -> Document {
        let settings = DocumentSettings::new(path, Access::Paint);
        let (document, _) = Document::open(&settings).expect("new");
        let setup = PaintingSetup {
            cells: [64, 64],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("the paints that come with it");
        let pager = document.pager().clone();
        let painting = Painting::paged(&setup, library, pager).expect("a painting");
        let mut sequencer = Sequencer::new(painting);
        if is_painted {
            let paint = FillPaint::Mixture {
                mixture: "Titanium White".parse().expect("a paint"),
            };
            let thickness = FilmThickness::new(4e-5).expect("in range");
            let fill = Fill {
                paint,
                thickness,
                surface: CANVAS,
            };
            sequencer.edit(fill).expect("laid");
        }
        document.write_checkpoint(Checkpoint::of(&mut sequencer, 0));
        document
    }

    fn age(path: &Path) {
        let file = std::fs::File::options().append(true).open(path);
        let then = SystemTime::now() - 10 * YOUNG;
        file.expect("there").set_modified(then).expect("set");
    }

    #[test]
    fn what_was_never_painted_on_goes_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let sketches = Sketches::in_folder(folder.path());
        let named = |name: &str| sketches.fresh(name).expect("free");
        let (blank, painted, empty, young) = (
            named("blank"),
            named("painted"),
            named("empty"),
            named("young"),
        );
        painting(&blank, false).close().expect("closed");
        painting(&painted, true).close().expect("closed");
        for path in [&empty, &young] {
            std::fs::write(path, "").expect("written");
        }
        for path in [&blank, &painted, &empty] {
            age(path);
        }
        tidy(&sketches);
        assert!(!blank.exists() && !empty.exists());
        assert!(painted.exists() && young.exists());
    }
}
