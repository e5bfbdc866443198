//! `maulstick brush mode`, `size` and `piles`: handling of brushes and preparation of surfaces.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::PILES;
use maulstick_types::advice::choice;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, MARKER_FLOW, PALETTE};

use crate::commands::session::{PAINT, Session, Target};

/// Options of `maulstick brush mode`.
#[derive(Args, Clone, Debug)]
pub struct ModeOptions {
    /// Mode: normal, no-push, sponge, sponge-no-push, marker, sampler or vacuum
    mode: String,
    /// Flow of the marker, µm of paint per mm of its path
    #[arg(long, value_name = "UM_PER_MM", allow_negative_numbers = true)]
    flow: Option<f64>,
    /// Add no paint where the wet film is this thick, µm
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    most_um: Option<f64>,
    /// Brush of the rig
    #[arg(long, default_value = "main")]
    brush: String,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick size`.
#[derive(Args, Clone, Debug)]
pub struct SizeOptions {
    /// Thickness of paint that cannot be brushed off, µm; 0: a well-sized canvas
    #[arg(allow_negative_numbers = true)]
    stain_um: f64,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick piles`.
#[derive(Args, Clone, Debug)]
pub struct PilesOptions {
    /// Paint on the palette when brushes take it up: deplete, or last
    piles: String,
    #[command(flatten)]
    target: Target,
}

/// Handling of a brush in a painter's units: flow in µm/mm, most paint in µm.
///
/// # Errors
/// A [`UserError`] for an unknown mode, with the nearest, for numbers out of range, or for one that does nothing with this
/// mode.
pub fn handling(
    brush: &str,
    mode: &str,
    flow: Option<f64>,
    most_um: Option<f64>,
) -> Result<BrushHandling, UserError> {
    let called = BrushMode::called(mode).map_err(UserError::told)?;
    if flow.is_some() && called != BrushMode::Marker {
        return Err(
            UserError::usage(format!("a flow does nothing with the mode {mode}"))
                .help("leave the flow out, or choose the mode marker"),
        );
    }
    if most_um.is_some() && matches!(called, BrushMode::Sampler | BrushMode::Vacuum) {
        return Err(
            UserError::usage(format!("most_um does nothing with the mode {mode}"))
                .help("leave it out: the mode adds no paint to the canvas"),
        );
    }
    let handling = BrushHandling {
        mode: called,
        flow: flow.map_or(MARKER_FLOW, |um_per_mm| um_per_mm * 1e-3),
        most_m: most_um.unwrap_or(0.0) * 1e-6,
        ..BrushHandling::normal(brush)
    };
    let command = Command::Handle {
        handling: handling.clone(),
    };
    command.check().map_err(UserError::told)?;
    Ok(handling)
}

/// Command for the piles on the palette.
///
/// # Errors
/// A [`UserError`] for anything but [`PILES`].
pub fn piles_command(piles: &str) -> Result<Command, UserError> {
    let surface = PALETTE;
    match piles {
        "last" => Ok(Command::Piles {
            surface,
            last: true,
        }),
        "deplete" => Ok(Command::Piles {
            surface,
            last: false,
        }),
        _ => Err(UserError::usage(format!("piles cannot '{piles}'")).help(choice(piles, PILES))),
    }
}

fn send(target: &Target, command: Command) -> Result<i32, UserError> {
    Session::command(target, PAINT, command)?;
    Ok(0)
}

/// Uses a brush in another way.
///
/// # Errors
/// A [`UserError`] for an unknown mode or brush, or where no rig runs.
pub fn mode(options: &ModeOptions) -> Result<i32, UserError> {
    let handling = handling(&options.brush, &options.mode, options.flow, options.most_um)?;
    send(&options.target, Command::Handle { handling })
}

/// Sizes the canvas.
///
/// # Errors
/// A [`UserError`] for a thickness out of range, or where no rig runs.
pub fn size(options: &SizeOptions) -> Result<i32, UserError> {
    let command = Command::Size {
        surface: CANVAS,
        stain_m: options.stain_um * 1e-6,
    };
    send(&options.target, command)
}

/// Says what piles on the palette do.
///
/// # Errors
/// A [`UserError`] for an unknown word, or where no rig runs.
pub fn piles(options: &PilesOptions) -> Result<i32, UserError> {
    send(&options.target, piles_command(&options.piles)?)
}
