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

use maulstick_rig::UserError;
use maulstick_tool_options::motions::{MotionCommand, MotionGroup};

fn main() {
    maulstick::beside::tool(|MotionGroup::Take(command)| run(command));
}

/// Runs the subcommand.
///
/// # Errors
/// A [`UserError`] where a take cannot be read or written, or the operation is refused.
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
