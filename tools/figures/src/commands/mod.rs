//! Commands of this program, in the groups of `maulstick` that they belong to.

mod chart;
mod compare;
mod effects;
mod sheet;

use std::path::Path;

use maulstick::commands::{print_text, write_picture};
use maulstick_appearance::picture::Picture;
use maulstick_rig::UserError;
use maulstick_tool_options::figures::{BrushFigures, ColourFigures, DemoFigures, Figures};

use crate::fluid_force;

/// Makes a figure.
///
/// # Errors
/// A [`UserError`] where it cannot be made or written.
pub(crate) fn run(figures: &Figures) -> Result<i32, UserError> {
    match figures {
        Figures::Brush(BrushFigures::Sheet(options)) => sheet::run(options),
        Figures::Colour(ColourFigures::Chart(options)) => chart::run(options),
        Figures::Colour(ColourFigures::Compare(options)) => compare::run(options),
        Figures::Demo(DemoFigures::Effects(options)) => effects::run(options),
        Figures::Demo(DemoFigures::FluidForce(options)) => fluid_force::run(options),
    }
}

/// Writes a picture and says its size.
fn write(picture: &Picture, path: &Path) -> Result<(), UserError> {
    write_picture(picture, path)?;
    let (width, height) = (picture.width, picture.height);
    print_text(&format!("{}: {width}×{height} pixels\n", path.display()))
}
