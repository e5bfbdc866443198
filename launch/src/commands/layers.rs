//! `maulstick dry`, `wet` and `opacity`: dry layers of a running rig.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::Region;
use maulstick_types::command::Command;
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::commands::say;
use crate::commands::session::{PAINT, Session, Target};
use crate::duration::ticks_in;

/// Options of `maulstick dry`.
#[derive(Args, Clone, Debug)]
pub struct DryOptions {
    /// Share of the wet film to dry, from below, above 0 to 1
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    share: f32,
    /// Name of the new layer [default: its number]
    #[arg(long = "layer", value_name = "NAME", default_value = "")]
    layer: String,
    /// Only this rectangle, mm from the lower left corner of the surface
    #[arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)]
    region: Option<Region>,
    /// Dry all wet paint evenly over this time, such as 90s, 20min, 2h; you can paint meanwhile
    #[arg(long, value_name = "TIME", value_parser = ticks_in, conflicts_with = "share")]
    over: Option<u32>,
    /// Stop a running drying; what is still wet stays wet
    #[arg(long, conflicts_with_all = ["share", "layer", "region", "over"])]
    stop: bool,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick wet`.
#[derive(Args, Clone, Debug)]
pub struct WetOptions {
    /// Number of the newest dry layers to make wet
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    layers: u32,
    /// Make all dry layers wet
    #[arg(long, conflicts_with = "layers")]
    all: bool,
    /// Only this rectangle, mm from the lower left corner of the surface
    #[arg(long, value_name = "X,Y,WxH", allow_hyphen_values = true)]
    region: Option<Region>,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick opacity`.
#[derive(Args, Clone, Debug)]
pub struct OpacityOptions {
    /// Name or number of the layer
    layer: String,
    /// Factor on its optical thickness, 0 to 1; its height does not change
    #[arg(allow_negative_numbers = true)]
    opacity: f32,
    #[command(flatten)]
    target: Target,
}

fn surface(palette: bool) -> u32 {
    if palette { PALETTE } else { CANVAS }
}

fn send(target: &Target, command: Command) -> Result<String, UserError> {
    Session::command(target, PAINT, command)
}

/// Dries what is wet.
///
/// # Errors
/// A [`UserError`] where nothing is wet, or no rig runs.
pub fn dry(options: &DryOptions) -> Result<i32, UserError> {
    let (surface, name) = (surface(options.palette), options.layer.clone());
    let region = options.region.clone();
    let command = match (options.stop, options.over, region) {
        (true, ..) => Command::StopDrying { surface },
        (_, Some(ticks), region) => Command::DryOver {
            surface,
            ticks,
            name,
            region,
        },
        (_, None, Some(region)) => Command::DryRegion {
            surface,
            share: options.share,
            name,
            region,
        },
        (_, None, None) => Command::Dry {
            surface,
            share: options.share,
            name,
        },
    };
    let done = send(&options.target, command)?;
    match (options.stop, options.over) {
        (true, _) => say!("the drying is ended"),
        (_, Some(_)) => say!("dries {done}"),
        _ => say!("dried: {done}"),
    }
    Ok(0)
}

/// Makes dry layers wet again.
///
/// # Errors
/// A [`UserError`] where nothing has dried, or no rig runs.
pub fn wet(options: &WetOptions) -> Result<i32, UserError> {
    let command = Command::Wet {
        surface: surface(options.palette),
        layers: if options.all { 0 } else { options.layers },
        region: options.region.clone(),
    };
    say!("wet again: {}", send(&options.target, command)?);
    Ok(0)
}

/// Makes a layer more or less opaque.
///
/// # Errors
/// A [`UserError`] for an unknown layer, or where no rig runs.
pub fn opacity(options: &OpacityOptions) -> Result<i32, UserError> {
    let command = Command::LayerOpacity {
        layer: options.layer.clone(),
        opacity: options.opacity,
    };
    send(&options.target, command)?;
    Ok(0)
}
