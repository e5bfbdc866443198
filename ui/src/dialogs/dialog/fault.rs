//! Reasons why a dialog cannot go on with what is written in it.

use std::fmt;
use std::path::{Path, PathBuf};

use maulstick_types::values::{ValueError, WholePath};

use super::in_words;
use crate::dialogs::paths;

/// A reason; shown in the language of the window, with advice.
#[derive(Debug)]
pub(crate) enum DialogFault {
    /// No number in the field of this name.
    NoNumber {
        /// The field.
        what: &'static str,
        /// Its text.
        text: String,
    },
    /// Cells without a size.
    NoCells,
    /// A value out of range.
    Value(ValueError),
    /// No file of a ground.
    NoGround,
    /// A canvas on which painting is slow.
    Slow,
    /// A painting without a name, which is no sketch.
    NoPaintingName,
    /// No name of a file.
    NoName,
    /// A path with letters that messages do not have.
    NotUtf8,
    /// A path that no message carries.
    Path(ValueError),
    /// A folder that is not there.
    NoFolder(PathBuf),
    /// A file that is there already, where a painting is begun.
    Taken(PathBuf),
    /// A file that is there already, and may be let go.
    Replaces(PathBuf),
    /// An ending of no format.
    NoFormat(String),
    /// A solid without height.
    Flat,
    /// A folder instead of a painting.
    Folder,
    /// A painting that is not there.
    NoPainting(PathBuf),
    /// A picture that is not there.
    NoPicture(PathBuf),
    /// A recording that is not there.
    NoRecording(PathBuf),
    /// The painting on the easel is in no file.
    Unsaved,
}

impl fmt::Display for DialogFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = match self {
            Self::NoNumber { what, text } => tr!(
                "{what}: “{text}” is no number. Write one such as 20 or 0.5.",
                what,
                text
            ),
            Self::Value(error) => in_words(&error.to_string(), ""),
            Self::Path(error) => tr!("This path cannot be used: {error}.", error),
            Self::NoFormat(ending) => tr!(
                "A name that ends in .{ending} says nothing that can be written. End it in .png, \
                 .ora, .exr, .stl or .glb.",
                ending
            ),
            Self::NoFolder(folder) => tr!(
                "There is no folder {folder}. Enter an existing one.",
                folder = paths::shown(folder)
            ),
            Self::Taken(file) => tr!(
                "There is a file {file} already. Write another name, or open that one.",
                file = paths::shown(file)
            ),
            Self::Replaces(file) => tr!(
                "There is a file {file} already. Write another name, or tick that it may go.",
                file = paths::shown(file)
            ),
            Self::NoPainting(file) => tr!(
                "There is no file {file}. Choose one of the list, or begin a new one.",
                file = paths::shown(file)
            ),
            Self::NoPicture(file) => tr!(
                "{file} is no file. Choose a PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster of the list.",
                file = paths::shown(file)
            ),
            Self::NoRecording(file) => tr!(
                "{file} is no file. Choose a recording of the list.",
                file = paths::shown(file)
            ),
            plain => return f.write_str(plain.plain_words()),
        };
        f.write_str(&words)
    }
}

impl DialogFault {
    /// The sentence of one that says nothing of its own; empty for another.
    fn plain_words(&self) -> &'static str {
        match self {
            Self::NoCells => tr!("Cells per mm: write a number above 0; 4 is usual."),
            Self::NoGround => tr!(
                "Ground: write the path of a picture, or of a measured ground, a line for each wavelength in nm and its reflectance."
            ),
            Self::Slow => tr!(
                "Painting on so many cells is slow. Choose larger ones, 4 per mm are usual, or tick that it may be slow."
            ),
            Self::NoPaintingName => {
                tr!("Keep in: write the name of a file, or begin a sketch.")
            }
            Self::NoName => tr!("Write the name of a file."),
            Self::NotUtf8 => tr!("This path is not UTF-8: give the file another name."),
            Self::Flat => tr!("Base and heights: write numbers above 0; 2 mm and 1 are usual."),
            Self::Folder => tr!("This is a folder. Choose a painting in it."),
            Self::Unsaved => tr!(
                "The painting on the easel is in no file and would be gone. Keep it first \
                 (Escape, then Ctrl+S), or tick that you let it go."
            ),
            _ => "",
        }
    }
}

impl From<ValueError> for DialogFault {
    fn from(error: ValueError) -> Self {
        Self::Value(error)
    }
}

/// A whole path as messages carry it.
///
/// # Errors
/// [`DialogFault`] where they cannot.
pub(crate) fn named(path: &Path) -> Result<WholePath, DialogFault> {
    let name = path.to_str().ok_or(DialogFault::NotUtf8)?;
    WholePath::new(name).map_err(DialogFault::Path)
}

/// The path of a file that is to be written, with an ending.
///
/// # Errors
/// [`DialogFault`] where it names none, or its folder is not there.
pub(crate) fn writable(path: &Path, ending: &str) -> Result<PathBuf, DialogFault> {
    if path.file_name().is_none() {
        return Err(DialogFault::NoName);
    }
    let path = paths::ending_in(path, ending);
    if path.is_dir() {
        return Err(DialogFault::NoName);
    }
    let folder = path.parent().unwrap_or(Path::new("/"));
    if folder.is_dir() {
        Ok(path)
    } else {
        Err(DialogFault::NoFolder(folder.to_owned()))
    }
}

/// The number of a field, with a point or a comma.
///
/// # Errors
/// [`DialogFault::NoNumber`].
pub(crate) fn number(what: &'static str, text: &str) -> Result<f64, DialogFault> {
    let text = text.trim();
    let number: Option<f64> = text.replace(',', ".").parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.ok_or_else(|| DialogFault::NoNumber {
        what,
        text: text.to_owned(),
    })
}
