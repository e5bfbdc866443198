//! OpenRaster files, composited here.

use std::io::{Cursor, Read as _};

use maulstick_exchange::Image;
use maulstick_exchange::fit_to::colours;
use maulstick_painting::Painting;
use maulstick_painting::edits::{Dry, LayerRef, Opacity};
use maulstick_painting::picture::unlit_picture;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{OpacityFactor, Share};
use zip::{CompressionMethod, ZipArchive};

use crate::support::{CELLS, bare, decoded, file, painted, speck, stroke};

/// A file as a program for layers sees it.
struct Opened {
    /// Name and pixels of each layer, from the lowest.
    layers: Vec<(String, Vec<u8>)>,
    merged: Vec<u8>,
    thumbnail: (png::Info<'static>, Vec<u8>),
    stack: String,
}

fn opened(painting: &mut Painting) -> Opened {
    let bytes = file("OpenRaster", painting);
    // Programs know the type of a file by its first bytes.
    assert_eq!(&bytes[30..54], b"mimetypeimage/openraster");
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("a zip");
    let mut content = |name: &str| {
        let mut entry = archive.by_name(name).expect(name);
        assert_eq!(entry.compression(), CompressionMethod::Stored);
        let date = entry
            .last_modified()
            .map(|date| (date.year(), date.month()));
        assert_eq!(date, Some((1980, 1)), "{name}");
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).expect("whole");
        bytes
    };
    let stack = String::from_utf8(content("stack.xml")).expect("UTF-8");
    let value = |line: &str, key: &str| {
        let rest = line.split_once(&format!(" {key}=\"")).expect(key).1;
        rest.split_once('"').expect("a quote").0.to_owned()
    };
    let lines = stack
        .lines()
        .filter(|line| line.trim_start().starts_with("<layer "));
    let layers = lines.rev().map(|line| {
        assert_eq!(value(line, "composite-op"), "svg:src-over");
        assert_eq!(
            [value(line, "x"), value(line, "y"), value(line, "opacity")],
            ["0", "0", "1.0"]
        );
        let (info, pixels) = decoded(&content(&value(line, "src")));
        assert_eq!(
            (info.color_type, info.bit_depth),
            (png::ColorType::Rgba, png::BitDepth::Eight)
        );
        (value(line, "name"), pixels)
    });
    Opened {
        layers: layers.collect(),
        merged: decoded(&content("mergedimage.png")).1,
        thumbnail: decoded(&content("Thumbnails/thumbnail.png")),
        stack: stack.clone(),
    }
}

/// Composited layers, as in other programs.
fn over<'a>(layers: impl Iterator<Item = &'a (String, Vec<u8>)>) -> Vec<u8> {
    let mut below: Vec<u8> = Vec::new();
    for (_, layer) in layers {
        below.resize(layer.len() / 4 * 3, 0);
        for (to, from) in below.chunks_exact_mut(3).zip(layer.chunks_exact(4)) {
            let opacity = u32::from(from[3]);
            for (to, from) in to.iter_mut().zip(from) {
                let mixed = u32::from(*from) * opacity + u32::from(*to) * (255 - opacity);
                *to = (mixed / 255) as u8;
            }
        }
    }
    below
}

#[test]
fn layers_over_each_other_are_the_flat_picture() {
    for mut painting in [painted(), speck()] {
        let flat = unlit_picture(&mut painting, CANVAS).rgb;
        let opened = opened(&mut painting);
        assert!(over(opened.layers.iter()) == flat && opened.merged == flat);
        assert!(
            over(opened.layers.iter().rev()) != flat,
            "a fault would pass"
        );
        let small = &opened.thumbnail;
        assert!(small.1 == flat, "nothing is made larger");
    }
    let opened = opened(&mut painted());
    let names: Vec<&str> = opened
        .layers
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let sky = "sky &lt;&quot;first&quot;&gt; &amp; sea";
    assert_eq!(names, ["ground", sky, "glaze", "wet paint"]);
    let size = format!("w=\"{}\" h=\"{}\" xres=\"102\"", CELLS[0], CELLS[1]);
    assert!(opened.stack.contains(&size), "{}", opened.stack);
    for (name, pixels) in &opened.layers {
        let clear = pixels.chunks_exact(4).filter(|pixel| pixel[3] == 0).count();
        let part = clear > 0 && clear < pixels.len() / 4;
        assert_eq!(part, name != "ground", "{name}");
    }
}

#[test]
fn lower_layers_are_the_painting_before_the_others_were_laid() {
    let mut painting = bare(CELLS);
    let mut seen = vec![unlit_picture(&mut painting, CANVAS).rgb];
    for (number, load, place) in [
        (1, "Ultramarine Blue", [3.0, 7.0]),
        (2, "Hansa Yellow Opaque=0.1,Thinner=0.9", [9.0, 8.0]),
        (3, "Titanium White", [15.0, 6.0]),
    ] {
        stroke(&mut painting, number, load, place);
        painting
            .apply(Dry {
                share: Share::new(1.0).expect("in range"),
                ..Dry::whole(CANVAS)
            })
            .expect("wet");
        seen.push(unlit_picture(&mut painting, CANVAS).rgb);
    }
    // A layer of reduced opacity leaves the layers under it unchanged.
    painting
        .apply(Opacity {
            layer: LayerRef::Number { number: 3 },
            opacity: OpacityFactor::new(0.5).expect("in range"),
        })
        .expect("a layer");
    seen[3] = unlit_picture(&mut painting, CANVAS).rgb;
    let opened = opened(&mut painting);
    assert_eq!(opened.layers.len(), 4, "nothing is wet");
    for (upper, before) in seen.iter().enumerate() {
        assert!(over(opened.layers[..=upper].iter()) == *before, "{upper}");
        let next = seen.get(upper + 1);
        assert!(next.is_none_or(|next| next != before), "a fault would pass");
    }
}

#[test]
fn the_whole_picture_is_read_back_as_it_was_written() {
    let mut painting = painted();
    let flat = unlit_picture(&mut painting, CANVAS).rgb;
    let bare = unlit_picture(&mut bare(CELLS), CANVAS).rgb;
    let image = Image::read(&file("OpenRaster", &mut painting)).expect("a picture");
    let size = CELLS.map(|cells| cells as usize);
    assert_eq!(image.size(), size);
    let raster = colours(&image, size).expect("fitted");
    let rows = raster.rgb.rchunks_exact(size[0]);
    let read: Vec<u8> = rows.flatten().flatten().copied().collect();
    let off = |other: &[u8]| {
        let pairs = read.iter().zip(other);
        pairs.map(|(a, b)| a.abs_diff(*b)).max()
    };
    assert!(off(&flat) <= Some(1), "{:?}", off(&flat));
    assert!(off(&bare) > Some(40), "a fault would pass");
}
