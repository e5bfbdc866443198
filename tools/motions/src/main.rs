//! Motions of takes: cut, joined, placed, mirrored, retimed, and an outline filled by example.
//!
//! | module | holds |
//! | --- | --- |
//! | [`info`] | the strokes of a take |
//! | [`edits`] | takes changed |
//! | [`fill`] | an outline filled with the strokes of a take |
//! | [`outline_file`] | outlines as files |
//! | [`recorded`] | the motion of one stylus out of a recording |

mod edits;
mod fill;
mod info;
mod outline_file;
mod recorded;

use std::path::PathBuf;

use clap::{Args, Subcommand};
use maulstick::commands::motion::HeadOptions;
use maulstick_rig::UserError;

/// The group of the commands.
#[derive(Debug, Subcommand)]
enum Group {
    /// Takes
    #[command(subcommand)]
    Take(MotionCommand),
}

fn main() {
    maulstick::beside::tool(|Group::Take(command)| run(command));
}

/// Commands of `maulstick take` that change motions.
#[derive(Subcommand, Clone, Debug)]
enum MotionCommand {
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

/// Runs the subcommand.
///
/// # Errors A [`UserError`] where a take cannot be read or written, or the operation is refused.
fn run(command: &MotionCommand) -> Result<i32, UserError> {
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

#[cfg(test)]
mod tests {
    use maulstick::beside::{defined, listed};

    #[test]
    fn maulstick_lists_these_commands() {
        assert_eq!(defined::<super::Group>(), listed("maulstick-motions"));
    }
}
