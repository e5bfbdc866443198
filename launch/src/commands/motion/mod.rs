//! `maulstick take cut`, `join`, …: takes cut, joined, placed, mirrored, retimed, and laid into outlines by example.
//!
//! | module | holds |
//! | --- | --- |
//! | [`edits`] | operations on a take |
//! | [`info`], [`recorded`] | strokes of a take; the motion of one stylus out of a recording |
//! | [`fill`], [`outline_file`] | an outline filled by example; outlines as files |

mod edits;
mod fill;
mod info;
mod outline_file;
mod recorded;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use maulstick_device::{Take, held_brush};
use maulstick_motion::MotionError;
use maulstick_rig::UserError;
use maulstick_types::stylus::StylusPose;

use crate::performance::of_a_brush;

/// Commands of `maulstick take` that change motions.
#[derive(Subcommand, Clone, Debug)]
pub enum MotionCommand {
    /// List the strokes of a take
    Strokes(info::InfoOptions),
    /// Cut a part out of a take, by times or by strokes
    Cut(edits::CutOptions),
    /// Join takes; the brush is lifted between them
    Join(edits::JoinOptions),
    /// Scale a motion on the surface; pressures and heights above it stay
    Scale(edits::ScaleOptions),
    /// Turn a motion on the surface
    Rotate(edits::RotateOptions),
    /// Move a motion on the surface
    Move(edits::MoveOptions),
    /// Make a motion faster or slower
    Retime(edits::RetimeOptions),
    /// Mirror a motion
    Mirror(edits::MirrorOptions),
    /// Fill an outline with the strokes of an example
    Fill(fill::FillOptions),
}

/// Length of the head of a 6-DOF stylus.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct HeadOptions {
    /// Length of the head that a 6-DOF stylus holds, mm: its point is so far below the ferrule [default: that of the brush
    /// that the take embeds, else of the brush of a new rig]
    #[arg(long, value_name = "MM")]
    head_mm: Option<f64>,
}

/// The head that a take is painted with.
#[derive(Clone, Copy, Debug)]
struct HeldHead {
    /// Its length, m.
    length_m: f64,
    /// Its width, m.
    width_m: f64,
}

impl HeadOptions {
    /// The head that a take is painted with: the one that it embeds, or that of a new rig.
    fn of(self, take: &Take, path: &Path) -> Result<HeldHead, UserError> {
        let file = held_brush(take, path).map_err(of_a_brush)?;
        let length_m = self.given_m()?.unwrap_or_else(|| file.length_m());
        Ok(HeldHead {
            length_m,
            width_m: 1e-3 * file.head.width_mm,
        })
    }

    /// The length that is given, m.
    pub(crate) fn given_m(self) -> Result<Option<f64>, UserError> {
        let is_wrong = |mm: &f64| !(1.0..=500.0).contains(mm);
        if let Some(mm) = self.head_mm.filter(is_wrong) {
            let what = format!("--head-mm {mm} is not within 1 and 500");
            return Err(UserError::usage(what).help("measure from the ferrule to the point"));
        }
        Ok(self.head_mm.map(|mm| 1e-3 * mm))
    }

    /// As [`of`](Self::of), its length; 0 where only pens are in the take, whose points are their own.
    fn length_m(self, take: &Take, path: &Path) -> Result<f64, UserError> {
        let is_pen = |pose: &StylusPose| matches!(pose, StylusPose::Contact { .. });
        match take.samples.iter().all(|taken| is_pen(&taken.sample.pose)) {
            true => Ok(0.0),
            false => Ok(self.of(take, path)?.length_m),
        }
    }
}

/// A fault of a motion as the user sees it.
fn refused(path: &Path) -> impl Fn(MotionError) -> UserError {
    move |fault| {
        let error = UserError::usage(fault.to_string()).at(path.display().to_string());
        error.help(fault.help())
    }
}

/// Reads `X,Y`, mm.
pub(crate) fn parse_place(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|mm| mm.is_finite());
    text.split_once(',')
        .and_then(|(x, y)| Some([number(x)?, number(y)?]))
        .ok_or_else(|| format!("'{text}' is not a place such as 20,-12.5"))
}

/// Runs the subcommand.
///
/// # Errors
/// A [`UserError`] where a take cannot be read or written, or the motion refuses what is asked.
pub fn run(command: &MotionCommand) -> Result<i32, UserError> {
    match command {
        MotionCommand::Strokes(options) => info::run(options),
        MotionCommand::Cut(options) => edits::cut(options),
        MotionCommand::Join(options) => edits::join(options),
        MotionCommand::Scale(options) => edits::scale(options),
        MotionCommand::Rotate(options) => edits::rotate(options),
        MotionCommand::Move(options) => edits::shift(options),
        MotionCommand::Retime(options) => edits::retime(options),
        MotionCommand::Mirror(options) => edits::mirror(options),
        MotionCommand::Fill(options) => fill::run(options),
    }
}

/// The files of an operation on one take.
#[derive(Args, Clone, Debug)]
struct TakeFiles {
    /// Take, which is not changed
    take: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    #[command(flatten)]
    head: HeadOptions,
}
