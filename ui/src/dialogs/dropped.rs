//! Files dropped on the window, by kind.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use eframe::egui::{Align2, Area, Context, Frame, Id, Order, RichText};
use maulstick_brush::BrushFile;
use maulstick_exchange::PictureKind;
use maulstick_exchange::read_image::kind::HEAD;
use maulstick_types::limits::BRUSH_FILE_MAX;
use maulstick_ui_kit::language::translated;

use crate::dialogs::paths;
use crate::sessions::RECORDING;

/// The kinds of files that may be dropped.
pub(crate) const KINDS: &str = tr_noop!(
    "Drop a painting (.maul), a recording (.mcap), a picture to look at (PNG, JPEG, TIFF, OpenEXR, Radiance, OpenRaster) or a brush (.toml)."
);

/// A dropped file, by its kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Dropped {
    /// A painting: it is opened.
    Painting(PathBuf),
    /// A picture: it is pinned beside the canvas.
    Picture(PathBuf),
    /// A recording, or a take: it is played where the painter confirms it.
    Recording(PathBuf),
    /// A brush file: the brush in hand becomes it.
    Brush(Box<BrushFile>),
    Nothing {
        /// Description of the file.
        what: String,
        help: String,
    },
}

/// Kind of a file, by its name and its first bytes.
#[must_use]
pub(crate) fn found(path: &Path) -> Dropped {
    let name = paths::name(path);
    let nothing = |what: String, help: &str| Dropped::Nothing {
        what,
        help: help.to_owned(),
    };
    if path.is_dir() {
        return nothing(tr!("{name} is a folder", name), translated(KINDS));
    }
    let head = match head(path) {
        Ok(head) => head,
        Err(error) => {
            return nothing(
                tr!("{name} cannot be read: {error}", name, error),
                tr!("Check that it exists and that you may read it."),
            );
        }
    };
    let begins = |magic: &[u8]| head.starts_with(magic);
    let ending = paths::ending(path);
    if begins(b"SQLite format 3\0") || ending == paths::PAINTING {
        return Dropped::Painting(path.to_owned());
    }
    if PictureKind::of(&head).is_some() || PictureKind::is_named(path) {
        return Dropped::Picture(path.to_owned());
    }
    match ending.as_str() {
        "toml" => brush(path, &name),
        RECORDING => Dropped::Recording(path.to_owned()),
        "" => nothing(
            tr!("{name} is none that can be opened", name),
            translated(KINDS),
        ),
        ending => nothing(
            tr!("A .{ending} file cannot be opened", ending),
            translated(KINDS),
        ),
    }
}

/// The first bytes of a file.
fn head(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

fn brush(path: &Path, name: &str) -> Dropped {
    let mut toml = String::new();
    let read = File::open(path).and_then(|file| {
        file.take(BRUSH_FILE_MAX as u64 + 1)
            .read_to_string(&mut toml)
    });
    let wrong = match read {
        Err(error) => error.to_string(),
        Ok(bytes) if bytes > BRUSH_FILE_MAX => tr!("it has more than a megabyte").to_owned(),
        Ok(_) => match BrushFile::parse(&toml) {
            Ok(file) => return Dropped::Brush(Box::new(file)),
            Err(error) => error.to_string(),
        },
    };
    Dropped::Nothing {
        what: tr!("{name} is no brush that can be used: {wrong}", name, wrong),
        help: tr!("docs/brushes.md describes brush files.").to_owned(),
    }
}

/// Shows the effect of dropping the file over the window.
pub(crate) fn hint(context: &Context) {
    let hovered = context.input(|input| {
        let first = input.raw.hovered_files.first();
        first.map(|file| (file.path.clone(), input.raw.hovered_files.len()))
    });
    let Some((path, count)) = hovered else {
        return;
    };
    let words = match (path.as_deref().map(paths::ending).as_deref(), count) {
        (_, 2..) => tr!("One file at a time."),
        (Some(paths::PAINTING), _) => tr!("Let go to open the painting."),
        (Some(RECORDING), _) => tr!("Let go to play the recording."),
        (Some("toml"), _) => tr!("Let go to take this brush into the hand."),
        (Some(ending), _) if PictureKind::ENDINGS.contains(&ending) => {
            tr!("Let go to pin the picture beside the canvas.")
        }
        _ => translated(KINDS),
    };
    Area::new(Id::unique("dropping"))
        .order(Order::Tooltip)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .interactable(false)
        .show(context, |ui| {
            Frame::window(ui.style()).show(ui, |ui| {
                ui.label(RichText::new(words).heading());
            });
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_what_its_bytes_or_its_name_say() {
        let folder = tempfile::tempdir().expect("a folder");
        let put = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).expect("written");
            path
        };
        let painting = put("sea", b"SQLite format 3\0more");
        assert_eq!(found(&painting), Dropped::Painting(painting));
        let picture = put("photo", b"\xff\xd8\xff\xe0more");
        assert_eq!(found(&picture), Dropped::Picture(picture));
        let named = put("scan.TIF", b"");
        assert_eq!(found(&named), Dropped::Picture(named));
        let layers = [&b"PK\x03\x04"[..], &[0; 26], b"mimetypeimage/openraster"].concat();
        let layered = put("layers", &layers);
        assert_eq!(found(&layered), Dropped::Picture(layered));
        let light = put("light.EXR", b"");
        assert_eq!(found(&light), Dropped::Picture(light));
        let take = put("sea.mcap", b"");
        assert_eq!(found(&take), Dropped::Recording(take));
        let round = BrushFile::library_text("round").expect("a brush");
        match found(&put("round.toml", round.as_bytes())) {
            Dropped::Brush(file) => assert_eq!(file.kind, "round"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_cannot_be_opened_is_said_with_what_can() {
        let folder = tempfile::tempdir().expect("a folder");
        let refused = |name: &str, bytes: &[u8], words: &[&str]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).expect("written");
            let Dropped::Nothing { what, help } = found(&path) else {
                panic!("{name} is something");
            };
            for word in words {
                assert!(what.contains(word) || help.contains(word), "{what} {help}");
            }
        };
        refused("song.mp3", b"ID3", &[".mp3", ".maul", "PNG", ".toml"]);
        refused("notes", b"words", &["notes", ".maul"]);
        refused("text.docx", b"PK\x03\x04words", &[".docx", "OpenRaster"]);
        refused("b.toml", b"name = 7", &["b.toml", "docs/brushes.md"]);
        refused("c.toml", b"\xff\xfe", &["c.toml"]);
        refused("d.toml", &vec![b' '; BRUSH_FILE_MAX + 1], &["megabyte"]);
        for path in [folder.path().to_owned(), folder.path().join("none.toml")] {
            assert!(matches!(found(&path), Dropped::Nothing { .. }), "{path:?}");
        }
    }
}
