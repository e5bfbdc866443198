//! `maulstick demo`: a performance from a seed, a sheet of what paint can do, paintings, the force of a fluid.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand};
use indicatif::ProgressBar;
use maulstick_device::demo::{Subject, performance};
use maulstick_models::{model_called, model_names};
use maulstick_painting::picture::picture;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::scene::CANVAS;

use crate::cells::SheetCells;
use crate::commands::{progress_bar, say, write_picture, write_take};
use crate::outputs::{UsedFile, check_outputs};
use crate::paintings::{paint, script};
use crate::performance::{library, refused};
use crate::sheet::Board;
use crate::sheet::effects::effects;

use super::fluid_force::{self, FluidForceOptions};

/// Commands of `maulstick demo`.
#[derive(Clone, Debug, Subcommand)]
pub enum DemoCommand {
    /// Make a take: a flower, or the strokes of a sheet of marks
    Take(TakeOptions),
    /// Paint one of the bundled paintings: still-life, flower, landscape
    Painting(PaintingOptions),
    /// Paint a sheet of the effects of the paint model, with captions
    ///
    /// Transfer both ways, loading, drying, blending, glazing, impasto, scumbling.
    Effects(EffectsOptions),
    /// Sweep a square through a fluid along an arc and write the force on it
    ///
    /// Raw and filtered for the hand, at several resolutions (Baxter 2004, fig. 8.8).
    FluidForce(FluidForceOptions),
}

/// Options of `maulstick demo take`.
#[derive(Args, Clone, Debug)]
pub struct TakeOptions {
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// Make strokes of a sheet of marks instead of the flower
    #[arg(long)]
    marks: bool,
    /// Seed of the performance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// What is painted on, and with what.
#[derive(Args, Clone, Debug)]
struct BoardOptions {
    #[command(flatten)]
    cells: SheetCells,
    /// Paint model [default: impasto]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(model_names()))]
    model: Option<String>,
}

impl BoardOptions {
    fn board(&self) -> Result<Board, UserError> {
        let board = Board::of_cells(self.cells.side_mm());
        let Some(model) = &self.model else {
            return Ok(board);
        };
        let model = model_called(model).map_err(refused)?;
        Ok(Board { model, ..board })
    }
}

/// Options of `maulstick demo painting`.
#[derive(Args, Clone, Debug)]
pub struct PaintingOptions {
    /// Name of the painting
    #[arg(value_name = "NAME")]
    painting: String,
    /// Picture to write, a PNG [default: NAME.png]
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
    #[command(flatten)]
    board: BoardOptions,
}

/// Options of `maulstick demo effects`.
#[derive(Args, Clone, Debug)]
pub struct EffectsOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    #[command(flatten)]
    board: BoardOptions,
}

/// Writes the demo.
///
/// # Errors
/// A [`UserError`] where it cannot be written.
pub fn run(command: &DemoCommand) -> Result<i32, UserError> {
    match command {
        DemoCommand::Take(options) => make_take(options),
        DemoCommand::Painting(options) => paint_painting(options),
        DemoCommand::Effects(options) => paint_effects(options),
        DemoCommand::FluidForce(options) => fluid_force::run(options),
    }
}

fn make_take(options: &TakeOptions) -> Result<i32, UserError> {
    let path = &options.output;
    check_outputs(&[UsedFile::new("the take", path).of(Kind::Take)], &[])?;
    let subject = if options.marks {
        Subject::Marks
    } else {
        Subject::Flower
    };
    write_take(&performance(subject, options.seed), path)?;
    Ok(0)
}

fn paint_effects(options: &EffectsOptions) -> Result<i32, UserError> {
    let path = &options.output;
    check_outputs(&[UsedFile::new("the sheet", path).of(Kind::Png)], &[])?;
    let bar = ProgressBar::new(1);
    let picture = effects(&library()?, options.board.board()?, |done, of| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    write_picture(&picture, path)?;
    say!("{}", path.display());
    Ok(0)
}

fn paint_painting(options: &PaintingOptions) -> Result<i32, UserError> {
    let (library, name) = (library()?, &*options.painting);
    script(name, &library)?;
    let named = PathBuf::from(format!("{name}.png"));
    let path = options.output.as_ref().unwrap_or(&named);
    check_outputs(&[UsedFile::new("the picture", path).of(Kind::Png)], &[])?;
    let bar = progress_bar(0).with_message("painting");
    let mut offline = paint(name, options.board.board()?, library, bar)?;
    write_picture(&picture(offline.painting_mut(), CANVAS), path)?;
    say!("{}", path.display());
    Ok(0)
}
