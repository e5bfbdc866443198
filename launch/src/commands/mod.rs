//! The commands, in folders by subject; [`crate::cli`] groups them.
//!
//! | module | commands |
//! | --- | --- |
//! | [`edit`] | edits, wherever they are grouped: `brush load`, `layer dry`, `painting undo` |
//! | [`brush`], `canvas`, `colour`, [`demo`], [`device`], [`doctor`], `completions` | those of these names, besides edits |
//! | [`painting`] | paintings in files; `new`, `open`, `save-as`, `snapshot` of a running rig |
//! | `rig` | `node list`, `endpoint`, `schema` |
//! | `takes` | takes that are made, imported, painted |
//! | `streams`, [`replay`] | `topic`, `recording` |
//! | `option_error` | values that options do not take |
//! | [`table`] | tables as text, for all of them |

pub mod brush;
pub mod canvas;
pub mod colour;
pub mod completions;
pub mod demo;
pub mod device;
pub mod doctor;
pub mod edit;
mod option_error;
pub mod painting;
pub mod replay;
mod rig;
mod streams;
pub mod table;
mod takes;

pub use device::force_order;
pub use painting::{begin, open, save_as, snapshot};
pub use rig::{client, endpoint, nodes, schema};
pub(crate) use streams::recorder_words::LogFormat;
pub use streams::{recording, topic};
pub use takes::{render, take};

use std::io::ErrorKind;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use maulstick_appearance::picture::Picture;
use maulstick_device::Take;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use serde_json::Value;

/// Writes a picture as a PNG, whole or not at all.
///
/// # Errors
/// A [`UserError`] where it cannot be written.
pub fn write_picture(picture: &Picture, path: &Path) -> Result<(), UserError> {
    write_whole(path, Kind::Png, |file| picture.encode_png(file))
        .map_err(|error| UserError::writing(path, &error))
}

/// Prints a line as `println!` does, through [`print_line`]: for functions that return a [`UserError`].
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => {
        $crate::commands::print_line(&format!($($text)*))?
    };
}
pub use say;

/// Prints one line, whatever the names in it contain.
///
/// # Errors
/// As [`print_text`].
pub fn print_line(line: &str) -> Result<(), UserError> {
    print_text(&format!("{}\n", maulstick_types::plain(line)))
}

/// Prints text; a reader that closes the pipe, such as `head`, is no error.
///
/// # Errors
/// A [`UserError`] where it cannot be written.
pub fn print_text(text: &str) -> Result<(), UserError> {
    match maulstick_rig::log::print(text) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(UserError::failure(format!("cannot print: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints JSON, indented.
///
/// # Errors
/// A [`UserError`] where it cannot be written as text.
pub fn print_json(value: &Value) -> Result<(), UserError> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| UserError::failure(error.to_string()))?;
    print_text(&(text + "\n"))
}

/// Prints JSON as one line, for a program that reads line by line.
///
/// # Errors
/// As [`print_text`].
pub fn print_json_line(value: &Value) -> Result<(), UserError> {
    print_text(&format!("{value}\n"))
}

/// Writes a take and prints a summary.
///
/// # Errors
/// A [`UserError`] where the file cannot be written.
pub fn write_take(take: &Take, path: &Path) -> Result<(), UserError> {
    take.write(path)?;
    say!(
        "{}: {} samples, {:.1} s",
        path.display(),
        take.samples.len(),
        take.length_ns() as f64 * 1e-9
    );
    Ok(())
}

/// A progress bar over the length of a take, ns, or over parts that are set later; drawn only on a terminal.
#[must_use]
pub fn progress_bar(length_ns: u64) -> ProgressBar {
    let bar = ProgressBar::new(length_ns / 1_000_000);
    if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Callback that shows done and all on a bar.
pub fn progress(bar: &ProgressBar) -> impl FnMut(u64, u64) {
    |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    }
}
