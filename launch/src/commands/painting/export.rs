//! `maulstick painting export`: a painting for other programs.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use indicatif::ProgressBar;
use maulstick_exchange::{
    ExchangeError, StlSetup, stl_step, write_height_map, write_lit_png, write_open_exr,
    write_open_raster, write_stl,
};
use maulstick_paint::Painting;
use maulstick_paint::picture::Depth;
use maulstick_rig::config::ViewSection;
use maulstick_rig::{Fault, files};
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::commands::say;
use crate::destination::export;
use crate::document::{read, wrong};
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::refused;

/// Formats of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// The painting under its light
    Png,
    /// Unlit linear colour, height, and each paint's thickness, wet and dry: OpenEXR
    Exr,
    /// A layer for each dry layer: OpenRaster
    Ora,
    /// Heights as a grey PNG of 16 bits
    Height,
    /// A solid for relief printing
    Stl,
}

/// Options of `maulstick painting export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// The painting
    file: PathBuf,
    /// What to write: .png, .exr, .ora or .stl
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The format, where the name does not say it; `height` is a PNG too
    #[arg(long)]
    format: Option<Format>,
    /// The palette in the place of the canvas
    #[arg(long)]
    palette: bool,
    /// Bits a channel of a PNG: 8, 16
    #[arg(long, default_value_t = 8)]
    bits: u32,
    /// Profile of a PNG: srgb, display-p3, or an ICC file
    #[arg(long, value_name = "PROFILE", default_value = "srgb")]
    profile: String,
    /// How colours of a PNG come into its gamut: soft, clamp
    #[arg(long, value_name = "MAPPING", default_value = "soft")]
    gamut: String,
    /// Thickness of a solid under its lowest place, mm
    #[arg(long, default_value_t = 2.0, allow_negative_numbers = true)]
    base_mm: f64,
    /// Factor on the heights of a solid
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    exaggeration: f64,
    /// Cells from one point of a solid to the next; so that it has 4 million triangles at most if
    /// absent
    #[arg(long, value_name = "CELLS")]
    step: Option<u32>,
}

impl ExportOptions {
    fn format(&self) -> Result<Format, Fault> {
        let ending = self.output.extension().and_then(|ending| ending.to_str());
        let named = ending.and_then(|ending| Format::from_str(ending, true).ok());
        self.format.or(named).ok_or_else(|| {
            Fault::usage("the name does not say which format to write")
                .at(self.output.display().to_string())
                .help("end it in .png, .exr, .ora or .stl, or give --format")
        })
    }

    fn depth(&self) -> Result<Depth, Fault> {
        match self.bits {
            8 => Ok(Depth::Eight),
            16 => Ok(Depth::Sixteen),
            other => Err(Fault::usage(format!("a PNG of {other} bits a channel"))
                .at("--bits")
                .help("choose 8 or 16")),
        }
    }
}

/// Writes a painting for other programs.
///
/// # Errors
/// A [`Fault`] where the painting cannot be read or the file not be written.
pub(super) fn run(options: &ExportOptions) -> Result<i32, Fault> {
    let (format, depth) = (options.format()?, options.depth()?);
    let view = ViewSection {
        profile: options.profile.clone(),
        gamut: options.gamut.clone(),
    };
    let look = export(&view, "--profile, --gamut")?;
    let out = &options.output;
    let inputs: Vec<_> = UsedFile::painting(&options.file)
        .chain(UsedFile::given("the profile", view.file()))
        .collect();
    check_outputs(&[UsedFile::new("the export", out)], &inputs)?;
    let (_document, opened) = read(&options.file)?;
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let painting = sequencer.painting_mut();
    let surface = if options.palette { PALETTE } else { CANVAS };
    let bar = super::bar("exporting");
    let mut tell = super::tell(&bar);
    match format {
        Format::Png => write(options, &bar, |file| {
            write_lit_png(painting, surface, (&look, depth), file, &mut tell)
        }),
        Format::Exr => write(options, &bar, |file| {
            write_open_exr(painting, surface, file, &mut tell)
        }),
        Format::Ora => write(options, &bar, |file| {
            write_open_raster(painting, surface, file, &mut tell)
        }),
        Format::Height => {
            let range = write(options, &bar, |file| {
                write_height_map(painting, surface, file, &mut tell)
            })?;
            let [least, greatest] = [range.least_m, range.greatest_m].map(|m| f64::from(m) * 1e6);
            say!("black is {least:.1} µm, white is {greatest:.1} µm");
            Ok(())
        }
        Format::Stl => {
            let setup = solid(options, painting, surface);
            let size = write(options, &bar, |file| {
                write_stl(painting, surface, &setup, file, &mut tell)
            })?;
            let [x, y, z] = size.size_mm;
            say!("{} triangles, {x:.1} × {y:.1} × {z:.2} mm", size.triangles);
            Ok(())
        }
    }?;
    say!("{}", out.display());
    Ok(0)
}

fn solid(options: &ExportOptions, painting: &Painting, surface: u32) -> StlSetup {
    let cells = painting
        .store(surface)
        .map_or([1, 1], |store| store.cells());
    StlSetup {
        base_mm: options.base_mm,
        exaggeration: options.exaggeration,
        step: options.step.unwrap_or_else(|| stl_step(cells)),
    }
}

/// Writes the file, whole or not at all.
fn write<T>(
    options: &ExportOptions,
    bar: &ProgressBar,
    fill: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<T, ExchangeError>,
) -> Result<T, Fault> {
    let (mut made, mut failed) = (None, None);
    let written = files::write_whole(&options.output, |file| {
        match fill(file) {
            Ok(done) => made = Some(done),
            Err(ExchangeError::Write(error)) => return Err(error),
            Err(other) => {
                failed = Some(other);
                return Err(std::io::Error::other("not written"));
            }
        }
        Ok(())
    });
    bar.finish_and_clear();
    if let Some(error) = failed {
        return Err(match error {
            ExchangeError::Damaged(what) => wrong(
                &options.file,
                &maulstick_document::DocumentError::Damaged(what),
            ),
            other => Fault::told(other.to_string()).at(options.output.display().to_string()),
        });
    }
    written.map_err(|error| Fault::writing(&options.output, &error))?;
    made.ok_or_else(|| Fault::failure("nothing was written"))
}
