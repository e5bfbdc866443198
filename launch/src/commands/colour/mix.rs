//! `maulstick colour mix`: the colour of a mixture.

use std::path::PathBuf;

use clap::Args;
use maulstick_optics::surface::SurfaceCorrection;
use maulstick_optics::{Blend, Coat, Layer, PaintLibrary, Seen, Spectrum};
use maulstick_rig::UserError;
use serde_json::json;

use maulstick_painting_setup::viewing::ViewingOptions;
use maulstick_painting_setup::{library_from, mixture_of};

use crate::commands::option_error::{OptionError, number_within};
use crate::commands::{print_json, print_text};
use crate::swatch::{Terminal, in_words, sparkline};

/// Options of `maulstick colour mix`.
#[derive(Args, Clone, Debug)]
pub struct MixOptions {
    /// Mixture, shares by volume, such as "2 Cobalt Blue, 1 Titanium White"
    #[arg(value_name = "MIX", required = true)]
    mixtures: Vec<String>,
    #[command(flatten)]
    film: FilmOptions,
    #[command(flatten)]
    viewing: ViewingOptions,
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    paints: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Options of a film of paint.
#[derive(Args, Clone, Debug)]
pub struct FilmOptions {
    /// Thickness of a film, µm, thinner included [default: an opaque layer]
    #[arg(long, value_name = "UM", value_parser = thickness, allow_negative_numbers = true)]
    film_um: Option<f64>,
    /// Ground under the film: white, black, or its reading by an instrument, gloss included, 0 to 1, as in
    /// the column `over` of `maulstick colour fit`
    #[arg(long, value_name = "R", requires = "film_um", default_value = "white", value_parser = ground, allow_negative_numbers = true)]
    over: f64,
    /// Share of clear medium in the film, by volume; does not change an opaque layer
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = share, allow_negative_numbers = true)]
    thinner: f64,
    /// Include the reflections of the paint's surface, as an eye or a spectrometer sees them; otherwise show
    /// the reflectance inside the paint
    #[arg(long)]
    saunderson: bool,
}

fn thickness(text: &str) -> Result<f64, OptionError> {
    number_within(text, 0.0..=100_000.0, "thickness in µm")
}

fn share(text: &str) -> Result<f64, OptionError> {
    number_within(text, 0.0..=1.0, "share")
}

fn ground(text: &str) -> Result<f64, OptionError> {
    match text {
        "white" => Ok(1.0),
        "black" => Ok(0.0),
        _ => number_within(text, 0.0..=1.0, "reading")
            .map_err(|_| OptionError::unexpected(text, "white, black, or a reading from 0 to 1")),
    }
}

impl FilmOptions {
    fn coat(&self) -> Coat {
        Coat {
            layer: match self.film_um {
                None => Layer::Opaque,
                Some(um) => Layer::Film {
                    thickness_m: um * 1e-6,
                    thinner: self.thinner,
                    ground: SurfaceCorrection::default().internal(self.over).max(0.0),
                },
            },
            surface: self.saunderson.then(SurfaceCorrection::default),
        }
    }
}

/// Mixture of a command line.
///
/// # Errors
/// A [`UserError`] for a mixture of no paints.
pub fn blend(text: &str, library: &PaintLibrary) -> Result<Blend, UserError> {
    let mixture = mixture_of(text, library).map_err(|fault| fault.at(format!("{text:?}")))?;
    Blend::of(library, &mixture).map_err(|error| UserError::usage(error.to_string()))
}

/// Shows a mixture.
///
/// # Errors
/// A [`UserError`] for a bad mixture, paint file or light.
pub fn run(options: &MixOptions) -> Result<i32, UserError> {
    let library = &library_from(options.paints.as_deref())?;
    let [text] = options.mixtures.as_slice() else {
        return Err(UserError::usage("more than one mixture")
            .help("put a comma between the paints, and quotes around them: \"A=0.7,B=0.3\""));
    };
    let viewing = options.viewing.viewing(library)?;
    let (blend, coat) = (blend(text, library)?, options.film.coat());
    let (reflectance, seen) = (blend.reflectance(&coat), viewing.coat(&blend, &coat));
    if options.json {
        print_json(&json!({
            "reflectance": reflectance.0.as_slice(),
            "xyz": seen.xyz.map(|value| 100.0 * value),
            "lab": seen.lab,
            "srgb": seen.srgb(),
            "in_gamut": seen.in_gamut(),
        }))?;
    } else {
        print_text(&swatch(text, &reflectance, &seen))?;
    }
    Ok(0)
}

fn swatch(text: &str, reflectance: &Spectrum, seen: &Seen) -> String {
    let block = Terminal::of_stdout().block(seen.bytes(), 12);
    let [x, y, z] = seen.xyz.map(|value| 100.0 * value);
    let [low, high] = reflectance
        .0
        .iter()
        .fold([f64::INFINITY, 0.0], |[low, high], r| {
            [r.min(low), r.max(high)]
        });
    let lines = [
        text.to_owned(),
        in_words(seen),
        format!("XYZ {x:.2} {y:.2} {z:.2}"),
        sparkline(reflectance, high.max(1e-9)),
        format!("reflectance from 380 to 780 nm, {low:.3} to {high:.3}"),
    ];
    lines.map(|line| format!("{block}{line}\n")).concat()
}
