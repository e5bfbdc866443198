//! Commands to a running rig: `maulstick load`, `clean`, `undo`, `redo` and `snapshot`.

use std::path::PathBuf;

use clap::Args;
use maulstick_optics::PaintError;
use maulstick_painting::paint_error;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::scene::Tuning;

use crate::commands::say;
use crate::commands::session::{PAINT, Session, Target};
use crate::outputs::{Relayed, UsedFile, check_outputs};
use crate::performance::refused;

/// Options of `maulstick load`.
#[derive(Args, Clone, Debug)]
pub struct LoadOptions {
    /// Mixture to load, such as "Cobalt Blue=0.7,Titanium White=0.3"
    mixture: String,
    /// Second mixture, for the right half of the brush; the first then loads the left half
    #[arg(long, value_name = "MIXTURE")]
    beside: Option<String>,
    /// Brush of the rig
    #[arg(long, default_value = "main")]
    brush: String,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick tune`.
#[derive(Args, Clone, Debug)]
pub struct TuneOptions {
    /// Factor on the stiffness in the brush file
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    stiffness: f64,
    /// Wetness, from 0 (as in the brush file) to 1 (soaked: half as stiff)
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    wetness: f64,
    /// Brush of the rig
    #[arg(long, default_value = "main")]
    brush: String,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick clean`.
#[derive(Args, Clone, Debug)]
pub struct CleanOptions {
    /// Brush of the rig
    #[arg(long, default_value = "main")]
    brush: String,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick undo` and `maulstick redo`.
#[derive(Args, Clone, Debug)]
pub struct HistoryOptions {
    /// Brush whose newest step is meant, unless something was painted over it [default: the newest step
    /// of all brushes]
    #[arg(long, value_name = "BRUSH")]
    brush: Option<String>,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick snapshot`.
#[derive(Args, Clone, Debug)]
pub struct SnapshotOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Ledger of the paint to write, JSON
    #[arg(long, value_name = "FILE")]
    ledger: Option<PathBuf>,
    #[command(flatten)]
    target: Target,
}

/// Loads a brush.
///
/// # Errors
/// A [`UserError`] for an unknown paint or brush, or where no rig runs.
pub fn load(options: &LoadOptions) -> Result<i32, UserError> {
    let brush = options.brush.clone();
    let mixture = mixture_of(&options.mixture)?;
    let command = match &options.beside {
        None => Command::Load { brush, mixture },
        Some(beside) => Command::LoadBeside {
            brush,
            left: mixture,
            right: mixture_of(beside)?,
        },
    };
    Session::command(&options.target, PAINT, command)?;
    Ok(0)
}

/// A mixture; whether there are such paints the rig knows.
fn mixture_of(text: &str) -> Result<Mixture, UserError> {
    text.parse()
        .map_err(|error| refused(paint_error(PaintError::Mixture(error))))
}

/// Makes a brush stiffer or softer.
///
/// # Errors
/// A [`UserError`] for an unknown brush or numbers out of range, or where no rig runs.
pub fn tune(options: &TuneOptions) -> Result<i32, UserError> {
    let command = Command::Tune {
        tuning: Tuning {
            brush: options.brush.clone(),
            stiffness: options.stiffness,
            wetness: options.wetness,
        },
    };
    Session::command(&options.target, PAINT, command)?;
    Ok(0)
}

/// Cleans a brush.
///
/// # Errors
/// A [`UserError`] for an unknown brush, or where no rig runs.
pub fn clean(options: &CleanOptions) -> Result<i32, UserError> {
    Session::command(
        &options.target,
        PAINT,
        Command::Clean {
            brush: options.brush.clone(),
        },
    )?;
    Ok(0)
}

/// Undoes the newest step.
///
/// # Errors
/// A [`UserError`] if there is none, or if no rig runs.
pub fn undo(options: &HistoryOptions) -> Result<i32, UserError> {
    let brush = options.brush.clone();
    let what = Session::command(&options.target, PAINT, Command::Undo { brush })?;
    say!("undone: {what}");
    Ok(0)
}

/// Redoes the newest undone step.
///
/// # Errors
/// A [`UserError`] if there is none, or if no rig runs.
pub fn redo(options: &HistoryOptions) -> Result<i32, UserError> {
    let brush = options.brush.clone();
    let what = Session::command(&options.target, PAINT, Command::Redo { brush })?;
    say!("redone: {what}");
    Ok(0)
}

/// Has the picture of the canvas written.
///
/// # Errors
/// A [`UserError`] where it cannot be written, or where no rig runs.
pub fn snapshot(options: &SnapshotOptions) -> Result<i32, UserError> {
    let picture = UsedFile::new("the picture", &options.output).of(Kind::Png);
    let ledger = UsedFile::written("the ledger", options.ledger.as_ref(), Kind::Ledger);
    let outputs: Vec<_> = std::iter::once(picture).chain(ledger).collect();
    check_outputs(&outputs, &[])?;
    let picture = Relayed::new(&options.output, Kind::Png)?;
    let ledger = options.ledger.as_ref();
    let ledger = ledger.map(|path| Relayed::new(path, Kind::Ledger));
    let ledger = ledger.transpose()?;
    let command = Command::Snapshot {
        path: picture.asked(),
        ledger: ledger.as_ref().map(Relayed::asked),
    };
    let said = Session::command(&options.target, PAINT, command)?;
    if let Some(ledger) = ledger {
        ledger.arrive("")?;
    }
    say!("{}", picture.arrive(&said)?);
    Ok(0)
}
