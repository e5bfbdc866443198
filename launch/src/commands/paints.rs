//! `maulstick paints`: the paints to choose from.

use clap::Args;
use maulstick_optics::Studio;
use maulstick_optics::colour::{clamp_chromaticity, srgb_encode};
use maulstick_rig::Fault;
use serde_json::json;

use crate::commands::print_json;
use crate::performance::library;

/// Options of `maulstick paints`.
#[derive(Args, Clone, Debug)]
pub struct PaintsOptions {
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Thickness of an opaque layer, m.
const OPAQUE_M: f64 = 0.01;

/// Lists the paints with their masstones.
///
/// # Errors
/// None in practice.
pub fn run(options: &PaintsOptions) -> Result<i32, Fault> {
    let library = library()?;
    let mut studio = Studio::daylight();
    let black = vec![0.0; studio.wavelengths()];
    let mut rows = Vec::new();
    for paint in library.paints() {
        let slot = studio.add(paint);
        let linear = studio
            .colour(&[(slot, OPAQUE_M)], &black)
            .map(|channel| channel as f32);
        let srgb =
            clamp_chromaticity(linear).map(|c| (srgb_encode(f64::from(c)) * 255.0).round() as u8);
        if options.json {
            rows.push(json!({
                "name": paint.name,
                "colour_index": paint.colour_index,
                "source": paint.source,
                "masstone_srgb": srgb,
            }));
        } else {
            let [r, g, b] = srgb;
            println!(
                "#{r:02x}{g:02x}{b:02x}  {:<26} {:<8} {}",
                paint.name, paint.colour_index, paint.source
            );
        }
    }
    if options.json {
        print_json(&json!({ "paints": rows }))?;
    }
    Ok(0)
}
