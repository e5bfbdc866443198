//! Binary glTF, read by another reader than wrote it.

use std::io::Cursor;

use maulstick_appearance::picture::{Export, Picture};
use maulstick_exchange::{ExchangeError, SolidSetup, write_glb};
use maulstick_optics::gamut::GamutMapping;
use maulstick_painting::Painting;
use maulstick_painting::picture::flat_drawing;
use maulstick_types::scene::CANVAS;

use crate::mesh::{Facet, corners, is_watertight, stl_facets, volume};
use crate::support::{CELL_M, CELLS, STL, bare, bare_of, file, painted, painted_of, speck};

/// The primitive of a file: places, normals, colours, and vertex indices.
struct Read {
    places: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    colours: Vec<[f32; 4]>,
    indices: Vec<u32>,
}

fn read(bytes: &[u8]) -> Read {
    let glb = gltf::Gltf::from_slice(bytes).expect("binary glTF that follows its rules");
    let blob = glb.blob.clone().expect("vertices");
    let mesh = glb.meshes().next().expect("a mesh");
    let primitive = mesh.primitives().next().expect("a primitive");
    let values = |accessor: gltf::Accessor<'_>| -> Vec<u8> {
        let view = accessor.view().expect("a view");
        let stride = view.stride().unwrap_or(accessor.size());
        let start = view.offset() + accessor.offset();
        let value = |i: usize| blob[start + i * stride..][..accessor.size()].to_vec();
        (0..accessor.count()).flat_map(value).collect()
    };
    let of = |semantic: gltf::Semantic| values(primitive.get(&semantic).expect("an attribute"));
    let floats = |bytes: Vec<u8>| -> Vec<[f32; 3]> {
        let float = |four: &[u8]| f32::from_le_bytes(four.try_into().expect("four"));
        let all: Vec<f32> = bytes.chunks_exact(4).map(float).collect();
        all.chunks_exact(3)
            .map(|three| three.try_into().expect("three"))
            .collect()
    };
    let level = |two: &[u8]| f32::from(u16::from_le_bytes(two.try_into().expect("two"))) / 65_535.0;
    let colours: Vec<f32> = of(gltf::Semantic::Colors(0))
        .chunks_exact(2)
        .map(level)
        .collect();
    let bounds = primitive.bounding_box();
    let places = floats(of(gltf::Semantic::Positions));
    for axis in 0..3 {
        let along = places.iter().map(|place| place[axis]);
        assert_eq!(along.clone().fold(f32::MAX, f32::min), bounds.min[axis]);
        assert_eq!(along.fold(f32::MIN, f32::max), bounds.max[axis]);
    }
    let indices = values(primitive.indices().expect("indices"));
    let number = |four: &[u8]| u32::from_le_bytes(four.try_into().expect("four"));
    Read {
        normals: floats(of(gltf::Semantic::Normals)),
        colours: colours
            .chunks_exact(4)
            .map(|four| four.try_into().expect("four"))
            .collect(),
        indices: indices.chunks_exact(4).map(number).collect(),
        places,
    }
}

impl Read {
    fn facets(&self) -> Vec<Facet> {
        let corner = |index: &u32| self.places[*index as usize];
        let triangles = self.indices.chunks_exact(3);
        triangles
            .map(|three| [corner(&three[0]), corner(&three[1]), corner(&three[2])])
            .collect()
    }
}

#[test]
fn it_is_the_solid_of_the_stl_with_every_model() {
    for model in ["impasto", "dab", "stokes"] {
        let mut painting = painted_of(model);
        let read = read(&file("glTF", &mut painting));
        let facets = read.facets();
        let printed = corners(&stl_facets(&file("STL", &mut painting)));
        assert!(is_watertight(&facets) && is_watertight(&printed), "{model}");
        assert_eq!(facets.len(), printed.len(), "{model}");
        let ratio = volume(&facets) * 1e9 / volume(&printed);
        println!("{model}: {} facets, volumes {ratio}", facets.len());
        assert!((ratio - 1.0).abs() < 1e-5, "{model}");
        for normal in &read.normals {
            let length = normal.iter().map(|part| part * part).sum::<f32>();
            assert!((length - 1.0).abs() < 1e-4, "{model}");
        }
        let mut turned = facets;
        turned[7].swap(0, 1);
        assert!(!is_watertight(&turned), "a fault would pass");
    }
}

