//! Small paintings, and their files.

use std::io::Cursor;

use maulstick_appearance::picture::{Depth, Export};
use maulstick_brush::BrushFile;
use maulstick_exchange::{
    ExchangeError, SolidSetup, write_glb, write_gloss_map, write_height_map, write_lit_png,
    write_open_exr, write_open_raster, write_stl,
};
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Dry, Fill, FillPaint, Load};
use maulstick_painting::picture::banded;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::Pose;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{BrushName, FilmThickness, LayerName, Share};

/// Size of the canvas, cells: no multiple of a tile.
pub(crate) const CELLS: [u32; 2] = [150, 70];
/// Side of a cell, m.
pub(crate) const CELL_M: f64 = 2.5e-4;

pub(crate) fn bare(cells: [u32; 2]) -> Painting {
    bare_of("impasto", cells)
}

/// A painting whose canvas has this paint model.
pub(crate) fn bare_of(model: &str, cells: [u32; 2]) -> Painting {
    let setup = PaintingSetup {
        cells,
        model: model.to_owned(),
        cell_m: CELL_M,
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let mut painting = Painting::new(&setup, library).expect("a painting");
    let file = BrushFile::library("round").expect("round");
    painting.define_brush("main", file.scaled_to(8.0).expect("a size"));
    painting
}

/// A stroke from left to right, `y_mm` up the canvas.
pub(crate) fn stroke(painting: &mut Painting, number: u64, load: &str, [x_mm, y_mm]: [f64; 2]) {
    let mixture: maulstick_types::Mixture = load.parse().expect("a mixture");
    painting
        .apply(Load {
            mixture: mixture.clone(),
            beside: None,
            brush: BrushName::main(),
        })
        .expect("known");
    let file = BrushFile::library("round").and_then(|file| file.scaled_to(8.0));
    let file = file.expect("round");
    let solve = |dx_mm: f64| Solve {
        event_ns: 0,
        stroke: number,
        surface: CANVAS,
        flags: 0,
        pose: Pose {
            position_m: [(x_mm + dx_mm) * 1e-3, y_mm * 1e-3, 0.6 * file.length_m()],
            ..Pose::IDENTITY
        },
        zoom: 1.0,
        angles_rad: vec![[0.2, 0.3]; file.spines.all_joints()],
        contacts: Vec::new(),
    };
    let state = BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: vec![solve(0.0), solve(8.0), solve(17.0)],
    };
    painting.state("main", 1, &state).expect("it fits");
}

/// Two dry layers, the lower one under a name that XML must escape, and wet paint over parts of them.
pub(crate) fn painted() -> Painting {
    painted_of("impasto")
}

/// The same with another paint model.
pub(crate) fn painted_of(model: &str) -> Painting {
    let mut painting = bare_of(model, CELLS);
    stroke(
        &mut painting,
        1,
        "Ultramarine Blue=0.3,Titanium White=0.7",
        [3.0, 7.0],
    );
    painting
        .apply(Dry {
            share: Share::new(1.0).expect("in range"),
            layer: LayerName::new("sky <\"first\"> & sea").ok(),
            ..Dry::whole(CANVAS)
        })
        .expect("wet");
    stroke(
        &mut painting,
        2,
        "Hansa Yellow Opaque=0.2,Thinner=0.8",
        [10.0, 9.0],
    );
    painting
        .apply(Dry {
            share: Share::new(0.6).expect("in range"),
            layer: LayerName::new("glaze").ok(),
            ..Dry::whole(CANVAS)
        })
        .expect("wet");
    stroke(&mut painting, 3, "Pyrrole Red", [14.0, 5.0]);
    painting
}

/// A painting of one cell, with a dry layer and wet paint.
pub(crate) fn speck() -> Painting {
    let mut painting = bare([1, 1]);
    let mut lay = |paint: &str| {
        let mixture: maulstick_types::Mixture = paint.parse().expect("a mixture");
        painting
            .apply(Fill {
                paint: FillPaint::Mixture {
                    mixture: mixture.clone(),
                },
                thickness: FilmThickness::new(3e-5).expect("in range"),
                surface: CANVAS,
            })
            .expect("it fits");
        painting
            .apply(Dry {
                share: Share::new(0.5).expect("in range"),
                ..Dry::whole(CANVAS)
            })
            .expect("wet");
    };
    lay("Yellow Ochre");
    lay("Ultramarine Blue");
    painting
}

/// Heights of a whole surface, m, row after row from the top.
pub(crate) fn heights(painting: &mut Painting) -> Vec<f32> {
    let banded = banded(painting, CANVAS).expect("a canvas");
    let width = banded.cells()[0];
    let rows = |band: usize| {
        let heights = banded.heights(band);
        let rows = heights.chunks_exact(width).rev().map(<[f32]>::to_vec);
        rows.collect::<Vec<_>>().concat()
    };
    (0..banded.bands()).flat_map(rows).collect()
}

pub(crate) const STL: SolidSetup = SolidSetup {
    base_mm: 2.0,
    exaggeration: 5.0,
    step: 3,
};

/// An export into a file, with its progress.
pub(crate) type Write =
    fn(&mut Painting, u32, &mut dyn File, &mut dyn FnMut(u64, u64)) -> Result<(), ExchangeError>;

/// Target of exports.
pub(crate) trait File: std::io::Write + std::io::Seek {}

impl<T: std::io::Write + std::io::Seek> File for T {}

/// All exports.
pub(crate) const EXPORTS: [(&str, Write); 8] = [
    ("PNG, 8 bits", |painting, surface, to, tell| {
        write_lit_png(
            painting,
            surface,
            (&Export::default(), Depth::Eight),
            to,
            tell,
        )
    }),
    ("PNG, 16 bits", |painting, surface, to, tell| {
        write_lit_png(
            painting,
            surface,
            (&Export::default(), Depth::Sixteen),
            to,
            tell,
        )
    }),
    ("height map", |painting, surface, to, tell| {
        write_height_map(painting, surface, to, tell).map(|_| ())
    }),
    ("gloss map", |painting, surface, to, tell| {
        write_gloss_map(painting, surface, to, tell)
    }),
    ("OpenEXR", |painting, surface, to, tell| {
        write_open_exr(painting, surface, to, tell)
    }),
    ("OpenRaster", |painting, surface, to, tell| {
        write_open_raster(painting, surface, to, tell)
    }),
    ("STL", |painting, surface, to, tell| {
        write_stl(painting, surface, &STL, to, tell).map(|_| ())
    }),
    ("glTF", |painting, surface, to, tell| {
        write_glb(painting, surface, &STL, to, tell).map(|_| ())
    }),
];

/// The bytes of the export called `name`.
pub(crate) fn file(name: &str, painting: &mut Painting) -> Vec<u8> {
    let (_, write) = EXPORTS
        .iter()
        .find(|(other, _)| *other == name)
        .expect("an export");
    let mut to = Cursor::new(Vec::new());
    write(painting, CANVAS, &mut to, &mut |_, _| {}).expect("written");
    to.into_inner()
}

/// A PNG's header and bytes.
pub(crate) fn decoded(file: &[u8]) -> (png::Info<'static>, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(file))
        .read_info()
        .expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut bytes).expect("pixels");
    reader.finish().expect("an end");
    (reader.info().clone(), bytes)
}
