//! Commands of `maulstick-motions`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use maulstick_device::TakeSample;
use maulstick_motion::join::PAUSE_S;
use maulstick_motion::strokes::middle;
use thiserror::Error;

use crate::motion::{HeadOptions, parse_place};

/// The group of the commands.
#[derive(Debug, Subcommand)]
pub enum MotionGroup {
    /// Takes
    #[command(subcommand)]
    Take(MotionCommand),
}

/// Commands of `maulstick take` that change motions.
#[derive(Subcommand, Clone, Debug)]
pub enum MotionCommand {
    /// List the strokes of a take
    Strokes(StrokesOptions),
    /// Cut a part out of a take, by times or by strokes
    Cut(CutOptions),
    /// Join takes; the brush is lifted between them
    Join(JoinOptions),
    /// Scale a motion on the surface; pressures and heights above it stay
    Scale(ScaleOptions),
    /// Turn a motion on the surface
    Rotate(RotateOptions),
    /// Move a motion on the surface
    Move(MoveOptions),
    /// Make a motion faster or slower
    Retime(RetimeOptions),
    /// Mirror a motion
    Mirror(MirrorOptions),
    /// Fill an outline with the strokes of an example
    Fill(FillOptions),
}

/// The files of an operation on one take.
#[derive(Args, Clone, Debug)]
pub struct TakeFiles {
    /// Take, which is not changed
    pub take: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    pub output: PathBuf,
    /// The head that the takes are painted with.
    #[command(flatten)]
    pub head: HeadOptions,
}

/// Options of `maulstick take strokes`.
#[derive(Args, Clone, Debug)]
pub struct StrokesOptions {
    /// Take, or recording
    pub take: PathBuf,
    /// Stylus of a recording, such as pen
    #[arg(long, value_name = "DEVICE")]
    pub device: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// The head that the takes are painted with.
    #[command(flatten)]
    pub head: HeadOptions,
}

/// Options of `maulstick take cut`.
#[derive(Args, Clone, Debug)]
pub struct CutOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// Stylus of a recording whose motion is cut, such as pen [default: the only one of a take]
    #[arg(long, value_name = "DEVICE")]
    pub device: Option<String>,
    /// From so many seconds after its beginning [default: 0]
    #[arg(long, value_name = "S", conflicts_with = "strokes")]
    pub start: Option<f64>,
    /// To so many seconds after its beginning [default: its end]
    #[arg(long, value_name = "S", conflicts_with = "strokes")]
    pub end: Option<f64>,
    /// Strokes to keep, by their numbers: 3, or 2-5
    #[arg(long, value_name = "N|N-M", value_parser = parse_strokes, required_unless_present_any = ["start", "end"])]
    pub strokes: Option<[usize; 2]>,
}

/// Options of `maulstick take join`.
#[derive(Args, Clone, Debug)]
pub struct JoinOptions {
    /// Takes, in order, which are not changed
    #[arg(required = true, num_args = 2..)]
    pub takes: Vec<PathBuf>,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    pub output: PathBuf,
    /// Pause between two takes at least, .2 to 60 s; a long way takes longer
    #[arg(long, value_name = "S", default_value_t = PAUSE_S)]
    pub pause: f64,
    /// The head that the takes are painted with.
    #[command(flatten)]
    pub head: HeadOptions,
}

/// A point of the surface about which a motion is changed.
#[derive(Args, Clone, Copy, Debug)]
pub struct AboutOptions {
    /// Point that stays, mm from the middle of the desk [default: the middle of its strokes]
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    pub about: Option<[f64; 2]>,
}

/// Options of `maulstick take scale`.
#[derive(Args, Clone, Debug)]
pub struct ScaleOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// Factor, .01 to 100
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    pub by: f64,
    /// The point that stays.
    #[command(flatten)]
    pub about: AboutOptions,
}

