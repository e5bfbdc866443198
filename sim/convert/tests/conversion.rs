//! Tiles converted between films and volumes, and how near they come as the display shows them: an oracle of its own, for a
//! conversion does not use it.

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::Bakery;
use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::display::DisplayTile;
use maulstick_appearance::ground::Ground;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_canvas::assets::Assets;
use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_convert::{Colouring, Converted, Converter, TileGround};
use maulstick_dab::Layers;
use maulstick_optics::colour::{apply, delta_e_2000, inverse, lab};
use maulstick_optics::{CpuFilms, PaintLibrary, Studio, StudioSettings, THINNER};

/// Paints of a common palette, in their slots.
const PAINTS: [&str; 12] = [
    "Titanium White",
    "Hansa Yellow Opaque",
    "Cadmium Orange",
    "Pyrrole Red",
    "Quinacridone Magenta",
    "Ultramarine Blue",
    "Cobalt Blue",
    "Phthalo Green Blue Shade",
    "Yellow Ochre",
    "Burnt Sienna",
    "Bone Black",
    THINNER,
];
const THIN: usize = 11;
const ID: TileId = TileId { x: 0, y: 0 };
static VOLUMES: Layers = Layers { emboss: 0.0 };

struct Easel {
    look: Appearance,
    ground: Ground,
}

impl Easel {
    fn new(ground: &str) -> Self {
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::new(&StudioSettings::default(), library.paints());
        for paint in PAINTS {
            studio.add(library.find(paint).expect("known"));
        }
        let ground = Ground::called(ground, [64, 64], &studio, &Assets::default()).expect("known");
        let mut look = Appearance::new(studio);
        look.thinner = Some(THIN);
        Self { look, ground }
    }

    fn converted(&self, tile: &Tile, from: Colouring, to: Colouring) -> Converted {
        let ground = self.ground.tile(ID);
        let ground = TileGround {
            under: ground.under(),
            stays: &[],
        };
        Converter::new(&self.look, from, to).tile(tile, ground)
    }

    /// CIELAB of the cells as they are displayed, gloss included.
    fn seen(&self, tile: &Tile, colouring: Colouring) -> Vec<[f64; 3]> {
        let shown: &'static dyn ShowPaint = match colouring {
            Colouring::Films => &Counted,
            Colouring::Volumes => &VOLUMES,
        };
        let bare = BlankSurface {
            ground: self.ground.clone(),
            relief: Arc::new(Relief::flat(2.5e-4)),
            wells: Vec::new(),
            shown,
        };
        let ground = self.ground.tile(ID);
        let studio = &self.look.studio;
        let films = bare.films(Some(tile));
        let mut backend = CpuFilms::new();
        let baked = bare.baked(Some(tile)).map(|stack| {
            Bakery::default().planes((&self.look, &mut backend), 0, ID, (stack, ground.under()))
        });
        let under = match &baked {
            Some(planes) => maulstick_optics::Under::Planes(planes),
            None => ground.under(),
        };
        let rgb = films.shade(studio, under);
        let shown = DisplayTile::on(&bare, ID, Some(tile), (&films, rgb), &self.look);
        let to_xyz = inverse(studio.to_rgb());
        let white = studio.white();
        let cell = |cell: usize| {
            let rgb = [0, 1, 2].map(|i| f64::from(shown.rgb[i][cell]));
            let xyz = apply(&to_xyz, rgb);
            let gloss = studio.surface().k1;
            lab([0, 1, 2].map(|i| xyz[i] + gloss * white[i]), white)
        };
        (0..TILE_CELLS).map(cell).collect()
    }
}

/// Numbers that look random (Knuth's multiplicative hash), 0 to 1.
fn drawn(seed: usize) -> f32 {
    let mixed = (seed as u32).wrapping_mul(2_654_435_761) ^ 0x9e37_79b9;
    let mixed = mixed.wrapping_mul(0x85eb_ca6b) ^ (mixed >> 13);
    (mixed.wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1u32 << 24) as f32
}

