//! `maulstick colour paints`: the paints to choose from.

use std::path::PathBuf;

use clap::Args;
use maulstick_optics::{Blend, Coat, Paint, PaintLibrary, RuleKind, StudioSettings, Viewing};
use maulstick_rig::UserError;
use serde_json::json;

use maulstick_painting_setup::library_from;

use crate::commands::{print_json, print_text};
use crate::swatch::{Terminal, hex};

/// Options of `maulstick colour paints`.
#[derive(Args, Clone, Debug)]
pub struct PaintsOptions {
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    paints: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Parts of white to one part of paint.
const TINT: f64 = 10.0;

/// The whitest paint, with which others are tinted.
#[must_use]
pub fn whitest<'a>(library: &'a PaintLibrary, viewing: &Viewing) -> &'a Paint {
    let lightness = |paint: &Paint| {
        let seen = viewing.coat(&Blend::new(&[(paint, 1.0)]), &Coat::masstone());
        seen.lab[0] - seen.chroma()
    };
    let paints = library.paints();
    let whiter = |a: &&Paint, b: &&Paint| lightness(a).total_cmp(&lightness(b));
    paints.iter().max_by(whiter).unwrap_or(&paints[0])
}

/// Lists the paints with their masstones, and their tints of one part in ten of white.
///
/// # Errors
/// A [`UserError`] for a bad paint file.
pub fn run(options: &PaintsOptions) -> Result<i32, UserError> {
    let library = library_from(options.paints.as_deref())?;
    let settings = StudioSettings {
        rule: RuleKind::Reference,
        ..StudioSettings::default()
    };
    let viewing = Viewing::new(&settings, library.paints());
    let white = whitest(&library, &viewing);
    let look = |parts: &[(&Paint, f64)]| {
        let seen = viewing.coat(&Blend::new(parts), &Coat::masstone());
        seen.bytes()
    };
    let terminal = Terminal::of_stdout();
    let (mut rows, mut text) = (Vec::new(), String::new());
    for paint in library.paints() {
        let (masstone, tint) = (look(&[(paint, 1.0)]), look(&[(paint, 1.0), (white, TINT)]));
        rows.push(json!({
            "name": paint.name,
            "colour_index": paint.colour_index,
            "source": paint.source,
            "masstone_srgb": masstone,
            "tint_srgb": tint,
        }));
        let blocks = [masstone, tint].map(|colour| terminal.block(colour, 6));
        text += &format!(
            "{}{} {}  {:<26} {:<8} {}\n",
            blocks.concat(),
            hex(masstone),
            hex(tint),
            paint.name,
            paint.colour_index,
            paint.source
        );
    }
    if options.json {
        print_json(&json!({ "paints": rows }))?
    } else {
        print_text(&text)?
    }
    Ok(0)
}
