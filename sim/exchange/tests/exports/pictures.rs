//! PNG files: lit, and of heights.

use std::io::Cursor;

use maulstick_exchange::{HeightRange, write_gloss_map, write_height_map};
use maulstick_models::model_names;
use maulstick_painting::Painting;
use maulstick_painting::picture::picture;
use maulstick_types::scene::CANVAS;

use crate::support::{CELLS, EXPORTS, bare, decoded, file, heights, painted, painted_of, speck};

#[test]
fn eight_bits_are_the_snapshots_bytes() {
    for mut painting in [painted(), speck()] {
        let mut snapshot = Vec::new();
        let whole = picture(&mut painting, CANVAS);
        whole.encode_png(&mut snapshot).expect("written");
        assert!(file("PNG, 8 bits", &mut painting) == snapshot);
    }
}

#[test]
fn every_paint_model_is_exported_and_no_two_alike() {
    let mut files = Vec::new();
    for model in model_names() {
        let mut painting = painted_of(model);
        for (name, _) in EXPORTS {
            let written = file(name, &mut painting);
            assert!(!files.contains(&written), "{name}: {model}");
            files.push(written);
        }
    }
}

fn sixteen(bytes: &[u8]) -> Vec<u16> {
    let pairs = bytes.chunks_exact(2);
    pairs
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect()
}

#[test]
fn sixteen_bits_are_eight_within_rounding() {
    let mut painting = painted();
    let (one, eight) = decoded(&file("PNG, 8 bits", &mut painting));
    let (other, fine) = decoded(&file("PNG, 16 bits", &mut painting));
    let fine = sixteen(&fine);
    assert_eq!(one.size(), (CELLS[0], CELLS[1]));
    assert_eq!(
        (one.size(), one.icc_profile),
        (other.size(), other.icc_profile)
    );
    let size = other
        .pixel_dims
        .map(|size| (size.xppu, size.yppu, size.unit));
    assert_eq!(size, Some((4000, 4000, png::Unit::Meter)));
    let off = |factor: f64| {
        let pair = |(byte, value): (&u8, &u16)| {
            (f64::from(*byte) - f64::from(*value) / 257.0 * factor).abs()
        };
        eight.iter().zip(&fine).map(pair).fold(0.0, f64::max)
    };
    println!("{:.3} of a step", off(1.0));
    assert!(off(1.0) < 0.56);
    assert!(off(0.998) > 0.56, "a fault would pass");
    let between = fine.iter().filter(|value| *value % 257 != 0).count();
    assert!(between * 10 > fine.len() * 9, "they are finer than bytes");
}

fn height_map(painting: &mut Painting) -> (HeightRange, png::Info<'static>, Vec<u16>) {
    let mut to = Cursor::new(Vec::new());
    let range = write_height_map(painting, CANVAS, &mut to, &mut |_, _| {}).expect("written");
    let (info, bytes) = decoded(to.get_ref());
    (range, info, sixteen(&bytes))
}

/// Bare ground is matt, wet paint is glossy, and the text gives the roughness.
#[test]
fn a_gloss_map_holds_gloss() {
    let mut painting = painted();
    let mut to = Cursor::new(Vec::new());
    write_gloss_map(&mut painting, CANVAS, &mut to, &mut |_, _| {}).expect("written");
    let (info, bytes) = decoded(to.get_ref());
    let values = sixteen(&bytes);
    let size = picture(&mut painting, CANVAS);
    assert_eq!(values.len(), size.width * size.height);
    let bare = values.iter().filter(|value| **value == 0).count();
    let wet = values.iter().filter(|value| **value >= 49_150).count();
    assert!(bare > 0 && wet > 0, "{bare} {wet}");
    let text = &info.uncompressed_latin1_text[0];
    assert_eq!(text.keyword, "Gloss");
    assert!(text.text.ends_with("0.1 + 0.6 (1 - gloss)^2"), "{text:?}");
}

#[test]
fn a_height_map_holds_heights() {
    let mut painting = painted();
    let expected = heights(&mut painting);
    let (range, info, values) = height_map(&mut painting);
    let ends = |fold: fn(f32, f32) -> f32| expected.iter().copied().reduce(fold);
    assert_eq!(ends(f32::min), Some(range.least_m));
    assert_eq!(ends(f32::max), Some(range.greatest_m));
    assert_eq!(
        (values.iter().min(), values.iter().max()),
        (Some(&0), Some(&u16::MAX))
    );
    let span = f64::from(range.greatest_m - range.least_m);
    let off = |shift: usize| {
        let pair = |(height, value): (&f32, &u16)| {
            let back = f64::from(range.least_m) + f64::from(*value) / 65_535.0 * span;
            (f64::from(*height) - back).abs() / span
        };
        let values = values.iter().cycle().skip(shift);
        expected.iter().zip(values).map(pair).fold(0.0, f64::max)
    };
    assert!(off(0) < 0.51 / 65_535.0, "{}", off(0));
    assert!(off(1) > 0.51 / 65_535.0, "a fault would pass");
    assert_eq!(info.pixel_dims.map(|size| size.xppu), Some(4000));
    let text = &info.uncompressed_latin1_text[0];
    let least = format!("0 is {:.4} micrometres", f64::from(range.least_m) * 1e6);
    assert!(
        text.keyword == "Height" && text.text.starts_with(&least),
        "{text:?}"
    );
}

#[test]
fn a_level_place_is_black() {
    let (range, info, values) = height_map(&mut bare([1, 1]));
    assert_eq!((info.size(), values), ((1, 1), vec![0]));
    assert!(
        range.least_m < 0.0 && range.least_m == range.greatest_m,
        "the tooth"
    );
}
