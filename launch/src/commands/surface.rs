//! `maulstick fill`, `ground` and `tooth`: the canvas of a running rig.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::command::Command;
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::commands::session::{PAINT, Session, Target};
use crate::ground::GroundFile;
use crate::performance::{library, mixture_of};

/// Options of `maulstick fill`.
#[derive(Args, Clone, Debug)]
pub struct FillOptions {
    /// Mixture, such as "Yellow Ochre=0.7,Titanium White=0.3"
    #[arg(required_unless_present = "with_brush", conflicts_with = "with_brush")]
    mixture: Option<String>,
    /// Use the mean colour of the paint on this brush instead
    #[arg(long, value_name = "BRUSH")]
    with_brush: Option<String>,
    /// Thickness of the film, µm
    #[arg(long, default_value_t = 50.0, allow_negative_numbers = true)]
    um: f64,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick ground`.
#[derive(Args, Clone, Debug)]
pub struct GroundOptions {
    /// Ground: gesso, grey, black, or a CSV file of nm,reflectance
    #[arg(value_name = "NAME|FILE")]
    ground: String,
    #[command(flatten)]
    target: Target,
}

/// Options of `maulstick tooth`.
#[derive(Args, Clone, Debug)]
pub struct ToothOptions {
    /// Tooth: linen, cotton, panel, paper
    tooth: String,
    /// Number of the pattern: another piece of the same cloth
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    target: Target,
}

fn send(target: &Target, command: Command) -> Result<i32, UserError> {
    Session::command(target, PAINT, command)?;
    Ok(0)
}

/// Lays an even film.
///
/// # Errors
/// A [`UserError`] for an unknown paint, or where no rig runs.
pub fn fill(options: &FillOptions) -> Result<i32, UserError> {
    let surface = if options.palette { PALETTE } else { CANVAS };
    let thickness_m = options.um * 1e-6;
    if let Some(brush) = options.with_brush.clone() {
        let command = Command::FillWith {
            surface,
            brush,
            thickness_m,
        };
        return send(&options.target, command);
    }
    let text = options.mixture.as_deref().unwrap_or_default();
    let mixture = match mixture_of(text, &library()?) {
        Ok(mixture) => mixture,
        // The rig may have paints of its own: it knows best.
        Err(fault) => text.parse().map_err(|_| fault)?,
    };
    let command = Command::Fill {
        surface,
        mixture,
        thickness_m,
    };
    send(&options.target, command)
}

/// Gives the canvas another ground.
///
/// # Errors
/// A [`UserError`] for an unknown ground or an invalid file, or if no rig runs.
pub fn ground(options: &GroundOptions) -> Result<i32, UserError> {
    let surface = CANVAS;
    let command = match GroundFile::read(&options.ground)? {
        GroundFile::Named(ground) => Command::Ground { surface, ground },
        GroundFile::Spectrum(spectrum) => Command::GroundSpectrum { surface, spectrum },
        GroundFile::Picture(_, name) => {
            return Err(UserError::usage("a running rig takes no picture as ground")
                .at(name)
                .help(
                    "close it: `maulstick painting import FILE PICTURE --as ground`; or begin with it: \
                     `maulstick up --ground PICTURE`",
                ));
        }
    };
    send(&options.target, command)
}

/// Gives the canvas another tooth.
///
/// # Errors
/// A [`UserError`] for an unknown tooth, or where no rig runs.
pub fn tooth(options: &ToothOptions) -> Result<i32, UserError> {
    let command = Command::Tooth {
        surface: CANVAS,
        tooth: options.tooth.clone(),
        seed: options.seed,
    };
    send(&options.target, command)
}
