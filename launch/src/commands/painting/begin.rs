//! `maulstick painting new`: a new painting in a running rig.

use std::path::{Path, PathBuf};

use clap::Args;
use maulstick_rig::config::{CanvasSection, is_path};
use maulstick_rig::{UserError, whole_path};
use maulstick_types::command::{NewCanvas, RigCommand};
use maulstick_types::region::sides;
use maulstick_types::values::MaterialName;

use maulstick_painting_setup::cells::check_speed;

use crate::commands::client::{Client, Target};
use crate::commands::open::LONGEST;
use crate::commands::option_error::OptionError;
use crate::commands::say;

/// Options of `maulstick painting new`.
#[derive(Args, Clone, Debug)]
pub struct NewOptions {
    /// New file for the painting [default: a sketch; in memory only in a rig without a window]
    file: Option<PathBuf>,
    /// Size of the canvas in cm, such as 40x30 [default: that of rig.toml]
    #[arg(long, value_name = "WxH", value_parser = parse_cm)]
    cm: Option<[f64; 2]>,
    /// Cells per mm
    #[arg(
        long,
        value_name = "N",
        default_value_t = 4.0,
        allow_negative_numbers = true
    )]
    cells_per_mm: f64,
    /// Ground: gesso, grey, black, a CSV file of nm,reflectance, or a picture
    #[arg(long, value_name = "NAME|FILE", default_value = "gesso")]
    ground: String,
    /// Tooth: linen, cotton, panel, paper
    #[arg(long, default_value = "linen")]
    tooth: String,
    /// Number of the pattern: another piece of the same cloth
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Discard the current painting if it is in memory only
    #[arg(long)]
    forget: bool,
    /// Begin a canvas of so small or so many cells that painting on it is slow
    #[arg(long)]
    slow: bool,
    #[command(flatten)]
    target: Target,
}

/// Reads `WxH`.
fn parse_cm(text: &str) -> Result<[f64; 2], OptionError> {
    sides(text).ok_or_else(|| OptionError::unexpected(text, "a size in cm such as 40x30"))
}

/// Creates a painting and opens it.
///
/// # Errors
/// A [`UserError`] for an invalid size, if a file of its name exists, or if no rig runs.
pub fn run(options: &NewOptions) -> Result<i32, UserError> {
    let usual = CanvasSection::default();
    let usual_cm = [usual.width_mm, usual.height_mm].map(|mm| mm * 0.1);
    let [width, height] = options.cm.unwrap_or(usual_cm);
    let canvas = NewCanvas {
        width_m: width * 1e-2,
        height_m: height * 1e-2,
        cell_m: 1e-3 / options.cells_per_mm,
        ground: if is_path(&options.ground) {
            MaterialName::new(whole_path(Path::new(&options.ground))?)?
        } else {
            MaterialName::new(&*options.ground)?
        },
        tooth: MaterialName::new(&*options.tooth)?,
        tooth_seed: options.seed,
        stain_m: usual.stain_um * 1e-6,
    };
    canvas.check()?;
    let section = CanvasSection {
        width_mm: width * 10.0,
        height_mm: height * 10.0,
        cell_mm: canvas.cell_m * 1e3,
        ..usual
    };
    check_speed(&section, options.slow.into())?;
    let command = RigCommand::New {
        path: options.file.as_deref().map(whole_path).transpose()?,
        canvas,
        forget: options.forget,
    };
    let done = Client::open(&options.target)?.send_within(command, LONGEST)?;
    say!("{done}");
    Ok(0)
}
