//! `maulstick demo`: a performance from a seed, a sheet of what paint can do, and paintings.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;
use maulstick_device::demo::{Subject, performance};
use maulstick_painting::models::{model_called, model_names};
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

use super::fluid_force;

/// Options of `maulstick demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoOptions {
    /// Take to write; with --painting the picture, a PNG [default: NAME.png]; with --fluid-force its table, CSV
    #[arg(short, long, value_name = "FILE", required_unless_present_any = ["sheet", "painting"])]
    output: Option<PathBuf>,
    /// Make strokes of a sheet of marks instead of the flower
    #[arg(long)]
    marks: bool,
    /// Paint a sheet of the effects of the paint model, with captions: transfer both ways, loading,
    /// drying, blending, glazing, impasto, scumbling
    #[arg(long, value_name = "PNG")]
    sheet: Option<PathBuf>,
    /// Paint one of the bundled paintings: still-life, flower, landscape
    #[arg(long, value_name = "NAME", conflicts_with_all = ["sheet", "marks", "seed"])]
    painting: Option<String>,
    /// Sweep a square through a fluid along an arc and write the force on it, raw and filtered for the hand, at
    /// several resolutions (Baxter 2004, fig. 8.8)
    #[arg(long, requires = "output", conflicts_with_all = ["sheet", "marks", "seed", "painting"])]
    fluid_force: bool,
    /// Cells a side of the fluid's grids [default: 32,64,128]
    #[arg(
        long,
        value_name = "CELLS",
        value_delimiter = ',',
        requires = "fluid_force",
        value_parser = clap::value_parser!(u16).range(16..=512)
    )]
    grid: Vec<u16>,
    /// Filter of the force before the hand
    #[arg(long, value_enum, default_value_t, requires = "fluid_force")]
    filter: fluid_force::Filter,
    /// Draw the force on the square
    #[arg(long, value_name = "PNG", requires = "fluid_force")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    cells: SheetCells,
    /// Paint model of a sheet or a painting [default: impasto]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(model_names()))]
    model: Option<String>,
    /// Seed of the performance [default: 1]
    #[arg(long)]
    seed: Option<u64>,
}

impl DemoOptions {
    /// Refuses options that would do nothing.
    fn check_idle(&self) -> Result<(), UserError> {
        for (option, given, help) in [
            (
                "--marks",
                self.marks,
                "these marks are a take: -o TAKE writes it",
            ),
            (
                "--seed",
                self.seed.is_some(),
                "it is for a performance: -o TAKE writes one; the sheet is always the same",
            ),
        ] {
            if given && self.output.is_none() {
                let what = format!("{option} does nothing beside --sheet alone");
                return Err(UserError::usage(what).help(help));
            }
        }
        for (option, given, help) in [
            (
                "--cell-mm",
                self.cells.cell_mm.is_some(),
                "a take has no cells; `maulstick render --cell-mm` has",
            ),
            (
                "--model",
                self.model.is_some(),
                "a take has no paint; `maulstick render --model` has",
            ),
        ] {
            if given && self.sheet.is_none() {
                let what = format!("{option} does nothing without --sheet PNG or --painting NAME");
                return Err(UserError::usage(what).help(help));
            }
        }
        Ok(())
    }

    /// What is painted on.
    fn board(&self) -> Result<Board, UserError> {
        let board = Board::impasto(self.cells.side_mm());
        let Some(model) = &self.model else {
            return Ok(board);
        };
        let model = model_called(model).map_err(refused)?.name;
        Ok(Board { model, ..board })
    }
}

/// Writes the performance and the sheet.
///
/// # Errors
/// A [`UserError`] where either cannot be written.
pub fn run(options: &DemoOptions) -> Result<i32, UserError> {
    if let Some(name) = &options.painting {
        return run_painting(name, options);
    }
    options.check_idle()?;
    if let (true, Some(output)) = (options.fluid_force, &options.output) {
        return fluid_force::run(
            &options.grid,
            options.filter,
            output,
            options.plot.as_deref(),
        );
    }
    let take = UsedFile::written("the take", options.output.as_ref(), Kind::Take);
    let sheet = UsedFile::written("the sheet", options.sheet.as_ref(), Kind::Png);
    let outputs: Vec<_> = take.into_iter().chain(sheet).collect();
    check_outputs(&outputs, &[])?;
    if let Some(output) = &options.output {
        let subject = match options.marks {
            true => Subject::Marks,
            false => Subject::Flower,
        };
        write_take(&performance(subject, options.seed.unwrap_or(1)), output)?;
    }
    if let Some(path) = &options.sheet {
        let bar = ProgressBar::new(1);
        let picture = effects(&library()?, options.board()?, |done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        })?;
        bar.finish_and_clear();
        write_picture(&picture, path)?;
        say!("{}", path.display());
    }
    Ok(0)
}

/// Writes one of the paintings.
fn run_painting(name: &str, options: &DemoOptions) -> Result<i32, UserError> {
    let library = library()?;
    script(name, &library)?;
    let named = PathBuf::from(format!("{name}.png"));
    let path = options.output.as_ref().unwrap_or(&named);
    check_outputs(&[UsedFile::new("the picture", path).of(Kind::Png)], &[])?;
    let bar = progress_bar(0).with_message("painting");
    let mut offline = paint(name, options.board()?, library, bar)?;
    write_picture(&picture(offline.painting_mut(), CANVAS), path)?;
    say!("{}", path.display());
    Ok(0)
}
