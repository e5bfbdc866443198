//! An outline filled with the strokes of a take.

use std::path::PathBuf;

use clap::Args;
use maulstick_device::Take;
use maulstick_motion::{Fill, filled, strokes};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;

use crate::outline_file::read_outline;
use maulstick::commands::motion::{HeadOptions, refused};
use maulstick::commands::{say, write_take};
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

/// Options of `maulstick take fill`.
#[derive(Args, Clone, Debug)]
pub(crate) struct FillOptions {
    /// Take that shows how: some strokes beside each other, or dabs
    #[arg(long, value_name = "TAKE")]
    example: PathBuf,
    /// Outline: an SVG file, a take whose strokes go around it, or a table of x,y in mm; the middle of the page is that of
    /// the desk
    #[arg(long, value_name = "OUTLINE")]
    into: PathBuf,
    /// Take to write [default: the outline's name, ending in -fill.mcap]
    #[arg(short, long, value_name = "TAKE")]
    output: Option<PathBuf>,
    /// Seed of what varies from stroke to stroke
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Distance of the brush's middle from the outline at least, mm [default: half the width of its head]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    inset_mm: Option<f64>,
    #[command(flatten)]
    head: HeadOptions,
}

impl FillOptions {
    /// The take that is written.
    fn output(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| {
            let stem = self.into.file_stem().unwrap_or_default().to_string_lossy();
            PathBuf::from(format!("{stem}-fill.mcap"))
        })
    }
}

pub(crate) fn run(options: &FillOptions) -> Result<i32, UserError> {
    let output = options.output();
    check_outputs(
        &[UsedFile::new("the take", &output).of(Kind::Take)],
        &[
            UsedFile::new("the example", &options.example),
            UsedFile::new("the outline", &options.into),
        ],
    )?;
    let example = Take::read(&options.example)?;
    let held = options.head.of(&example, &options.example)?;
    let clearance_m = match options.inset_mm {
        Some(mm) if (0.0..=1000.0).contains(&mm) => 1e-3 * mm,
        Some(mm) => {
            return Err(
                UserError::usage(format!("--inset-mm {mm} is not within 0 and 1000"))
                    .help("0 lets the middle of the brush reach the outline"),
            );
        }
        None => 0.5 * held.width_m,
    };
    let outline = read_outline(&options.into, held.length_m)?;
    let fill = Fill {
        seed: options.seed,
        clearance_m,
        head_m: held.length_m,
    };
    let samples = filled(&example.samples, &outline, &fill).map_err(refused(&options.example))?;
    let laid = strokes(&samples, held.length_m).len();
    write_take(&Take { samples, ..example }, &output)?;
    say!(
        "{laid} strokes, {:.1} mm from the outline",
        1e3 * clearance_m
    );
    Ok(0)
}