/// mm³ of all paint on a canvas, by its counts in quanta of 25 mm / 2²⁴.
fn paint_mm3(painting: &Painting) -> f64 {
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store
        .iter()
        .filter_map(|(_, version)| version.tile.as_deref());
    let pages = tiles.flat_map(|tile| tile.pages().map(|page| page.get()));
    let counts = pages.map(|planes| {
        let counts = planes.iter().flat_map(|(_, plane)| plane.iter());
        counts.copied().map(f64::from).sum::<f64>()
    });
    let cell_mm = CELL_M * 1e3;
    counts.sum::<f64>() * cell_mm * cell_mm * 25.0 / 16_777_216.0
}

/// Volume of a solid, mm³, and height of its corner, mm.
fn measured(painting: &mut Painting) -> (f64, f64) {
    let mut to = Cursor::new(Vec::new());
    let setup = SolidSetup {
        step: 1,
        exaggeration: 1.0,
        ..STL
    };
    write_glb(painting, CANVAS, &setup, &mut to, &mut |_, _| {}).expect("written");
    let facets = read(&to.into_inner()).facets();
    let at_corner = facets.iter().flatten().filter(|at| at[..2] == [0.0, 0.0]);
    let corner = at_corner.map(|at| at[2]).fold(0.0, f32::max);
    (volume(&facets) * 1e9, f64::from(corner) * 1e3)
}

#[test]
fn its_volume_is_that_of_canvas_and_paint() {
    for model in ["impasto", "dab", "stokes"] {
        let mut painting = painted_of(model);
        let (all, corner) = measured(&mut painting);
        let want = paint_mm3(&painting);
        let (canvas, bare_corner) = measured(&mut bare_of(model, CELLS));
        // The base lies under the lowest place, which is higher under paint: corners are bare.
        let area = f64::from(CELLS[0] * CELLS[1]) * (CELL_M * 1e3) * (CELL_M * 1e3);
        let paint = all - canvas + (bare_corner - corner) * area;
        println!("{model}: {paint:.4} mm³ of {want:.4}");
        assert!((paint / want - 1.0).abs() < 5e-4, "{model}");
        assert!(
            (paint / (1.002 * want) - 1.0).abs() > 5e-4,
            "a fault would pass"
        );
    }
}

#[test]
fn its_normals_look_out_and_are_smooth() {
    let read = read(&file("glTF", &mut painted()));
    let [mut by_area, mut by_count] = [(); 2].map(|()| vec![[0.0; 3]; read.places.len()]);
    for (facet, indices) in read.facets().iter().zip(read.indices.chunks_exact(3)) {
        let side = |to: usize| [0, 1, 2].map(|i| f64::from(facet[to][i] - facet[0][i]));
        let (u, v) = (side(1), side(2));
        let face = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        for index in indices {
            for (sums, face) in [(&mut by_area, face), (&mut by_count, unit(face))] {
                let sum = &mut sums[*index as usize];
                *sum = [0, 1, 2].map(|i| sum[i] + face[i]);
            }
        }
    }
    let off = |sums: &[[f64; 3]]| {
        let off = sums.iter().zip(&read.normals).map(|(sum, normal)| {
            let apart = unit(*sum)
                .into_iter()
                .zip(normal)
                .map(|(a, b)| (a - f64::from(*b)).abs());
            apart.fold(0.0, f64::max)
        });
        off.fold(0.0, f64::max)
    };
    println!("normals off by {:.1e}", off(&by_area));
    assert!(off(&by_area) < 1e-3);
    assert!(off(&by_count) > 1e-2, "a fault would pass");
}

fn unit(n: [f64; 3]) -> [f64; 3] {
    let length = n.iter().map(|part| part * part).sum::<f64>().sqrt();
    n.map(|part| part / length)
}

/// Share of the light that a paint's surface mirrors (Saunderson 1942, k₁): a picture has it, an unlit colour has not.
const MIRRORED: f32 = 0.03;

fn power(base: f32, exponent: f64) -> f32 {
    maulstick_num::powf(f64::from(base), exponent) as f32
}

