//! OpenEXR files, read by the `exr` crate.

use std::collections::BTreeMap;
use std::io::Cursor;

use exr::compression::Compression;
use exr::image::{AnyChannels, FlatSamples, Layer};
use exr::prelude::{ReadChannels as _, ReadLayers as _, read};
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_exchange::Image;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::{Gamut, GamutMapping};
use maulstick_optics::icc::Profile;
use maulstick_optics::light::SURFACE;
use maulstick_painting::Painting;
use maulstick_painting::picture::unlit_picture;
use maulstick_types::paint::TILE;
use maulstick_types::scene::CANVAS;

use crate::support::{CELLS, decoded, file, heights, painted, speck};

fn layer(file: Vec<u8>) -> Layer<AnyChannels<FlatSamples>> {
    let image = read().no_deep_data().largest_resolution_level();
    let image = image.all_channels().first_valid_layer().all_attributes();
    let image = image
        .from_buffered(Cursor::new(file))
        .expect("an OpenEXR file");
    let colours = image.attributes.chromaticities.expect("they are told");
    assert_eq!((colours.red.x(), colours.white.y()), (0.64, 0.329));
    image.layer_data
}

fn channels(layer: &Layer<AnyChannels<FlatSamples>>) -> BTreeMap<String, Vec<f32>> {
    let list = layer.channel_data.list.iter().map(|channel| {
        let samples = match &channel.sample_data {
            FlatSamples::F32(samples) => Some(samples.clone()),
            _ => None,
        };
        (channel.name.to_string(), samples.expect("f32"))
    });
    list.collect()
}

/// Counts of each paint in each cell from the top row, wet and dry.
fn counts(painting: &mut Painting) -> BTreeMap<String, Vec<u64>> {
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let [width, height] = store.cells().map(|cells| cells as usize);
    let mut counts = BTreeMap::new();
    for slot in &painting.scene().paints {
        for state in ["wet", "dry"] {
            let name = format!("{state}.{}", slot.name.replace(' ', "_"));
            counts.insert(name, vec![0; width * height]);
        }
    }
    for (id, version) in store.iter() {
        let Some(tile) = &version.tile else {
            continue;
        };
        let mut add = |state: &str, slot: usize, plane: &[f32]| {
            let name = painting.scene().paints[slot].name.replace(' ', "_");
            let sums = counts.get_mut(&format!("{state}.{name}")).expect("a slot");
            for (cell, count) in plane.iter().enumerate() {
                let x = id.x as usize * TILE + cell % TILE;
                let y = id.y as usize * TILE + cell / TILE;
                if x < width && y < height {
                    sums[(height - 1 - y) * width + x] += *count as u64;
                }
            }
        };
        for (slot, plane) in &*tile.wet() {
            add("wet", *slot, plane);
        }
        for layer in tile.dry().into_iter().flat_map(|stack| stack.layers()) {
            for (slot, plane) in &*layer.planes.get() {
                add("dry", *slot, plane);
            }
        }
    }
    counts
}

#[test]
fn every_quantum_comes_back() {
    for mut painting in [painted(), speck()] {
        let expected = counts(&mut painting);
        let all: u64 = expected.values().flatten().sum();
        let read = channels(&layer(file("OpenEXR", &mut painting)));
        assert_eq!(read.len(), 5 + expected.len());
        let count = |thickness: &f32| (f64::from(*thickness) / QUANTUM_M).round() as u64;
        let same = |expected: &BTreeMap<String, Vec<u64>>| {
            expected.iter().all(|(name, counts)| {
                let samples = read.get(name).expect(name);
                samples.iter().map(count).eq(counts.iter().copied())
            })
        };
        assert!(all > 10_000 && same(&expected));
        let mut fault = expected;
        let first = fault.values_mut().flatten().find(|count| **count > 0);
        *first.expect("paint") += 1;
        assert!(!same(&fault), "a quantum too many would pass");
    }
}

#[test]
fn colour_and_height_are_the_paintings() {
    let mut painting = painted();
    let layer = layer(file("OpenEXR", &mut painting));
    assert_eq!(
        (layer.size.x(), layer.size.y()),
        (CELLS[0] as usize, CELLS[1] as usize)
    );
    assert_eq!(layer.encoding.compression, Compression::ZIP16);
    let attributes = &layer.attributes;
    assert_eq!(attributes.horizontal_density, Some(101.6));
    assert!(attributes.capture_date.is_none() && attributes.comments.is_some());
    let read = channels(&layer);
    assert_eq!(read["height"], heights(&mut painting));
    let (_, map) = decoded(&file("gloss map", &mut painting));
    let map = map
        .chunks_exact(2)
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
    let levels = read["gloss"]
        .iter()
        .map(|gloss| (gloss * 65_535.0 + 0.5) as u16);
    assert!(levels.eq(map));
    let profile = Profile::of(RgbSpace::Srgb);
    let gamut = Gamut::new(GamutMapping::Soft, profile.from_working());
    let flat = |[r, g, b]: [&str; 3]| {
        let cells = read[r].iter().zip(&read[g]).zip(&read[b]);
        let colour = |((r, g), b): ((&f32, &f32), &f32)| {
            gamut.map([*r, *g, *b].map(|linear| linear + SURFACE))
        };
        let colours: Vec<[f32; 3]> = cells.map(colour).collect();
        let mut bytes = vec![0; 3 * colours.len()];
        profile.encode(&colours, &mut bytes);
        bytes
    };
    let expected = unlit_picture(&mut painting, CANVAS).rgb;
    assert!(flat(["R", "G", "B"]) == expected);
    assert!(flat(["R", "B", "G"]) != expected, "a fault would pass");
}

#[test]
fn the_picture_is_read_back_as_it_was_written() {
    let mut painting = painted();
    let bytes = file("OpenEXR", &mut painting);
    let image = Image::read(&bytes).expect("a picture");
    assert_eq!(image.unused_mark(), None);
    let [width, height] = CELLS.map(|cells| cells as usize);
    assert_eq!(image.size(), [width, height]);
    let written = channels(&layer(bytes));
    let mut row = Vec::new();
    let mut off = [0.0f32; 2];
    for y in 0..height {
        image.colours(y, &mut row);
        for (x, colour) in row.iter().enumerate() {
            let cell = y * width + x;
            let of = |names: [&str; 3]| names.map(|name| written[name][cell].clamp(0.0, 1.0));
            for (off, names) in off.iter_mut().zip([["R", "G", "B"], ["B", "G", "R"]]) {
                let pairs = colour.iter().zip(of(names));
                *off = pairs.fold(*off, |off, (a, b)| off.max((a - b).abs()));
            }
        }
    }
    assert_eq!(off[0], 0.0);
    assert!(off[1] > 0.1, "a fault would pass");
}
