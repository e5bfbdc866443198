//! The process that plays a take.

use std::path::PathBuf;

use maulstick_device::Take;
use maulstick_device::player::{self, PlayerSettings, Rate};
use maulstick_optics::PaintError;
use maulstick_rig::UserError;
use maulstick_types::Mixture;
use nix::sys::signal::Signal;

use maulstick_painting_setup::refused;

use super::{NodeOptions, PLAYER};

/// Options of the player.
#[derive(clap::Args, Debug)]
pub(crate) struct PlayerOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The take
    #[arg(long, value_name = "TAKE")]
    take: PathBuf,
    /// Playback speed (1 = real time), or 'max'
    #[arg(long, default_value = "1")]
    rate: Rate,
    /// Brush that the take moves
    #[arg(long, default_value = "main")]
    brush: String,
    /// Mixture that each stroke loads, in turn
    #[arg(long, value_name = "MIX")]
    load: Vec<String>,
    /// Take time, ns, up to which it plays as fast as it can
    #[arg(long, default_value_t = 0, hide = true)]
    resume_ns: u64,
    /// Stay after the end
    #[arg(long, hide = true)]
    stay: bool,
    /// Take back first what was painted of it before a crash
    #[arg(long, hide = true)]
    again: bool,
}

pub(super) fn run(options: &PlayerOptions) -> Result<i32, UserError> {
    let loads = options
        .load
        .iter()
        .map(|text| {
            text.parse::<Mixture>()
                .map_err(|error| refused(PaintError::from(error)))
        })
        .collect::<Result<_, _>>()?;
    let settings = PlayerSettings {
        take: Take::read(&options.take)?,
        rate: options.rate,
        resume_ns: options.resume_ns,
        brush: options.brush.clone(),
        loads,
        stay: options.stay,
        again: options.again,
    };
    let mut member = options.node.join(PLAYER, Signal::SIGKILL)?;
    player::run(&mut member, &settings)?;
    member.leave();
    Ok(0)
}
