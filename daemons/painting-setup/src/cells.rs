//! The side of the cells that pictures are painted with.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, RigConfig};
use maulstick_types::command::slow_canvas::{SLOW_CELL_M, SLOW_CELLS, is_slow};
use maulstick_types::limits::{CELLS_IN_ALL, CELLS_MAX};
use maulstick_types::values::{CellSide, Quantity};
use thiserror::Error;

/// Side of a cell in pictures, mm. Live painting uses those of its rig, which are larger, so that a broad brush keeps
/// up with the hand.
pub const PICTURE_CELL_MM: f64 = 0.125;

/// The cells of a sheet.
#[derive(Args, Clone, Copy, Debug)]
pub struct SheetCells {
    /// Side of a cell, mm, .02 to 2; a cell is a pixel of the sheet [default: 0.125]
    #[arg(long, value_name = "MM", value_parser = parse_cell_mm, allow_negative_numbers = true)]
    pub cell_mm: Option<f64>,
}

impl SheetCells {
    /// The requested side, or the default of pictures, mm.
    #[must_use]
    pub fn side_mm(self) -> f64 {
        self.cell_mm.unwrap_or(PICTURE_CELL_MM)
    }
}

/// Text that is no side of a cell.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CellError {
    /// No number.
    #[error("'{0}' is not a number of mm such as {PICTURE_CELL_MM}")]
    Malformed(String),
    /// Too small, too large, or not finite.
    #[error(
        "cells of {0} mm; choose {least} to {most} mm, such as {PICTURE_CELL_MM}",
        least = CellSide::USUAL.start(),
        most = CellSide::USUAL.end()
    )]
    OutOfRange(String),
}

/// Reads the side of a cell, mm.
///
/// # Errors
/// A [`CellError`] for another text.
pub fn parse_cell_mm(text: &str) -> Result<f64, CellError> {
    let side = text.trim().parse();
    let side: f64 = side.map_err(|_| CellError::Malformed(text.to_owned()))?;
    if CellSide::USUAL.contains(&side) {
        Ok(side)
    } else {
        Err(CellError::OutOfRange(text.to_owned()))
    }
}

/// The settings of a picture for which no rig is given.
#[must_use]
pub fn picture_settings() -> RigConfig {
    let mut config = RigConfig::default();
    config.canvas.cell_mm = PICTURE_CELL_MM;
    config
}

/// Checks that a canvas has as many cells as there may be.
///
/// # Errors
/// A [`UserError`] with the cells that it would have.
pub fn check_canvas(canvas: &CanvasSection) -> Result<(), UserError> {
    let [width, height] = [canvas.width_mm, canvas.height_mm];
    let cells = [width, height].map(|mm| (mm / canvas.cell_mm).round());
    if cells
        .iter()
        .all(|cells| (1.0..=CELLS_MAX.into()).contains(cells))
        && cells[0] * cells[1] <= CELLS_IN_ALL
    {
        return Ok(());
    }
    Err(UserError::usage(format!(
        "a canvas of {width}×{height} mm would have {}×{} cells of {} mm",
        cells[0], cells[1], canvas.cell_mm
    ))
    .at("--cell-mm, --size")
    .help(format!(
        "choose 1 to {CELLS_MAX} cells either way, {:.0} million in all: larger cells, or a smaller canvas",
        CELLS_IN_ALL * 1e-6
    )))
}

/// Memory of a cell painted with three paints, bytes: their counts, and the display.
const CELL_BYTES: f64 = 3.0 * 4.0 + 14.0;

/// Decision of the painter about a slow canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slowness {
    /// He has said so.
    Accepted,
    /// He may not know.
    Unknown,
}

impl From<bool> for Slowness {
    fn from(accepted: bool) -> Self {
        if accepted {
            Self::Accepted
        } else {
            Self::Unknown
        }
    }
}

/// Checks that a hand can paint on a new canvas, unless the painter accepts that it is slow.
///
/// # Errors
/// A [`UserError`] with its cells.
pub fn check_speed(canvas: &CanvasSection, slowness: Slowness) -> Result<(), UserError> {
    let cells = canvas.cells().map(f64::from);
    if slowness == Slowness::Accepted || !is_slow(canvas.cell_mm * 1e-3, cells[0] * cells[1]) {
        return Ok(());
    }
    Err(UserError::usage(format!(
        "painting on {}×{} cells of {} mm is slow: the paint falls behind the hand, and the window takes long to draw it",
        cells[0],
        cells[1],
        canvas.cell_mm
    ))
    .help(format!(
        "choose cells of {} mm and more, {:.0} million at most, or give --slow",
        SLOW_CELL_M * 1e3,
        SLOW_CELLS * 1e-6
    )))
}

/// Checks that there is memory for a canvas without a file. The pages of one in a file can leave memory.
///
/// # Errors
/// A [`UserError`] with the memory needed.
pub fn check_memory(canvas: &CanvasSection) -> Result<(), UserError> {
    let [width, height] = canvas.cells().map(f64::from);
    let bytes = width * height * CELL_BYTES;
    crate::memory::check("a canvas of so many cells", bytes as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_of_cells_are_read_or_rejected() {
        assert_eq!(parse_cell_mm("0.125"), Ok(0.125));
        assert_eq!(parse_cell_mm(".0625"), Ok(0.0625));
        for text in ["0", "-0.1", "nan", "inf", "10", "1e-9"] {
            assert_eq!(parse_cell_mm(text), Err(CellError::OutOfRange(text.into())));
        }
        assert_eq!(
            parse_cell_mm("fine"),
            Err(CellError::Malformed("fine".into()))
        );
    }

    #[test]
    fn a_canvas_that_is_slow_is_asked_for_and_one_beyond_the_memory_refused() {
        let canvas = |width_mm: f64, cell_mm: f64| CanvasSection {
            width_mm,
            height_mm: 210.0,
            cell_mm,
            ..CanvasSection::default()
        };
        for (width_mm, cell_mm, is_slow) in [
            (297.0, 0.25, false),
            (297.0, 0.0625, false),
            (297.0, 1.0 / 48.0, true),
            (10.0, 1.0 / 48.0, true),
            (10_000.0, 0.125, true),
        ] {
            let canvas = canvas(width_mm, cell_mm);
            let checked = check_speed(&canvas, Slowness::Unknown);
            assert_eq!(checked.is_err(), is_slow, "{width_mm} {cell_mm}");
            assert_eq!(check_speed(&canvas, Slowness::Accepted), Ok(()));
        }
        check_memory(&canvas(297.0, 0.25)).expect("a few megabytes");
        check_memory(&canvas(1e9, 0.02)).expect_err("no machine has that");
    }

    #[test]
    fn a_canvas_of_too_many_cells_is_rejected() {
        let canvas = |side_mm: f64, cell_mm: f64| CanvasSection {
            width_mm: side_mm,
            height_mm: side_mm,
            cell_mm,
            ..CanvasSection::default()
        };
        assert_eq!(check_canvas(&canvas(256.0, 0.02)), Ok(()));
        for (side_mm, cell_mm) in [(2000.0, 0.02), (900.0, 0.02), (0.01, 2.0)] {
            let fault = check_canvas(&canvas(side_mm, cell_mm)).expect_err("cells");
            assert!(fault.what.contains(&format!("{cell_mm} mm")), "{fault}");
        }
    }
}