/// Options of `maulstick take rotate`.
#[derive(Args, Clone, Debug)]
pub struct RotateOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// Angle, degrees, counter-clockwise
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub by: f64,
    /// The point that stays.
    #[command(flatten)]
    pub about: AboutOptions,
}

/// Options of `maulstick take move`.
#[derive(Args, Clone, Debug)]
pub struct MoveOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// To the right and up, mm
    #[arg(long, value_name = "X,Y", value_parser = parse_place, allow_hyphen_values = true)]
    pub by: [f64; 2],
}

/// Options of `maulstick take retime`.
#[derive(Args, Clone, Debug)]
pub struct RetimeOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// Rate, .01 to 100: 2 is twice as fast
    #[arg(
        long,
        value_name = "R",
        required_unless_present = "seconds",
        allow_negative_numbers = true
    )]
    pub rate: Option<f64>,
    /// Duration of all of it, s
    #[arg(
        long,
        value_name = "S",
        conflicts_with = "rate",
        allow_negative_numbers = true
    )]
    pub seconds: Option<f64>,
}

/// What a mirror exchanges.
#[derive(ValueEnum, Clone, Copy, Debug)]
pub enum MirrorAxis {
    /// Left and right
    X,
    /// Above and below
    Y,
}

/// Options of `maulstick take mirror`.
#[derive(Args, Clone, Debug)]
pub struct MirrorOptions {
    /// Its files.
    #[command(flatten)]
    pub files: TakeFiles,
    /// Exchange left and right (x), or above and below (y)
    #[arg(long, value_name = "AXIS", default_value = "x")]
    pub axis: MirrorAxis,
    /// The point that stays.
    #[command(flatten)]
    pub about: AboutOptions,
}

/// Text that is neither a number nor a range.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{0}' is neither a number nor a range such as 2-5")]
pub struct NoStrokes(String);

/// Reads `N` or `N-M`.
fn parse_strokes(text: &str) -> Result<[usize; 2], NoStrokes> {
    let number = |part: &str| part.trim().parse::<usize>().ok();
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    number(first)
        .zip(number(last))
        .map(<[usize; 2]>::from)
        .ok_or_else(|| NoStrokes(text.to_owned()))
}

impl AboutOptions {
    /// The point, m.
    #[must_use]
    pub fn point(self, samples: &[TakeSample], head_m: f64) -> [f64; 2] {
        let given = self.about.map(|place| place.map(|mm| 1e-3 * mm));
        given.unwrap_or_else(|| middle(samples, head_m))
    }
}

/// Options of `maulstick take fill`.
#[derive(Args, Clone, Debug)]
pub struct FillOptions {
    /// Take that shows how: some strokes beside each other, or dabs
    #[arg(long, value_name = "TAKE")]
    pub example: PathBuf,
    /// Outline: an SVG file, a take whose strokes go around it, or a table of x,y in mm; the middle of the page is that of
    /// the desk
    #[arg(long, value_name = "OUTLINE")]
    pub into: PathBuf,
    /// Take to write [default: the outline's name, ending in -fill.mcap]
    #[arg(short, long, value_name = "TAKE")]
    pub output: Option<PathBuf>,
    /// Seed of what varies from stroke to stroke
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Distance of the brush's middle from the outline at least, mm [default: half the width of its head]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub inset_mm: Option<f64>,
    /// The head that the takes are painted with.
    #[command(flatten)]
    pub head: HeadOptions,
}

impl FillOptions {
    /// The take that is written.
    #[must_use]
    pub fn output(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| {
            let stem = self.into.file_stem().unwrap_or_default().to_string_lossy();
            PathBuf::from(format!("{stem}-fill.mcap"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_strokes_are_read() {
        assert_eq!(parse_strokes("3"), Ok([3, 3]));
        assert_eq!(parse_strokes("2-5"), Ok([2, 5]));
        for wrong in ["", "a", "2-", "-3", "1.5"] {
            assert!(parse_strokes(wrong).is_err(), "{wrong}");
        }
    }
}
