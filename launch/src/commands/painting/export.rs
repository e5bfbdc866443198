//! `maulstick painting export`: a painting for other programs, of a file or of a running rig.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;
use maulstick_appearance::picture::Depth;
use maulstick_exchange::{ExchangeError, Format, Order};
use maulstick_paint_node::exporter::kind_of;
use maulstick_rig::config::ViewSection;
use maulstick_rig::{UserError, files};
use maulstick_types::command::png_bits;
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::ValueError;

use super::export_live;
use crate::commands::client::Target;
use crate::commands::say;
use crate::destination::export;
use crate::document::{read, wrong};
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::refused;

/// The formats by name, for the command line.
fn formats() -> PossibleValuesParser {
    PossibleValuesParser::new(Format::ALL.map(|(name, _)| name))
}

/// Options of `maulstick painting export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// Painting [default: that of the running rig, as it is now]
    file: Option<PathBuf>,
    /// File to write: .png, .exr, .ora, .stl or .glb
    #[arg(short, long, value_name = "OUT", required_unless_present = "stop")]
    pub(super) output: Option<PathBuf>,
    /// Stop the running export of the rig; its file is not written
    #[arg(long, conflicts_with_all = ["file", "output"])]
    stop: bool,
    /// Format, if the file name does not tell; `height` is a PNG too
    #[arg(long, value_parser = formats())]
    pub(super) format: Option<String>,
    /// Use the palette instead of the canvas
    #[arg(long)]
    pub(super) palette: bool,
    /// Bits per channel of a PNG: 8, 16
    #[arg(long, default_value = "8", value_parser = bits)]
    pub(super) bits: u32,
    /// Colour profile of a PNG: srgb, display-p3, of a file also an ICC file [default: that of the rig, of a file srgb]
    #[arg(long, value_name = "PROFILE")]
    pub(super) profile: Option<String>,
    /// Gamut mapping of a PNG: soft, clamp [default: that of the rig, of a file soft]
    #[arg(long, value_name = "MAPPING")]
    pub(super) gamut: Option<String>,
    /// Thickness of a solid (STL, glTF) below its lowest point, mm
    #[arg(long, default_value_t = 2.0, allow_negative_numbers = true)]
    pub(super) base_mm: f64,
    /// Factor on the heights of a solid
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub(super) exaggeration: f64,
    /// Vertex spacing of a solid, cells [default: at most 4 million triangles where no paint overhangs]
    #[arg(long, value_name = "CELLS", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) step: Option<u32>,
    #[command(flatten)]
    pub(super) target: Target,
}

fn bits(text: &str) -> Result<u32, ValueError> {
    png_bits(text.parse().unwrap_or(0))
}

impl ExportOptions {
    fn format(&self, out: &Path) -> Result<Format, UserError> {
        let format = match &self.format {
            Some(name) => Format::named(name),
            None => Format::of(out),
        };
        format.ok_or_else(|| {
            UserError::usage("the name does not say which format to write")
                .at(out.display().to_string())
                .help("end it in .png, .exr, .ora, .stl or .glb, or give --format")
        })
    }

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
/// A [`UserError`] where the painting cannot be read or the file not be written, where another export of the rig goes
/// on, or where no rig runs.
pub(super) fn run(options: &ExportOptions) -> Result<i32, UserError> {
    match (&options.file, &options.output) {
        (Some(file), Some(out)) => of_file(options, file, out),
        _ => export_live::run(options),
    }
}

fn of_file(options: &ExportOptions, file: &Path, out: &Path) -> Result<i32, UserError> {
    let (format, depth) = (options.format(out)?, options.depth());
    let view = ViewSection {
        profile: options.profile.clone().unwrap_or_else(|| "srgb".to_owned()),
        gamut: options.gamut.clone().unwrap_or_else(|| "soft".to_owned()),
    };
    let look = export(&view, "--profile, --gamut")?;
    let inputs: Vec<_> = std::iter::once(UsedFile::painting(file))
        .chain(UsedFile::given("the profile", view.file()))
        .collect();
    check_outputs(
        &[UsedFile::new("the export", out).of(kind_of(format))],
        &inputs,
    )?;
    let (_document, opened) = read(file)?;
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
    let said = write([file, out], format, &bar, |file| {
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
    [painting, out]: [&Path; 2],
    format: Format,
    bar: &ProgressBar,
    fill: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<T, ExchangeError>,
) -> Result<T, UserError> {
    let (mut made, mut failed) = (None, None);
    let written = files::write_whole(out, kind_of(format), |file| {
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
            ExchangeError::Damaged(what) => {
                wrong(painting, &maulstick_document::DocumentError::Damaged(what))
            }
            other => UserError::usage(other.to_string()).at(out.display().to_string()),
        });
    }
    written.map_err(|error| UserError::writing(out, &error))?;
    made.ok_or_else(|| UserError::failure("nothing was written"))
}
