//! Tiles converted between films and volumes, and their distance by the display's code, an independent oracle.

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::Bakery;
use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::colouring::Colouring;
use maulstick_appearance::ground::Ground;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_convert::{Converted, Converter, Distance, OBVIOUS_DELTA_E, TileGround};
use maulstick_dab::Layers;
use maulstick_dab::layers::VOLUMES;
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
const VOLUME_MIX: Colouring = Colouring::Volumes(&VOLUMES);

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
            Colouring::Volumes(_) => &Layers { emboss: 0.0 },
        };
        let bare = ShownSurface {
            blank: BlankSurface {
                cells: [64; 2],
                ground: self.ground.clone(),
                relief: Arc::new(Relief::flat(2.5e-4)),
                wells: Vec::new(),
            },
            shown,
        };
        let ground = self.ground.tile(ID);
        let studio = &self.look.studio;
        let films = bare.films(Some(tile));
        let mut backend = CpuFilms::new();
        let baked = bare.baked(Some(tile)).map(|stack| {
            Bakery::default().planes(
                (&self.look, &mut backend),
                shown,
                0,
                ID,
                (stack, ground.under()),
            )
        });
        let under = match &baked {
            Some(planes) => maulstick_optics::Under::Planes(planes),
            None => ground.under(),
        };
        let rgb = films.shade(studio, under);
        let shown = bare.display(ID, Some(tile), (&films, rgb), &self.look);
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

/// Pseudorandom numbers (Knuth's multiplicative hash), 0 to 1.
fn drawn(seed: usize) -> f32 {
    let mixed = (seed as u32).wrapping_mul(2_654_435_761) ^ 0x9e37_79b9;
    let mixed = mixed.wrapping_mul(0x85eb_ca6b) ^ (mixed >> 13);
    (mixed.wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1u32 << 24) as f32
}

/// A layer of strokes: patches of mixtures of two or three paints with soft transitions, `thick` m in the mean.
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

/// A tile, and the tolerances of its conversion to volumes and to films: mean and 95th percentile, ΔE₀₀.
struct Subject {
    name: &'static str,
    tile: Tile,
    limits: [[f64; 2]; 2],
}

fn subjects() -> Vec<Subject> {
    vec![
        Subject {
            name: "thick, wet",
            tile: tile(strokes(1, 200e-6, 0.0, false), Vec::new()),
            limits: [[8.0, 20.0], [0.5, 3.0]],
        },
        Subject {
            name: "thin, dry",
            tile: tile(Planes::new(), vec![strokes(2, 15e-6, 0.3, false)]),
            limits: [[3.5, 13.0], [0.1, 0.2]],
        },
        Subject {
            name: "wet over dry over dry",
            tile: tile(
                strokes(3, 40e-6, 0.1, true),
                vec![strokes(4, 80e-6, 0.0, false), strokes(5, 20e-6, 0.2, true)],
            ),
            limits: [[7.0, 19.0], [1.0, 5.5]],
        },
    ]
}

/// Quanta of each layer of each cell, the wet ones first, and the wet thinner.
fn volumes(tile: &Tile) -> (Vec<Vec<u64>>, Option<Vec<f32>>) {
    let stack = tile.dry().into_iter().flat_map(|stack| stack.layers());
    let dry = stack.map(|layer| quanta(&layer.planes.get()));
    let wet = tile.wet();
    let thinner = wet.iter().find(|(slot, _)| *slot == THIN);
    (
        std::iter::once(quanta(&wet)).chain(dry).collect(),
        thinner.map(|(_, plane)| plane.to_vec()),
    )
}

const WAYS: [(Colouring, Colouring); 2] = [
    (Colouring::Films, VOLUME_MIX),
    (VOLUME_MIX, Colouring::Films),
];

