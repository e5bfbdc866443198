//! The side of the cells that pictures are painted with.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, RigConfig};
use maulstick_types::command::CELLS_IN_ALL;

/// Side of a cell in pictures, mm. A hand that paints has those of its rig, which are larger, so that a
/// broad brush keeps up with it.
pub const PICTURE_CELL_MM: f64 = 0.125;
/// Cells whose side may be asked for, mm.
const CELLS_MM: std::ops::RangeInclusive<f64> = 0.02..=2.0;
/// Cells of a canvas either way.
const SIDE: std::ops::RangeInclusive<f64> = 1.0..=65_536.0;

/// The cells of a sheet.
#[derive(Args, Clone, Copy, Debug)]
pub struct SheetCells {
    /// Side of a cell, mm, .02 to 2; a cell is a pixel of the sheet [default: 0.125]
    #[arg(long, value_name = "MM", value_parser = parse_cell_mm, allow_negative_numbers = true)]
    pub cell_mm: Option<f64>,
}

impl SheetCells {
    /// As asked for, or as in any picture, mm.
    #[must_use]
    pub fn side_mm(self) -> f64 {
        self.cell_mm.unwrap_or(PICTURE_CELL_MM)
    }
}

/// Reads the side of a cell, mm.
///
/// # Errors
/// What is wrong, and what to choose.
pub fn parse_cell_mm(text: &str) -> Result<f64, String> {
    let side: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("'{text}' is not a number of mm such as {PICTURE_CELL_MM}"))?;
    match CELLS_MM.contains(&side) {
        true => Ok(side),
        false => Err(format!(
            "cells of {text} mm; choose {} to {} mm, such as {PICTURE_CELL_MM}",
            CELLS_MM.start(),
            CELLS_MM.end()
        )),
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
    if cells.iter().all(|cells| SIDE.contains(cells)) && cells[0] * cells[1] <= CELLS_IN_ALL {
        return Ok(());
    }
    Err(UserError::usage(format!(
        "a canvas of {width}×{height} mm would have {}×{} cells of {} mm",
        cells[0], cells[1], canvas.cell_mm
    ))
    .at("--cell-mm, --size")
    .help(format!(
        "choose 1 to {} cells either way, {:.0} million in all: larger cells, or a smaller canvas",
        SIDE.end(),
        CELLS_IN_ALL * 1e-6
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_of_cells_are_read_or_rejected() {
        assert_eq!(parse_cell_mm("0.125"), Ok(0.125));
        assert_eq!(parse_cell_mm(".0625"), Ok(0.0625));
        for text in ["0", "-0.1", "nan", "inf", "10", "1e-9"] {
            let what = parse_cell_mm(text).expect_err(text);
            assert!(
                what.contains(text) && what.contains("0.02 to 2 mm"),
                "{what}"
            );
        }
        assert!(parse_cell_mm("fine").is_err_and(|what| what.contains("0.125")));
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
            assert!(fault.what.contains("cells of"), "{fault}");
        }
    }
}
