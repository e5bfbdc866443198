//! `maulstick take import`: a table of strokes as a take.

use std::path::PathBuf;

use clap::Args;
use maulstick_device::table::{TableLayout, TimeUnit, import};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_types::region::sides;

use crate::commands::option_error::OptionError;
use crate::commands::write_take;

/// Options of `maulstick take import`.
#[derive(Args, Clone, Debug)]
pub struct ImportOptions {
    /// Table: t (s), x, y, pressure (0 to 1) and optionally tilt_x, tilt_y, twist (degrees), stroke
    /// (docs/tables.md)
    table: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// Length of a table unit, mm
    #[arg(long, value_name = "MM", default_value_t = 0.25)]
    unit_mm: f64,
    /// Area of the tablet, in table units; its centre becomes the origin of the desk
    #[arg(long, value_name = "WxH", value_parser = parse_area, default_value = "1024x1024")]
    size: [f64; 2],
    /// Unit of t: s, ms, us or ns [default: guessed from the time between samples]
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<TimeUnit>,
}

/// Imports the table.
///
/// # Errors
/// A [`UserError`] with the table's line, or where the take cannot be written.
pub(super) fn run(options: &ImportOptions) -> Result<i32, UserError> {
    if !(options.unit_mm > 0.0 && options.unit_mm.is_finite()) {
        return Err(
            UserError::usage(format!("--unit-mm {}", options.unit_mm)).help("choose above 0")
        );
    }
    check_outputs(
        &[UsedFile::new("the take", &options.output).of(Kind::Take)],
        &[UsedFile::new("the table", &options.table)],
    )?;
    let layout = TableLayout {
        unit_mm: options.unit_mm,
        size: options.size,
        time_unit: options.time_unit,
    };
    let imported = import(&options.table, layout, "table")?;
    write_take(&imported.take, &options.output)?;
    for note in &imported.notes {
        eprintln!("note: {note}");
    }
    Ok(0)
}

/// Reads `WxH`, each above 0.
fn parse_area(text: &str) -> Result<[f64; 2], OptionError> {
    let expected = "a size such as 44704x27940";
    sides(text)
        .filter(|area: &[f64; 2]| area.iter().all(|side| *side > 0.0 && side.is_finite()))
        .ok_or_else(|| OptionError::unexpected(text, expected))
}
