//! `maulstick export`: the painting of a running rig for other programs, while it is painted on.

use std::path::PathBuf;

use clap::Args;
use maulstick_exchange::Format;
use maulstick_paint_node::exporter::kind_of;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::command::{ExportOrder, FileCommand, png_bits};
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::ValueError;

use super::open::LONGEST;
use super::painting::formats;
use crate::commands::client::{Client, Target};
use crate::commands::say;
use crate::outputs::{Relayed, UsedFile, check_outputs, named_by};

/// Options of `maulstick export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// File to write: .png, .exr, .ora, .stl or .glb
    #[arg(required_unless_present = "stop")]
    file: Option<PathBuf>,
    /// Stop the running export; its file is not written
    #[arg(long, conflicts_with = "file")]
    stop: bool,
    /// Format, if the file name does not tell; `height` is a PNG too
    #[arg(long, value_parser = formats())]
    format: Option<String>,
    /// Use the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    /// Bits per channel of a PNG: 8, 16
    #[arg(long, default_value = "8", value_parser = bits)]
    bits: u32,
    /// Colour profile of a PNG: srgb, display-p3 [default: that of the rig]
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
    /// Gamut mapping of a PNG: soft, clamp [default: that of the rig]
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

/// Has the painting written as it is now.
///
/// # Errors
/// A [`UserError`] where it cannot be written, where another export goes on, or where no rig runs.
pub fn run(options: &ExportOptions) -> Result<i32, UserError> {
    let client = Client::open(&options.target)?;
    let Some(file) = &options.file else {
        client.send(FileCommand::StopExport)?;
        return Ok(0);
    };
    let config = client.config()?;
    let document = config.paint.document.iter();
    let inputs: Vec<_> = named_by(&config)
        .into_iter()
        .chain(document.map(|path| UsedFile::painting(path)))
        .collect();
    // A name without a known format is refused by the node.
    let format = match &options.format {
        Some(name) => Format::named(name),
        None => Format::of(file),
    };
    let kind = format.map_or(Kind::Own, kind_of);
    check_outputs(&[UsedFile::new("the export", file).of(kind)], &inputs)?;
    let file = Relayed::new(file, kind)?;
    let command = FileCommand::Export(ExportOrder {
        format: options.format.clone().unwrap_or_default(),
        surface: if options.palette { PALETTE } else { CANVAS },
        bits: options.bits,
        base_m: options.base_mm * 1e-3,
        exaggeration: options.exaggeration,
        step: options.step.unwrap_or(0),
        profile: options.profile.clone().unwrap_or_default(),
        gamut: options.gamut.clone().unwrap_or_default(),
        ..ExportOrder::to(file.asked()?)
    });
    let done = client.send_within(command, LONGEST)?;
    say!("{}", file.arrive(&done)?);
    Ok(0)
}
