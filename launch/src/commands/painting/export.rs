//! `maulstick painting export`: a painting for other programs.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;
use maulstick_appearance::picture::Depth;
use maulstick_exchange::{ExchangeError, Format, Order};
use maulstick_paint_node::exporter::kind_of;
use maulstick_rig::config::ViewSection;
use maulstick_rig::{UserError, files};
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::commands::say;
use crate::destination::export;
use crate::document::{read, wrong};
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::refused;

/// The formats by name, for the command line.
pub(in crate::commands) fn formats() -> PossibleValuesParser {
    PossibleValuesParser::new(Format::ALL.map(|(name, _)| name))
}

/// Options of `maulstick painting export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// Painting
    file: PathBuf,
    /// File to write: .png, .exr, .ora, .stl or .glb
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Format, if the file name does not tell; `height` is a PNG too
    #[arg(long, value_parser = formats())]
    format: Option<String>,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    /// Bits per channel of a PNG: 8, 16
    #[arg(long, default_value_t = 8)]
    bits: u32,
    /// Colour profile of a PNG: srgb, display-p3, or an ICC file
    #[arg(long, value_name = "PROFILE", default_value = "srgb")]
    profile: String,
    /// Gamut mapping of a PNG: soft, clamp
    #[arg(long, value_name = "MAPPING", default_value = "soft")]
    gamut: String,
    /// Thickness of a solid (STL, glTF) below its lowest point, mm
    #[arg(long, default_value_t = 2.0, allow_negative_numbers = true)]
    base_mm: f64,
    /// Factor on the heights of a solid
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    exaggeration: f64,
    /// Vertex spacing of a solid, cells [default: at most 4 million triangles where no paint overhangs]
    #[arg(long, value_name = "CELLS", value_parser = clap::value_parser!(u32).range(1..))]
    step: Option<u32>,
}

impl ExportOptions {
    fn format(&self) -> Result<Format, UserError> {
        let format = match &self.format {
            Some(name) => Format::named(name),
            None => Format::of(&self.output),
        };
        format.ok_or_else(|| {
            UserError::usage("the name does not say which format to write")
                .at(self.output.display().to_string())
                .help("end it in .png, .exr, .ora, .stl or .glb, or give --format")
        })
    }

    fn depth(&self) -> Result<Depth, UserError> {
        match self.bits {
            8 => Ok(Depth::Eight),
            16 => Ok(Depth::Sixteen),
            other => Err(UserError::usage(format!("a PNG of {other} bits a channel"))
                .at("--bits")
                .help("choose 8 or 16")),
        }
    }
}

/// Writes a painting for other programs.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read or the file not be written.
pub(super) fn run(options: &ExportOptions) -> Result<i32, UserError> {
    let (format, depth) = (options.format()?, options.depth()?);
    let view = ViewSection {
        profile: options.profile.clone(),
        gamut: options.gamut.clone(),
    };
    let look = export(&view, "--profile, --gamut")?;
    let out = &options.output;
    let inputs: Vec<_> = std::iter::once(UsedFile::painting(&options.file))
        .chain(UsedFile::given("the profile", view.file()))
        .collect();
    check_outputs(
        &[UsedFile::new("the export", out).of(kind_of(format))],
        &inputs,
    )?;
    let (_document, opened) = read(&options.file)?;
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let painting = sequencer.painting_mut();
    let surface = if options.palette { PALETTE } else { CANVAS };
    let bar = super::bar("exporting");
    let mut tell = super::tell(&bar);
    let order = Order {
        format,
        surface,
        depth,
        export: look,
        base_mm: options.base_mm,
        exaggeration: options.exaggeration,
        step: options.step,
    };
    let said = write(options, format, &bar, |file| {
        order.write(painting, file, &mut tell)
    })?;
    if !said.is_empty() {
        say!("{said}");
    }
    say!("{}", out.display());
    Ok(0)
}

/// Writes the file, whole or not at all.
fn write<T>(
    options: &ExportOptions,
    format: Format,
    bar: &ProgressBar,
    fill: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<T, ExchangeError>,
) -> Result<T, UserError> {
    let (mut made, mut failed) = (None, None);
    let written = files::write_whole(&options.output, kind_of(format), |file| {
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
            other => UserError::usage(other.to_string()).at(options.output.display().to_string()),
        });
    }
    written.map_err(|error| UserError::writing(&options.output, &error))?;
    made.ok_or_else(|| UserError::failure("nothing was written"))
}