/// sRGB level of a linear channel, 0 to 255 (IEC 61966-2-1).
fn srgb_level(linear: f32) -> f32 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * power(linear, 1.0 / 2.4) - 0.055
    };
    255.0 * encoded
}

/// Greatest difference of vertex colours of the canvas's cells from the pixels of its unlit sRGB picture, in levels,
/// for colours in the gamut; and the number of channels compared.
fn off_picture(painting: &mut Painting, as_linear: fn(f32) -> f32) -> (f32, usize) {
    let mut to = Cursor::new(Vec::new());
    let setup = SolidSetup { step: 1, ..STL };
    write_glb(painting, CANVAS, &setup, &mut to, &mut |_, _| {}).expect("written");
    let read = read(&to.into_inner());
    let clamped = Export {
        gamut: GamutMapping::Clamp,
        ..Export::default()
    };
    let drawing = flat_drawing(painting, CANVAS, &clamped).expect("a canvas");
    let picture = Picture::of(&drawing).rgb;
    let [width, height] = CELLS.map(|cells| cells as usize);
    let (mut off, mut count) = (0.0f32, 0);
    for (place, colour) in read.places.iter().zip(&read.colours) {
        let [x, y] = [place[0], place[1]].map(|m| m / CELL_M as f32 - 0.5);
        // The middles of cells; not the rim.
        if [x, y].iter().any(|at| (at - at.round()).abs() > 0.01) || place[2] == 0.0 {
            continue;
        }
        let pixel = 3 * ((height - 1 - y.round() as usize) * width + x.round() as usize);
        let pixel = &picture[pixel..][..3];
        if pixel.iter().any(|level| [0, 255].contains(level)) {
            continue;
        }
        for (level, channel) in pixel.iter().zip(colour) {
            let shown = srgb_level(as_linear(*channel) + MIRRORED);
            off = off.max((shown - f32::from(*level)).abs());
            count += 1;
        }
    }
    (off, count)
}

#[test]
fn its_colours_are_those_of_the_paint_in_linear_srgb() {
    let mut painting = bare_of("impasto", CELLS);
    crate::support::stroke(
        &mut painting,
        1,
        "Titanium White=0.6,Ultramarine Blue=0.4",
        [14.0, 8.0],
    );
    let (off, count) = off_picture(&mut painting, |channel| channel);
    println!("off by {off} levels in {count} channels");
    assert!(off < 1.0 && count > 20_000);
    // Linear values taken for sRGB, and sRGB values in the file, are a gamma off.
    let (darker, _) = off_picture(&mut painting, |channel| power(channel, 2.2));
    let (lighter, _) = off_picture(&mut painting, |channel| srgb_level(channel) / 255.0);
    println!("with a fault off by {darker} and {lighter} levels");
    assert!(darker > 20.0 && lighter > 20.0, "a fault would pass");
    let alphas = read(&file("glTF", &mut painting)).colours;
    assert!(alphas.iter().all(|colour| colour[3] == 1.0));
}

#[test]
fn it_is_metres_large_and_bad_measures_are_refused() {
    let read = read(&file("glTF", &mut speck()));
    let most = |axis: usize| read.places.iter().map(|at| at[axis]).fold(0.0, f32::max);
    assert!(
        [most(0), most(1)]
            .iter()
            .all(|length| (f64::from(*length) - CELL_M).abs() < 1e-9)
    );
    assert!((most(2) - 2e-3).abs() < 1e-7);
    let refused = |painting: &mut Painting, setup: SolidSetup| {
        let mut to = Cursor::new(Vec::new());
        let error = write_glb(painting, CANVAS, &setup, &mut to, &mut |_, _| {});
        assert!(to.into_inner().is_empty());
        println!("{}", error.as_ref().expect_err("refused"));
        error
    };
    let thin = SolidSetup {
        base_mm: 0.0,
        ..STL
    };
    let none = refused(&mut speck(), thin);
    assert!(matches!(none, Err(ExchangeError::OutOfRange { .. })));
    let vast = SolidSetup { step: 1, ..STL };
    let vast = refused(&mut bare([65_536, 65_536]), vast);
    assert!(matches!(
        vast,
        Err(ExchangeError::TooManyTriangles { step: 47, .. })
    ));
}
