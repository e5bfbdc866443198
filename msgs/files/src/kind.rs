//! Kinds of files by their first bytes: a command writes over files of its own kind, and over no others.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use crate::open::read_head;

/// A kind of file that commands write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Picture, height map or gloss map, PNG.
    Png,
    /// OpenEXR.
    Exr,
    /// OpenRaster.
    Ora,
    /// Binary STL.
    Stl,
    /// Binary glTF.
    Glb,
    /// Film, GIF.
    Gif,
    /// Film, MP4.
    Mp4,
    /// Ledger of the paint, JSON.
    Ledger,
    /// Take, MCAP.
    Take,
    /// Paint file of a fit, CSV.
    Paints,
    /// Brush file, TOML.
    Brush,
    /// Recording of a HID device, text.
    Recording,
    /// Messages of a recording, CSV or lines of JSON.
    Messages,
    /// Table of the force of a fluid, CSV.
    Forces,
    /// Graph of a rig, SVG or Mermaid.
    Graph,
    /// File that belongs to the program whatever it holds: settings, and what lies in folders of its own.
    Own,
}

/// Endings of files' names, in lower case, by what they hold: what is written under one of another kind would be taken for
/// it. Names that end in none of these say nothing.
const ENDINGS: [(&str, &[Kind]); 24] = [
    ("png", &[Kind::Png]),
    ("exr", &[Kind::Exr]),
    ("ora", &[Kind::Ora]),
    ("stl", &[Kind::Stl]),
    ("glb", &[Kind::Glb]),
    ("gif", &[Kind::Gif]),
    ("mp4", &[Kind::Mp4]),
    ("json", &[Kind::Ledger, Kind::Messages]),
    ("jsonl", &[Kind::Messages]),
    ("mcap", &[Kind::Take]),
    ("csv", &[Kind::Paints, Kind::Messages, Kind::Forces]),
    ("toml", &[Kind::Brush]),
    ("hid", &[Kind::Recording]),
    ("svg", &[Kind::Graph]),
    ("mmd", &[Kind::Graph]),
    ("mermaid", &[Kind::Graph]),
    ("md", &[Kind::Graph]),
    // Kinds that are read, or that other programs write.
    ("maul", &[]),
    ("jpg", &[]),
    ("jpeg", &[]),
    ("tif", &[]),
    ("tiff", &[]),
    ("gltf", &[]),
    ("icc", &[]),
];

/// The ending of a file's name in lower case; empty if there is none.
#[must_use]
pub fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_ascii_lowercase()
}

/// As many first bytes as tell any kind.
const HEAD: usize = 64;
/// The first bytes of every SQLite file.
const DATABASE: &[u8] = b"SQLite format 3\0";
/// Suffixes of the files that SQLite keeps beside a database.
pub const COMPANIONS: [&str; 3] = ["-wal", "-shm", "-journal"];
/// True if the user asked to write over files of other kinds.
static OVERWRITE: AtomicBool = AtomicBool::new(false);

/// Lets this process write over files of other kinds, as `--overwrite` asks; over a painting never.
pub fn allow_overwriting() {
    OVERWRITE.store(true, Relaxed);
}

/// True for a name under which SQLite keeps the journal of a database.
#[must_use]
pub fn is_companion(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    COMPANIONS
        .iter()
        .any(|ending| name.ends_with(ending.as_bytes()))
}

/// True for a file that begins as a painting does.
#[must_use]
pub fn is_painting(path: &Path) -> bool {
    let mut head = [0; DATABASE.len()];
    read_head(path, &mut head).is_ok() && head == *DATABASE
}

