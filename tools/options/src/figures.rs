//! Commands of `maulstick-figures`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use maulstick_painting_setup::cells::SheetCells;
use maulstick_painting_setup::viewing::ViewingOptions;
use maulstick_script::paintings::BoardOptions;

/// Grids where none are named.
const GRIDS: [u16; 3] = [32, 64, 128];

/// Groups of commands.
#[derive(Debug, Subcommand)]
pub enum Figures {
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
pub enum BrushFigures {
    /// Draw each brush and its marks
    Sheet(SheetOptions),
}

/// Figures of `maulstick colour`.
#[derive(Debug, Subcommand)]
pub enum ColourFigures {
    /// Draw the mixing chart of all paints
    Chart(ChartOptions),
    /// Mix one graded mixture in four ways, and compare their colours
    ///
    /// The ways: Kubelka-Munk with 101 samples, with the rule, with three samples taken for red, green and
    /// blue, and linear RGB.
    Compare(CompareOptions),
}

/// Figures of `maulstick demo`.
#[derive(Debug, Subcommand)]
pub enum DemoFigures {
    /// Paint a sheet of the effects of the paint model, with captions
    ///
    /// Transfer both ways, loading, drying, blending, glazing, impasto, scumbling.
    Effects(EffectsOptions),
    /// Sweep a square through a fluid along an arc and write the force on it
    ///
    /// Raw and filtered for the hand, at several resolutions (Baxter 2004, fig. 8.8).
    FluidForce(FluidForceOptions),
}

/// Options of `maulstick brush sheet`.
#[derive(Args, Clone, Debug)]
pub struct SheetOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,
    /// Cells of the sheet.
    #[command(flatten)]
    pub cells: SheetCells,
}

/// Options of `maulstick colour chart`.
#[derive(Args, Clone, Debug)]
pub struct ChartOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,
    /// How colours are looked at.
    #[command(flatten)]
    pub viewing: ViewingOptions,
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    pub paints: Option<PathBuf>,
}

/// Options of `maulstick colour compare`.
#[derive(Args, Clone, Debug)]
pub struct CompareOptions {
    /// The two ends of the graded mixture, shares by volume, such as "2 Cobalt Blue, 1 Titanium White"; or one
    /// mixture of two paints
    #[arg(value_name = "MIX")]
    pub mixtures: Vec<String>,
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    pub output: Option<PathBuf>,
    /// How colours are looked at.
    #[command(flatten)]
    pub viewing: ViewingOptions,
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    pub paints: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Options of `maulstick demo effects`.
#[derive(Args, Clone, Debug)]
pub struct EffectsOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,
    /// What is painted on.
    #[command(flatten)]
    pub board: BoardOptions,
}

/// Filter of the force before the hand.
#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Bartlett-Hanning over one period of the solver
    #[default]
    Period,
    /// The dissertation's eleven taps, a millisecond apart
    Dissertation,
}

/// Options of `maulstick demo fluid-force`.
#[derive(Args, Clone, Debug)]
pub struct FluidForceOptions {
    /// Table to write
    #[arg(short, long, value_name = "CSV")]
    pub output: PathBuf,
    /// Cells a side of the fluid's grids
    #[arg(
        long,
        value_name = "CELLS",
        value_delimiter = ',',
        default_values_t = GRIDS,
        value_parser = clap::value_parser!(u16).range(16..=512)
    )]
    pub grid: Vec<u16>,
    /// Filter of the force before the hand
    #[arg(long, value_enum, default_value_t)]
    pub filter: Filter,
    /// Draw the force on the square
    #[arg(long, value_name = "PNG")]
    pub plot: Option<PathBuf>,
}
