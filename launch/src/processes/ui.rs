//! The process of the window.

use maulstick_rig::UserError;
use nix::sys::signal::Signal;

use maulstick_painting_setup::destination::{VIEW, export};
use maulstick_painting_setup::library_from;

use super::{MOUSE, NodeOptions, PEN};

/// Options of the window.
#[derive(clap::Args, Debug)]
pub(crate) struct UiOptions {
    #[command(flatten)]
    node: NodeOptions,
}

pub(super) fn run(options: &UiOptions) -> Result<i32, UserError> {
    let member = options.node.join("ui", Signal::SIGKILL)?;
    let by_signal = member.stop.clone();
    let export = export(&member.config.view, VIEW)?;
    let library = library_from(member.config.paint.paints.as_deref())?;
    member.pulse_beside()?;
    maulstick_ui::run(member, [MOUSE, PEN], &export, library)?;
    // Ended by a signal it has not been closed by the painter.
    Ok(i32::from(by_signal.by_signal()))
}
