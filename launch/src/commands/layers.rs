//! `maulstick dry` and `maulstick opacity`: dry layers of a running rig.

use clap::Args;
use maulstick_rig::Fault;
use maulstick_types::command::Command;
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::commands::say;
use crate::commands::session::{PAINT, Session, Target};

/// Options of `maulstick dry`.
#[derive(Args, Clone, Debug)]
pub struct DryOptions {
    /// The lower share of the wet film that dries
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    share: f32,
    /// Name of the layer; its number if absent
    #[arg(long = "layer", value_name = "NAME", default_value = "")]
    layer: String,
    /// The palette in the place of the canvas
    #[arg(long)]
    palette: bool,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick opacity`.
#[derive(Args, Clone, Debug)]
pub struct OpacityOptions {
    /// Number of the layer
    layer: u32,
    /// Factor on its optical thickness, 0 to 1; its height stays
    #[arg(allow_negative_numbers = true)]
    opacity: f32,
    #[command(flatten)]
    target: Target,
}

/// Dries what is wet.
///
/// # Errors
/// A [`Fault`] where nothing is wet, or no rig runs.
pub fn dry(options: &DryOptions) -> Result<i32, Fault> {
    let command = Command::Dry {
        surface: if options.palette { PALETTE } else { CANVAS },
        share: options.share,
        name: options.layer.clone(),
    };
    command.check().map_err(Fault::usage)?;
    say!(
        "dried: {}",
        Session::open(&options.target)?.send(PAINT, command)?
    );
    Ok(0)
}

/// Makes a layer more or less opaque.
///
/// # Errors
/// A [`Fault`] for an unknown layer, or where no rig runs.
pub fn opacity(options: &OpacityOptions) -> Result<i32, Fault> {
    let command = Command::Opacity {
        layer: options.layer,
        opacity: options.opacity,
    };
    command.check().map_err(Fault::usage)?;
    Session::open(&options.target)?.send(PAINT, command)?;
    Ok(0)
}
