//! Binary glTF, read by another reader than wrote it.

use std::collections::BTreeMap;
use std::io::Cursor;

use maulstick_exchange::{ExchangeError, SolidSetup, write_glb};
use maulstick_painting::Painting;
use maulstick_types::scene::CANVAS;

use crate::support::{CELL_M, CELLS, STL, bare, bare_of, file, painted, painted_of, speck};

/// A facet: its corners.
type Facet = [[f32; 3]; 3];

/// The primitive of a file: places, normals, colours, and numbers of vertices.
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

/// Facets of an STL, lengths in mm.
fn stl(painting: &mut Painting) -> Vec<Facet> {
    let bytes = file("STL", painting);
    let facet = |facet: &[u8]| {
        let float = |i: usize| f32::from_le_bytes(facet[4 * i..][..4].try_into().expect("four"));
        [1, 2, 3].map(|corner| [0, 1, 2].map(|axis| float(3 * corner + axis)))
    };
    bytes[84..].chunks_exact(50).map(facet).collect()
}

fn is_closed(facets: &[Facet]) -> bool {
    let mut edges: BTreeMap<[[u32; 3]; 2], [u32; 2]> = BTreeMap::new();
    for facet in facets {
        let bits = facet.map(|corner| corner.map(f32::to_bits));
        for i in 0..3 {
            let (from, to) = (bits[i], bits[(i + 1) % 3]);
            edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
        }
    }
    edges.values().all(|runs| *runs == [1, 1])
}

fn volume(facets: &[Facet]) -> f64 {
    let part = |facet: &Facet| {
        let [a, b, c] = facet.map(|corner| corner.map(f64::from));
        let cross = [
            b[1] * c[2] - b[2] * c[1],
            b[2] * c[0] - b[0] * c[2],
            b[0] * c[1] - b[1] * c[0],
        ];
        (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
    };
    facets.iter().map(part).sum()
}

#[test]
fn it_is_the_solid_of_the_stl_with_every_model() {
    for model in ["impasto", "dab", "stokes"] {
        let mut painting = painted_of(model);
        let read = read(&file("glTF", &mut painting));
        let (facets, printed) = (read.facets(), stl(&mut painting));
        assert!(is_closed(&facets) && is_closed(&printed), "{model}");
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
        assert!(!is_closed(&turned), "a fault would pass");
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

#[test]
fn its_colours_are_those_of_the_paint() {
    let mut painting = bare_of("impasto", CELLS);
    let ground = read(&file("glTF", &mut painting));
    let [red, green, blue, alpha] = ground.colours[1000];
    assert!(
        alpha == 1.0 && red > 0.5 && green > 0.5 && blue > 0.5,
        "gesso"
    );
    crate::support::stroke(&mut painting, 1, "Pyrrole Red", [14.0, 8.0]);
    let read = read(&file("glTF", &mut painting));
    let at = [18.0, 8.0].map(|mm: f32| mm * 1e-3);
    let nearest = (0..read.places.len()).min_by(|a, b| {
        let far = |i: usize| {
            (read.places[i][0] - at[0]).abs() + (read.places[i][1] - at[1]).abs()
                - read.places[i][2]
        };
        far(*a).total_cmp(&far(*b))
    });
    let [red, green, ..] = read.colours[nearest.expect("vertices")];
    assert!(red > 2.0 * green, "{red} {green}");
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
