//! An outline filled with the strokes of a take.

use maulstick_device::Take;
use maulstick_motion::{Fill, filled, strokes};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;

use maulstick::commands::{say, write_take};
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_tool_options::motion::refused;
use maulstick_tool_options::motions::FillOptions;

use crate::outline_file::read_outline;

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
