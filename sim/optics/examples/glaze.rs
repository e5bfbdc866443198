//! Prints the reflectance of a glaze over a white ground, by wavelength and thickness, as CSV to be plotted:
//!
//! ```text
//! cargo run --release -p maulstick-optics --example glaze -- "Quinacridone Magenta" > glaze.csv
//! ```

use std::error::Error;

use maulstick_optics::PaintLibrary;
use maulstick_optics::km::{film, over};
use maulstick_optics::spectrum::wavelength;
use maulstick_optics::surface::SurfaceCorrection;

/// Thicknesses of the glaze, µm.
const THICKNESS_UM: [f64; 5] = [0.0, 5.0, 10.0, 20.0, 40.0];
/// Internal reflectance of the ground at all wavelengths.
const GROUND: f64 = 0.95;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1);
    let library = PaintLibrary::measured()?;
    let paint = library.find(name.as_deref().unwrap_or("Quinacridone Magenta"))?;
    let surface = SurfaceCorrection::STANDARD;
    let headings = THICKNESS_UM.map(|um| format!("{um} um"));
    println!("nm,{}", headings.join(","));
    for (sample, (k, s)) in paint.k.0.iter().zip(paint.s.0).enumerate() {
        let measured = THICKNESS_UM.map(|um| {
            let glaze = film(k * um * 1e-6, s * um * 1e-6);
            format!("{:.4}", surface.measured(over(glaze, GROUND)))
        });
        println!("{},{}", wavelength(sample), measured.join(","));
    }
    Ok(())
}
