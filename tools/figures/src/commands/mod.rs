//! Commands of this program, in the groups of `maulstick` that they belong to.

mod chart;
mod compare;
mod effects;
mod sheet;

use std::path::Path;

use clap::Subcommand;
use maulstick::commands::{print_text, write_picture};
use maulstick_appearance::picture::Picture;
use maulstick_rig::UserError;

use crate::fluid_force::{self, FluidForceOptions};

/// Groups of commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Figures {
    /// Brushes
    #[command(subcommand)]
    Brush(BrushFigures),
    /// Colours
    #[command(subcommand)]
    Colour(ColourFigures),
    /// Demos
    #[command(subcommand)]
    Demo(DemoFigures),
}

/// Figures of `maulstick brush`.
#[derive(Debug, Subcommand)]
pub(crate) enum BrushFigures {
    /// Draw each brush and its marks
    Sheet(sheet::SheetOptions),
}

/// Figures of `maulstick colour`.
#[derive(Debug, Subcommand)]
pub(crate) enum ColourFigures {
    /// Draw the mixing chart of all paints
    Chart(chart::ChartOptions),
    /// Mix one graded mixture in four ways, and compare their colours
    ///
    /// The ways: Kubelka-Munk with 101 samples, with the rule, with three samples taken for red, green and
    /// blue, and linear RGB.
    Compare(compare::CompareOptions),
}

/// Figures of `maulstick demo`.
#[derive(Debug, Subcommand)]
pub(crate) enum DemoFigures {
    /// Paint a sheet of the effects of the paint model, with captions
    ///
    /// Transfer both ways, loading, drying, blending, glazing, impasto, scumbling.
    Effects(effects::EffectsOptions),
    /// Sweep a square through a fluid along an arc and write the force on it
    ///
    /// Raw and filtered for the hand, at several resolutions (Baxter 2004, fig. 8.8).
    FluidForce(FluidForceOptions),
}

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

#[cfg(test)]
mod tests {
    use maulstick::beside::{defined, listed};

    use super::Figures;

    #[test]
    fn maulstick_lists_these_commands() {
        assert_eq!(defined::<Figures>(), listed("maulstick-figures"));
        assert_ne!(defined::<Figures>(), listed("maulstick-bench"));
    }
}