impl Kind {
    /// Its name, with an article.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Png => "a PNG picture",
            Self::Exr => "an OpenEXR picture",
            Self::Ora => "an OpenRaster picture",
            Self::Stl => "an STL solid",
            Self::Glb => "a binary glTF solid",
            Self::Gif => "a GIF film",
            Self::Mp4 => "an MP4 film",
            Self::Ledger => "a ledger",
            Self::Take => "a take",
            Self::Paints => "a fitted paint file",
            Self::Brush => "a brush file",
            Self::Recording => "a recording of a device",
            Self::Messages => "exported messages",
            Self::Forces => "a table of forces",
            Self::Graph => "a graph of a rig",
            Self::Own => "a file of Maulstick",
        }
    }

    /// The endings of its files' names.
    fn endings(self) -> impl Iterator<Item = &'static str> {
        let own = ENDINGS
            .iter()
            .filter(move |(_, kinds)| kinds.contains(&self));
        own.map(|(ending, _)| *ending)
    }

    /// Sees that a name does not end as that of another kind.
    ///
    /// # Errors
    /// A name that ends in the ending of another kind, with the endings that it may have.
    pub fn check_name(self, path: &Path) -> Result<(), Error> {
        let ending = ending(path);
        let known = ENDINGS.iter().find(|(known, _)| *known == ending);
        match known {
            Some((_, kinds)) if self != Self::Own && !kinds.contains(&self) => {
                let own: Vec<String> = self.endings().map(|own| format!(".{own}")).collect();
                let what = self.name();
                Err(Error::new(
                    ErrorKind::InvalidFilename,
                    format!(
                        "{what} is no .{ending} file: end its name in {}",
                        own.join(" or ")
                    ),
                ))
            }
            _ => Ok(()),
        }
    }

    /// True if a file of `length` bytes that begins with `head` is of this kind.
    fn has(self, head: &[u8], length: u64) -> bool {
        match self {
            Self::Png => head.starts_with(b"\x89PNG\r\n\x1a\n"),
            Self::Exr => head.starts_with(&[0x76, 0x2f, 0x31, 0x01]),
            Self::Ora => head.starts_with(b"PK\x03\x04") && has(head, b"mimetypeimage/openraster"),
            // 80 bytes of header, a count, and 50 bytes a triangle.
            Self::Stl => length >= 84 && (length - 84).is_multiple_of(50) && !is_text(head),
            // Brushes modelled in Blender are glTF, too.
            Self::Glb => head.starts_with(b"glTF") && has(head, b"\"generator\":\"Maulstick\""),
            Self::Gif => head.starts_with(b"GIF8"),
            Self::Mp4 => head.get(4..8) == Some(b"ftyp"),
            Self::Ledger => head.starts_with(b"{") && has(head, b"\"accounts_m3\""),
            Self::Take => head.starts_with(b"\x89MCAP0\r\n"),
            Self::Paints => head.starts_with(b"# Kubelka-Munk absorption K and scattering S"),
            Self::Brush => head.starts_with(b"kind = "),
            Self::Recording => [b"D:", b"R:", b"E:", b"N:"]
                .iter()
                .any(|mark| head.starts_with(*mark)),
            Self::Messages => [&b"topic,arrived_ns,seq,event_ns,"[..], b"{\"arrived_ns\":"]
                .iter()
                .any(|mark| head.starts_with(mark)),
            Self::Forces => head.starts_with(b"grid,boundary,t_s,"),
            Self::Graph => [&b"<svg xmlns="[..], b"flowchart LR\n"]
                .iter()
                .any(|mark| head.starts_with(mark)),
            Self::Own => true,
        }
    }
}

fn has(head: &[u8], words: &[u8]) -> bool {
    head.windows(words.len()).any(|part| part == words)
}

fn is_text(head: &[u8]) -> bool {
    head.iter()
        .all(|byte| (b' '..0x7f).contains(byte) || b"\t\r\n".contains(byte))
}

/// Target path of a file of a kind, with links resolved, if there is no file, an empty one, or one of the same kind.
///
/// # Errors
/// Reason why the path cannot be written, with advice.
pub(crate) fn destination(path: &Path, kind: Kind) -> Result<PathBuf, Error> {
    let to = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if is_companion(path) || is_companion(&to) {
        return Err(Error::new(
            ErrorKind::InvalidInput,
            "a file with this extension may belong to a painting: choose another name",
        ));
    }
    let Ok(found) = std::fs::metadata(&to) else {
        kind.check_name(path)?;
        return Ok(to);
    };
    if found.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !found.is_file() {
        return Err(Error::new(
            ErrorKind::InvalidInput,
            "there is a pipe, socket or device at this path: name a file",
        ));
    }
    let mut head = [0; HEAD];
    // A file that may not be read is not written over either.
    let read = read_head(&to, &mut head)?;
    let head = &head[..read];
    if head.starts_with(DATABASE) {
        return Err(Error::new(
            ErrorKind::AlreadyExists,
            "this file is a painting, and paintings are never written over",
        ));
    }
    kind.check_name(path)?;
    if gives_way(&to, kind) || OVERWRITE.load(Relaxed) {
        return Ok(to);
    }
    Err(Error::new(
        ErrorKind::AlreadyExists,
        format!(
            "the existing file is not {}: to write over it, give `--overwrite`",
            kind.name()
        ),
    ))
}

