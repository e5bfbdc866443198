//! Kinds of pictures that are read, by their first bytes and by the endings of their names.

use std::path::Path;

/// A kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureKind {
    /// Portable Network Graphics.
    Png,
    /// JPEG with 8 bits.
    Jpeg,
    /// TIFF, BigTIFF too.
    Tiff,
    /// OpenEXR, linear light.
    Exr,
    /// Radiance, linear light.
    Hdr,
    /// OpenRaster: the whole picture in it.
    Ora,
}

/// Number of first bytes that identify any kind.
pub const HEAD: usize = 64;

/// First bytes of the files of each kind.
const MAGIC: [(&[u8], PictureKind); 8] = [
    (b"\x89PNG\r\n\x1a\n", PictureKind::Png),
    (b"\xff\xd8\xff", PictureKind::Jpeg),
    (b"II*\0", PictureKind::Tiff),
    (b"MM\0*", PictureKind::Tiff),
    (b"II+\0", PictureKind::Tiff),
    (b"MM\0+", PictureKind::Tiff),
    (b"\x76\x2f\x31\x01", PictureKind::Exr),
    (b"#?RADIANCE", PictureKind::Hdr),
];
/// An archive, whose first file has its type (openraster.org, *File layout*).
const ARCHIVE: &[u8] = b"PK\x03\x04";
const OPEN_RASTER: &[u8] = b"mimetypeimage/openraster";

impl PictureKind {
    /// Endings of pictures' names, in lower case.
    pub const ENDINGS: [&'static str; 8] =
        ["png", "jpg", "jpeg", "tif", "tiff", "exr", "hdr", "ora"];

    /// The kind of a file by its first bytes; [`HEAD`] bytes suffice.
    #[must_use]
    pub fn of(head: &[u8]) -> Option<Self> {
        let mut parts = head.windows(OPEN_RASTER.len());
        if head.starts_with(ARCHIVE) && parts.any(|part| part == OPEN_RASTER) {
            return Some(Self::Ora);
        }
        let mut all = MAGIC.iter();
        let found = all.find(|(magic, _)| head.starts_with(magic));
        found.map(|(_, kind)| *kind)
    }

    /// True if a file's name ends as that of a picture.
    #[must_use]
    pub fn is_named(path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default();
        Self::ENDINGS
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_told_by_its_first_bytes_or_by_its_name() {
        assert_eq!(PictureKind::of(b"II*\0\x08\0\0\0"), Some(PictureKind::Tiff));
        let archive = [ARCHIVE, &[0; 26], OPEN_RASTER].concat();
        assert_eq!(PictureKind::of(&archive), Some(PictureKind::Ora));
        assert_eq!(PictureKind::of(&archive[..30]), None, "of letters, say");
        assert_eq!(PictureKind::of(b"GIF89a"), None);
        assert_eq!(PictureKind::of(b""), None);
        for name in ["a.PNG", "b.Jpeg", "/c/d.EXR", "e.ora", "f.hdr"] {
            assert!(PictureKind::is_named(Path::new(name)), "{name}");
        }
        for name in ["a", "png", "a.gif", ".png"] {
            assert!(!PictureKind::is_named(Path::new(name)), "{name}");
        }
    }
}
