//! `maulstick painting export`: a painting for other programs, of a file or of a running rig.

mod in_file;
mod in_rig;

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use maulstick_appearance::picture::Depth;
use maulstick_exchange::Format;
use maulstick_rig::UserError;
use maulstick_types::command::png_bits;
use maulstick_types::values::ValueError;

use crate::commands::client::Target;

/// The formats by name, for the command line.
fn formats() -> PossibleValuesParser {
    PossibleValuesParser::new(Format::ALL.map(|(name, _)| name))
}

/// Options of `maulstick painting export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// Painting [default: that of the running rig, as it is now]
    #[arg(conflicts_with = "name")]
    file: Option<PathBuf>,
    /// File to write: .png, .exr, .ora, .stl or .glb
    #[arg(short, long, value_name = "OUT", required_unless_present = "stop")]
    output: Option<PathBuf>,
    /// Stop the running export of the rig; its file is not written
    #[arg(long, conflicts_with_all = ["file", "output"])]
    stop: bool,
    /// Format, if the file name does not tell; `height` and `gloss` are PNGs too
    #[arg(long, value_parser = formats())]
    format: Option<String>,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    /// Bits per channel of a PNG: 8, 16
    #[arg(long, default_value = "8", value_parser = bits)]
    bits: u32,
    /// Colour profile of a PNG: srgb, display-p3, of a file also an ICC file [default: that of the rig, of a file srgb]
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
    /// Gamut mapping of a PNG: soft, clamp [default: that of the rig, of a file soft]
    #[arg(long, value_name = "MAPPING")]
    gamut: Option<String>,
    /// Thickness of a solid (STL, glTF) below its lowest point, mm
    #[arg(long, default_value_t = 2.0, allow_negative_numbers = true)]
    base_mm: f64,
    /// Factor on the heights of a solid
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    exaggeration: f64,
    /// Vertex spacing of a solid, cells [default: at most 4 million triangles where no paint overhangs]
    #[arg(long, value_name = "CELLS", value_parser = clap::value_parser!(u32).range(1..))]
    step: Option<u32>,
    #[command(flatten)]
    target: Target,
}

fn bits(text: &str) -> Result<u32, ValueError> {
    png_bits(text.parse().unwrap_or(0))
}

impl ExportOptions {
    /// Format of the file to write.
    ///
    /// # Errors
    /// A [`UserError`] where neither the name nor an option says it.
    fn format(&self, out: &Path) -> Result<Format, UserError> {
        self.known_format(out).ok_or_else(|| {
            UserError::usage("the name does not say which format to write")
                .at(out.display().to_string())
                .help("end it in .png, .exr, .ora, .stl or .glb, or give --format")
        })
    }

    /// The requested format; `None` if neither option nor name gives one.
    fn known_format(&self, out: &Path) -> Option<Format> {
        match &self.format {
            Some(name) => Format::named(name),
            None => Format::of(out),
        }
    }

    /// Bits per channel of a PNG.
    fn depth(&self) -> Depth {
        if self.bits == 16 {
            Depth::Sixteen
        } else {
            Depth::Eight
        }
    }
}

/// Writes a painting for other programs.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read or the file not be written, where another export of the
/// rig is running, or where no rig runs.
pub(super) fn run(options: &ExportOptions) -> Result<i32, UserError> {
    match (&options.file, &options.output) {
        (Some(file), Some(out)) => in_file::run(options, [file, out]),
        _ => in_rig::run(options),
    }
}