/// True if a file of a kind may be written at a path without `--overwrite`.
#[must_use]
pub fn gives_way(path: &Path, kind: Kind) -> bool {
    let mut head = [0; HEAD];
    match (std::fs::metadata(path), read_head(path, &mut head)) {
        (Ok(found), Ok(read)) => read == 0 || kind.has(&head[..read], found.len()),
        (found, _) => found.is_err(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_gives_way_to_its_own_kind_alone() {
        let kinds: [(Kind, &[u8]); 14] = [
            (Kind::Png, b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"),
            (Kind::Exr, &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]),
            (
                Kind::Ora,
                b"PK\x03\x04\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0\x10\0\0\0\x10\0\0\0\x08\0\0\0mimetypeimage/openraster",
            ),
            (Kind::Stl, &[0; 84 + 100]),
            (
                Kind::Glb,
                b"glTF\x02\0\0\0\0\x01\0\0\xb0\0\0\0JSON{\"asset\":{\"generator\":\"Maulstick\",",
            ),
            (Kind::Gif, b"GIF89a\x40\x01"),
            (Kind::Mp4, b"\0\0\0\x20ftypisom"),
            (Kind::Ledger, b"{\n  \"accounts_m3\": {"),
            (Kind::Take, b"\x89MCAP0\r\n"),
            (
                Kind::Paints,
                b"# Kubelka-Munk absorption K and scattering S of paints, in",
            ),
            (Kind::Brush, b"kind = \"round\"\n"),
            (Kind::Graph, b"flowchart LR\n    n0[\"paint\"]\n"),
            (Kind::Forces, b"grid,boundary,t_s,x_m"),
            (Kind::Recording, b"D: 0\nR: 3 05 0d 09\n"),
        ];
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        for (there, bytes) in kinds {
            std::fs::write(&path, bytes).expect("written");
            for (kind, _) in kinds {
                let may = destination(&path, kind);
                assert_eq!(may.is_ok(), kind == there, "{there:?} {kind:?}: {may:?}");
            }
        }
        // 84 + 50 characters of prose are no solid.
        std::fs::write(&path, "a".repeat(134)).expect("written");
        for (kind, _) in kinds {
            let error = destination(&path, kind).expect_err("a text of somebody's");
            assert!(error.to_string().contains("--overwrite"), "{error}");
        }
        // A brush modelled in Blender is no export.
        let brush = b"glTF\x02\0\0\0\0\x01\0\0\xb0\0\0\0JSON{\"asset\":{\"generator\":\"Khronos";
        std::fs::write(&path, brush).expect("written");
        destination(&path, Kind::Glb).expect_err("somebody's work");
        destination(&path, Kind::Own).expect("its own");
        std::fs::write(&path, "").expect("written");
        destination(&path, Kind::Png).expect("nothing is lost");
        destination(&folder.path().join("none"), Kind::Png).expect("nothing is there");
    }

    #[test]
    fn a_name_that_ends_as_another_kind_does_is_refused_without_case() {
        let all = [
            Kind::Png,
            Kind::Exr,
            Kind::Ora,
            Kind::Stl,
            Kind::Glb,
            Kind::Gif,
            Kind::Mp4,
            Kind::Ledger,
            Kind::Take,
            Kind::Paints,
            Kind::Brush,
            Kind::Recording,
            Kind::Messages,
            Kind::Forces,
            Kind::Graph,
        ];
        for kind in all {
            assert!(kind.endings().next().is_some(), "{kind:?}");
            for (ending, kinds) in ENDINGS {
                for name in [ending.to_owned(), ending.to_uppercase()] {
                    let path = format!("/nowhere/a.{name}");
                    let said = destination(Path::new(&path), kind);
                    assert_eq!(said.is_ok(), kinds.contains(&kind), "{kind:?} {said:?}");
                    destination(Path::new(&path), Kind::Own).expect("its own");
                }
            }
            for name in ["a", "sea 1.5", "notes.txt", ".png"] {
                kind.check_name(Path::new(name)).expect("it says nothing");
            }
        }
        let said = Kind::Graph
            .check_name(Path::new("g.PNG"))
            .expect_err("a picture");
        assert_eq!(said.kind(), ErrorKind::InvalidFilename);
        let said = said.to_string();
        assert!(said.contains(".svg") && said.contains(".mmd"), "{said}");
        assert_eq!(ending(Path::new("/a.b/G.SVG")), "svg");
        assert_eq!(ending(Path::new("/a.b/G")), "");
    }

    #[test]
    fn what_belongs_to_a_database_is_no_name_for_a_file() {
        for ending in COMPANIONS {
            let error = destination(Path::new(&format!("a.maul{ending}")), Kind::Own);
            let text = error.expect_err("refused").to_string();
            assert!(text.contains("painting"), "{text}");
        }
        assert!(!is_companion(Path::new("a-wal/b.png")));
    }
}