#[test]
fn volumes_stay_by_cell_and_layer_and_colours_come_near() {
    let easel = Easel::new("gesso");
    for Subject { name, tile, limits } in subjects() {
        for ((from, to), [mean_limit, most_limit]) in WAYS.into_iter().zip(limits) {
            let converted = easel.converted(&tile, from, to);
            let own = converted.distance;
            let other = tile_of(converted);
            assert!(volumes(&other) == volumes(&tile), "{name}");
            let before = easel.seen(&tile, from);
            let [mean, most, worst] = distances(&before, &easel.seen(&other, to));
            let [plain, ..] = distances(&before, &easel.seen(&tile, to));
            println!(
                "{name}, {from:?} to {to:?}: {mean:.2} mean, {most:.2} 95 %, {worst:.2} worst; counts as they are {plain:.2}"
            );
            assert!(mean < mean_limit && most < most_limit, "{mean} {most}");
            assert!(plain > mean_limit, "a fault would pass: counts as they are");
            if own.cells == TILE_CELLS as u64 {
                assert!((own.mean() - mean).abs() < 0.02 && (own.worst - worst).abs() < 0.1);
                let seen = easel.seen(&other, to);
                let pairs = before.iter().zip(&seen);
                let off: Vec<f64> = pairs.map(|(one, two)| delta_e_2000(*one, *two)).collect();
                let beyond = off.iter().filter(|off| **off > OBVIOUS_DELTA_E).count() as u64;
                println!("{} of {beyond} beyond {OBVIOUS_DELTA_E}", own.far);
                assert!(own.far.abs_diff(beyond) < 40);
                let [x, y] = own.farthest.expect("a cell").cell;
                assert!((off[y * 64 + x] - worst).abs() < 0.1, "it is told where");
            }
        }
    }
}

/// Wet volumes are less opaque than equally thin films, and have no notes over them.
#[test]
fn a_wet_veil_comes_as_near_as_its_volume_lets_it() {
    let easel = Easel::new("gesso");
    let veil = |wet: bool| {
        let film = strokes(2, 15e-6, 0.3, false);
        let tile = if wet {
            tile(film, Vec::new())
        } else {
            tile(Planes::new(), vec![film])
        };
        let other = tile_of(easel.converted(&tile, Colouring::Films, VOLUME_MIX));
        let before = easel.seen(&tile, Colouring::Films);
        let [mean, ..] = distances(&before, &easel.seen(&other, VOLUME_MIX));
        let [plain, ..] = distances(&before, &easel.seen(&tile, VOLUME_MIX));
        (mean, plain)
    };
    let ((wet, plain), (dry, _)) = (veil(true), veil(false));
    println!("{wet:.2} wet, {dry:.2} dry, {plain:.2} as they are");
    assert!(wet < plain && dry < 0.2 * wet);
}

#[test]
fn there_and_back_is_as_it_was() {
    for ground in ["gesso", "black"] {
        let easel = Easel::new(ground);
        for Subject { name, tile, .. } in subjects() {
            let there = tile_of(easel.converted(&tile, VOLUME_MIX, Colouring::Films));
            let back = tile_of(easel.converted(&there, Colouring::Films, VOLUME_MIX));
            assert!(volumes(&back) == volumes(&tile), "{name}");
            let before = easel.seen(&tile, VOLUME_MIX);
            let [mean, most, worst] = distances(&before, &easel.seen(&back, VOLUME_MIX));
            let [fault, ..] = distances(&before, &easel.seen(&there, VOLUME_MIX));
            println!(
                "{ground}, {name}: {mean:.2} mean, {most:.2} 95 %, {worst:.2} worst, one way only {fault:.2}"
            );
            assert!(mean < BACK, "{mean}");
            assert!(fault > 2.0 * BACK, "a fault would pass: {fault}");
        }
    }
}

/// Tolerance of the mean distance of a painting of volumes that was converted to films and back, ΔE₀₀.
const BACK: f64 = 2.0;

