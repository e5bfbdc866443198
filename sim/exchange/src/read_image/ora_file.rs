//! OpenRaster: the picture of all layers that each file has (openraster.org, *File layout*).

use std::io::{BufRead, Cursor, ErrorKind, Read as _, Seek};

use zip::ZipArchive;
use zip::result::ZipError;

use super::pixels::Picture;
use super::png_file;
use crate::import_error::ImportError;

/// The picture of all layers.
const MERGED: &str = "mergedimage.png";

pub(super) fn read(source: impl BufRead + Seek, most_bytes: u64) -> Result<Picture, ImportError> {
    let mut archive = ZipArchive::new(source).map_err(wrong)?;
    let file = match archive.by_name(MERGED) {
        Err(ZipError::FileNotFound) => {
            let what = format!("it has no {MERGED}");
            return Err(ImportError::NotAPicture(what));
        }
        other => other.map_err(wrong)?,
    };
    let mut bytes = Vec::new();
    let mut file = file.take(most_bytes.saturating_add(1));
    file.read_to_end(&mut bytes)
        .map_err(|error| wrong(error.into()))?;
    if bytes.len() as u64 > most_bytes {
        let what = format!("its {MERGED} unpacks to more than {} MB", most_bytes >> 20);
        return Err(ImportError::NotAPicture(what));
    }
    png_file::read(Cursor::new(bytes), most_bytes)
}

fn wrong(error: ZipError) -> ImportError {
    match error {
        // Wrong compression is an error of its reader, too.
        ZipError::Io(error)
            if !matches!(
                error.kind(),
                ErrorKind::UnexpectedEof | ErrorKind::InvalidData | ErrorKind::InvalidInput
            ) =>
        {
            ImportError::File(error)
        }
        other => ImportError::NotAPicture(other.to_string()),
    }
}