/// A layer of strokes: patches of mixtures of two or three paints that go over into each other, `thick` m in the mean.
fn strokes(seed: usize, thick: f32, thinner: f32, gaps: bool) -> Planes {
    let mut planes = vec![vec![0.0f32; TILE_CELLS]; PAINTS.len()];
    for cell in 0..TILE_CELLS {
        let (x, y) = (cell % 64, cell / 64);
        let patch = seed * 1000 + x / 16 * 4 + y / 16;
        if gaps && drawn(patch * 7 + 1) < 0.3 {
            continue;
        }
        let across = (x % 16) as f32 / 15.0;
        let up = (y % 16) as f32 / 15.0;
        let height = thick * (0.1 + 1.8 * up) * (0.8 + 0.4 * drawn(seed + cell * 3));
        let paint = |which: usize| (drawn(patch * 13 + which * 5) * 11.0) as usize;
        let all = height / QUANTUM_M as f32;
        let third = 0.15 * drawn(patch * 17);
        for (which, share) in [
            (0, (1.0 - across) * (1.0 - third)),
            (1, across * (1.0 - third)),
            (2, third),
        ] {
            planes[paint(which).min(10)][cell] += (all * share).floor();
        }
        planes[THIN][cell] = (all * thinner).floor();
    }
    let planes = planes.into_iter().enumerate();
    planes
        .filter(|(_, plane)| plane.iter().any(|count| *count > 0.0))
        .map(|(slot, plane)| (slot, plane.into()))
        .collect()
}

/// A tile of layers, the first at the bottom.
fn tile(wet: Planes, dry: Vec<Planes>) -> Tile {
    let stack = dry
        .into_iter()
        .zip(1..)
        .fold(None, |below, (planes, number)| {
            let planes = Page::loose(planes);
            Some(DryStack::over(below, DryLayer { number, planes }))
        });
    Tile::of_pages((!wet.is_empty()).then(|| Page::loose(wet)), stack)
}

fn tile_of(converted: Converted) -> Tile {
    let mut dry = converted.dry;
    dry.reverse();
    tile(converted.wet, dry)
}

fn quanta(planes: &Planes) -> Vec<u64> {
    let mut sums = vec![0; TILE_CELLS];
    for (_, plane) in planes {
        let cells = sums.iter_mut().zip(plane.iter());
        cells.for_each(|(sum, count)| *sum += *count as u64);
    }
    sums
}

/// Mean, 95th percentile and worst of the distances, ΔE₀₀.
fn distances(one: &[[f64; 3]], other: &[[f64; 3]]) -> [f64; 3] {
    let pairs = one.iter().zip(other);
    let mut all: Vec<f64> = pairs.map(|(a, b)| delta_e_2000(*a, *b)).collect();
    all.sort_by(f64::total_cmp);
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    [mean, all[all.len() * 95 / 100], all[all.len() - 1]]
}

/// Paintings of a tile: a full-bodied one, a thin one, one over two dry layers.
fn subjects() -> Vec<(&'static str, Tile)> {
    vec![
        (
            "thick, wet",
            tile(strokes(1, 200e-6, 0.0, false), Vec::new()),
        ),
        ("thin, wet", tile(strokes(2, 15e-6, 0.3, false), Vec::new())),
        (
            "thin, dry",
            tile(Planes::new(), vec![strokes(2, 15e-6, 0.3, false)]),
        ),
        (
            "wet over dry over dry",
            tile(
                strokes(3, 40e-6, 0.1, true),
                vec![strokes(4, 80e-6, 0.0, false), strokes(5, 20e-6, 0.2, true)],
            ),
        ),
    ]
}

#[test]
fn volumes_stay_by_cell_and_layer_and_colours_come_near() {
    for ground in ["gesso"] {
        let easel = Easel::new(ground);
        for (name, subject) in subjects() {
            for (from, to) in [
                (Colouring::Films, Colouring::Volumes),
                (Colouring::Volumes, Colouring::Films),
            ] {
                let start = std::time::Instant::now();
                let converted = easel.converted(&subject, from, to);
                let took = start.elapsed().as_secs_f64();
                let own = converted.distance;
                let other = tile_of(converted);
                let layers = |tile: &Tile| -> Vec<Vec<u64>> {
                    let stack = tile.dry().cloned();
                    let dry = stack.iter().flat_map(|stack| stack.layers());
                    let dry = dry.map(|layer| quanta(&layer.planes.get()));
                    std::iter::once(quanta(&tile.wet())).chain(dry).collect()
                };
                assert_eq!(layers(&other), layers(&subject), "{name}");
                let thinner = |tile: &Tile| {
                    let wet = tile.wet();
                    let found = wet.iter().find(|(slot, _)| *slot == THIN);
                    found.map(|(_, plane)| plane.to_vec())
                };
                assert_eq!(thinner(&other), thinner(&subject));
                let before = easel.seen(&subject, from);
                let [mean, most, worst] = distances(&before, &easel.seen(&other, to));
                let [plain, ..] = distances(&before, &easel.seen(&subject, to));
                println!(
                    "{ground}, {name}, {from:?} to {to:?}: {mean:.2} mean, {most:.2} 95 %, {worst:.2} worst; \
                     counts as they are: {plain:.2}; {:.2} {:.2}; {:.1} µs a cell",
                    own.mean(),
                    own.worst,
                    took * 1e6 / TILE_CELLS as f64,
                );
            }
        }
    }
}
