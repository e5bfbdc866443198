//! `maulstick demo`: a performance from a seed, and the bundled paintings.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use maulstick_device::demo::{Subject, performance};
use maulstick_painting::picture::picture;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::scene::CANVAS;

use maulstick_painting_setup::library;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_script::paintings::{BoardOptions, paint, script};

use crate::commands::{progress_bar, say, write_picture, write_take};

/// Commands of `maulstick demo`.
#[derive(Clone, Debug, Subcommand)]
pub enum DemoCommand {
    /// Make a take: a flower, or the strokes of a sheet of marks
    Take(TakeOptions),
    /// Paint one of the bundled paintings: still-life, flower, landscape, portrait, wheat-field
    Painting(PaintingOptions),
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

/// Writes the demo.
///
/// # Errors
/// A [`UserError`] where it cannot be written.
pub fn run(command: &DemoCommand) -> Result<i32, UserError> {
    match command {
        DemoCommand::Take(options) => make_take(options),
        DemoCommand::Painting(options) => paint_painting(options),
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