#[test]
fn cells_of_wells_and_tiles_of_the_same_colouring_keep_each_count() {
    let easel = Easel::new("grey");
    let tile = tile(
        strokes(3, 40e-6, 0.1, true),
        vec![strokes(4, 80e-6, 0.0, false)],
    );
    let ground = easel.ground.tile(ID);
    let stays: Vec<usize> = (0..TILE_CELLS).filter(|cell| cell % 64 < 20).collect();
    let ground = TileGround {
        under: ground.under(),
        stays: &stays,
    };
    let count = |planes: &Planes, slot: usize, cell: usize| {
        let found = planes.iter().find(|(own, _)| *own == slot);
        found.map_or(0.0, |(_, plane)| plane[cell])
    };
    let converter = Converter::new(&easel.look, VOLUME_MIX, Colouring::Films);
    let converted = converter.tile(&tile, ground);
    let wet = tile.wet();
    let changed = |cell: usize| {
        let slots = 0..PAINTS.len();
        let mut pairs = slots.map(|slot| [&*wet, &converted.wet].map(|own| count(own, slot, cell)));
        pairs.any(|[one, other]| one != other)
    };
    assert!(stays.iter().all(|cell| !changed(*cell)));
    assert!((0..TILE_CELLS).any(changed), "a fault would pass");
    let same = Converter::new(&easel.look, Colouring::Films, Colouring::Films);
    let same = same.tile(&tile, ground);
    assert!(same.wet == *wet && same.distance.cells == 0);
}

/// Pure paints and mixtures of a common palette, at any thickness, and a mixture out of gamut.
#[test]
fn common_mixtures_are_met_and_what_is_out_of_gamut_is_told() {
    const NEAR: f64 = 0.5;
    let easel = Easel::new("gesso");
    let even = |parts: &[(usize, f32)], um: f32| -> Tile {
        let all = um * 1e-6 / QUANTUM_M as f32;
        let plane = |share: f32| -> Arc<[f32]> { vec![(all * share).floor(); TILE_CELLS].into() };
        let planes = parts.iter().map(|(slot, share)| (*slot, plane(*share)));
        tile(planes.collect(), Vec::new())
    };
    for um in [20.0, 35.0, 70.0, 200.0] {
        for parts in [
            &[(0, 0.8), (5, 0.2)][..],
            &[(0, 0.5), (8, 0.5)][..],
            &[(3, 0.6), (0, 0.4)][..],
            &[(1, 0.6), (5, 0.4)][..],
            &[(0, 1.0)][..],
        ] {
            let subject = even(parts, um);
            let converted = easel.converted(&subject, VOLUME_MIX, Colouring::Films);
            let off = converted.distance.worst;
            println!("{um} µm of {parts:?}: {off:.2}");
            assert!(off < NEAR, "{off}");
        }
    }
    // Thick phthalo is nearly black as a film: no volume is as dark and as green.
    let subject = even(&[(7, 0.7), (10, 0.3)], 200.0);
    let converted = easel.converted(&subject, VOLUME_MIX, Colouring::Films);
    let other = tile_of(converted.clone());
    let [one, two] = [
        easel.seen(&subject, VOLUME_MIX),
        easel.seen(&other, Colouring::Films),
    ];
    let off = delta_e_2000(one[0], two[0]);
    println!("phthalo green and black: {off:.2}");
    let told = converted.distance;
    assert!((off - told.worst).abs() < 0.05, "it is told");
    let farthest = told.farthest.expect("a cell");
    assert!((farthest.film_m - 200e-6).abs() < 1e-6 && !farthest.is_thin());
    let all = TILE_CELLS as u64;
    assert_eq!((told.cells, told.far), (all, 0));
    // Moved to a surface, the place is the surface's, and the farther cell is kept.
    let mut surface = told.moved([64, 128]);
    let cell = farthest.cell;
    let there = surface.farthest.map(|farthest| farthest.cell);
    assert_eq!(there, Some([cell[0] + 64, cell[1] + 128]));
    surface.add(&Distance {
        worst: told.worst - 1.0,
        ..told
    });
    assert_eq!(surface.farthest.map(|farthest| farthest.cell), there);
    assert_eq!(surface.cells, 2 * all);
}
