//! OpenEXR: the first layer that has the channels R, G and B, or Y for grey; in linear light, multiplied by
//! its opacity A.

use std::io::{BufRead, ErrorKind, Seek};

use exr::error::Error;
use exr::meta::attribute::Text;
use exr::meta::header::Header;
use exr::prelude::{
    ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _, Vec2, read as layers,
};
use image::metadata::Orientation;
use maulstick_optics::colour::{Chromaticities, Transfer};

use super::colours::{Colours, Range, UnusedMark};
use super::pixels::{Alpha, Numbers, Picture, check_size};
use crate::import_error::ImportError;

/// Bytes of a number.
const NUMBER: usize = size_of::<f32>();

/// Visible part of a layer.
#[derive(Clone, Copy)]
struct Frame {
    /// Pixels across and down.
    size: [usize; 2],
    /// Place of the layer's first pixel in the picture.
    first: [i64; 2],
    /// Numbers of a pixel.
    channels: usize,
}

impl Frame {
    /// The frame of a layer. Another part of the layer than this, and beyond, may be in the file.
    fn of(layer: &Header) -> Self {
        let window = layer.shared_attributes.display_window;
        let first = |i: usize| {
            let [at, from] = [layer.own_attributes.layer_position, window.position]
                .map(|place| [place.0, place.1][i]);
            i64::from(at) - i64::from(from)
        };
        Self {
            size: [window.size.0, window.size.1],
            first: [first(0), first(1)],
            channels: if has(layer, "A") { 4 } else { 3 },
        }
    }

    /// All of it, clear or black.
    fn blank(&self) -> Vec<f32> {
        vec![0.0; self.size[0] * self.size[1] * self.channels]
    }

    /// Writes a pixel of the layer, if it is in the picture.
    fn put(&self, into: &mut [f32], at: Vec2<usize>, pixel: &[f32]) {
        let place = |at: usize, i: usize| {
            let place = usize::try_from(self.first[i] + at as i64).ok()?;
            (place < self.size[i]).then_some(place)
        };
        let (Some(x), Some(y)) = (place(at.0, 0), place(at.1, 1)) else {
            return;
        };
        let to = (y * self.size[0] + x) * self.channels;
        into[to..to + self.channels].copy_from_slice(&pixel[..self.channels]);
    }
}

fn has(layer: &Header, name: &str) -> bool {
    let found = layer.channels.find_index_of_channel(&Text::from(name));
    found.is_some()
}

pub(super) fn read(source: impl BufRead + Seek, most_bytes: u64) -> Result<Picture, ImportError> {
    let file = exr::block::read(source, false).map_err(wrong)?;
    let (layer, is_grey) = coloured(file.headers())?;
    let frame = Frame::of(layer);
    let whole = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let size = frame.size.map(whole);
    check_size(size, frame.channels * NUMBER, most_bytes)?;
    let stored = [layer.layer_size.0, layer.layer_size.1].map(whole);
    check_size(stored, frame.channels * NUMBER, most_bytes)?;
    let (colours, unused) = marked(layer);
    let values = if is_grey {
        let channels = layers().no_deep_data().largest_resolution_level();
        let image = channels
            .specific_channels()
            .required("Y")
            .optional("A", 1.0f32)
            .collect_pixels(
                move |_, _| frame.blank(),
                move |into: &mut Vec<f32>, at, (grey, a): (f32, f32)| {
                    frame.put(into, at, &[grey, grey, grey, a]);
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(file)
            .map_err(wrong)?;
        image.layer_data.channel_data.pixels
    } else {
        let channels = layers().no_deep_data().largest_resolution_level();
        let image = channels
            .rgba_channels(
                move |_, _| frame.blank(),
                move |into: &mut Vec<f32>, at, (r, g, b, a): (f32, f32, f32, f32)| {
                    frame.put(into, at, &[r, g, b, a]);
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_chunks(file)
            .map_err(wrong)?;
        image.layer_data.channel_data.pixels
    };
    Ok(Picture {
        pixels: Numbers::Floats(values).into_image(size, frame.channels)?,
        alpha: Alpha::Associated,
        colours,
        unused,
        turned: Orientation::NoTransforms,
    })
}

/// The first layer with colours, and whether they are grey.
fn coloured(layers: &[Header]) -> Result<(&Header, bool), ImportError> {
    let first = |names: &[&str]| {
        let mut all = layers.iter().filter(|layer| !layer.deep);
        all.find(|layer| names.iter().all(|name| has(layer, name)))
    };
    match (first(&["R", "G", "B"]), first(&["Y"])) {
        (Some(layer), _) => Ok((layer, false)),
        // Chroma, at half the size, would be missing.
        (None, Some(layer)) if !has(layer, "RY") => Ok((layer, true)),
        _ => {
            let what = "it has no channels R, G and B, nor grey ones of Y alone".to_owned();
            Err(ImportError::Unsupported(what))
        }
    }
}

/// Colours by the attribute *chromaticities*; without it those of sRGB.
fn marked(layer: &Header) -> (Colours, Option<UnusedMark>) {
    let own = layer.shared_attributes.chromaticities;
    let chromaticities = own.map_or(Chromaticities::SRGB, |own| {
        let place = |place: Vec2<f32>| [place.0, place.1].map(f64::from);
        Chromaticities {
            primaries: [own.red, own.green, own.blue].map(place),
            white: place(own.white),
        }
    });
    match Colours::encoded(Transfer::Linear, &chromaticities, Range::FULL) {
        Some(colours) => (colours, None),
        None => {
            let unused = UnusedMark {
                mark: "chromaticities",
                reason: "they span no gamut".to_owned(),
            };
            (Colours::srgb(), Some(unused))
        }
    }
}

fn wrong(error: Error) -> ImportError {
    match error {
        Error::Io(error) if error.kind() != ErrorKind::UnexpectedEof => ImportError::File(error),
        Error::NotSupported(what) => ImportError::Unsupported(what.into_owned()),
        other => ImportError::NotAPicture(other.to_string()),
    }
}
