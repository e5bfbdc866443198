use std::sync::Arc;

use maulstick_canvas::page::Page;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::sheet;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::{Tile, Version};
use maulstick_optics::colour::SrgbTable;
use maulstick_optics::light::{Facet, HeightField, Lamp, LampSetup, Spot, Surroundings, lit};
use maulstick_optics::{FilmPlanes, PaintLibrary, Studio, Under};
use maulstick_types::paint::TILE;

use super::drawing::flat;
use super::*;
use crate::appearance::Appearance;
use crate::bakery::Bakery;
use crate::bands::Banded;
use crate::blank_surface::BlankSurface;
use crate::show_paint::Counted;
use crate::shown_surface::ShownSurface;

const CELLS: [u32; 2] = [150, 70];
const CELL_M: f64 = 2.5e-4;

/// A film whose thickness in quanta is a function of the place.
fn store(quanta: impl Fn(usize, usize) -> f32) -> TileStore {
    let mut store = TileStore::new(CELLS);
    let ids: Vec<_> = store.iter().map(|(id, _)| id).collect();
    for id in ids {
        let place = |i: usize| {
            quanta(
                id.x as usize * TILE + i % TILE,
                id.y as usize * TILE + i / TILE,
            )
        };
        let plane: Arc<[f32]> = (0..TILE * TILE).map(place).collect();
        let tile = Some(Arc::new(Tile::new([(0, plane)].into_iter(), None)));
        store.replace(id, Version { number: 2, tile });
    }
    store
}

fn studio() -> Studio {
    let mut studio = Studio::daylight();
    let library = PaintLibrary::measured().expect("whole");
    studio.add(library.find("Ultramarine Blue").expect("known"));
    studio
}

fn bare(studio: &Studio) -> ShownSurface {
    ShownSurface {
        shown: &Counted,
        blank: BlankSurface {
            cells: CELLS,
            ground: crate::ground::Ground::Even(vec![0.95; studio.wavelengths()]),
            relief: Arc::new(Relief::flat(CELL_M)),
            wells: Vec::new(),
        },
    }
}

fn drawn(
    store: &TileStore,
    light: impl Fn(&Spot) -> [f32; 3] + Sync + 'static,
    surroundings: Option<Surroundings>,
) -> Picture {
    let studio = studio();
    let bare = bare(&studio);
    let look = Appearance::new(studio);
    let export = Export {
        gamut: GamutMapping::Clamp,
        ..Default::default()
    };
    let banded = Banded::new(store, &bare, &look, CELL_M);
    Picture::of(&Drawing::new(
        banded,
        Box::new(light),
        surroundings,
        &export,
    ))
}

/// Heights of a whole surface, row after row from the lowest.
fn heights(store: &TileStore) -> Vec<f32> {
    let studio = studio();
    let bare = bare(&studio);
    let look = Appearance::new(studio);
    let banded = Banded::new(store, &bare, &look, CELL_M);
    let bands = (0..banded.bands()).rev();
    bands
        .flat_map(|band| banded.heights(band).to_vec())
        .collect()
}

fn upper_left() -> Lamp {
    Lamp::new(&LampSetup {
        toward: [-0.5, 0.5, 0.5f64.sqrt()],
        ..Default::default()
    })
}

fn around(lamp: &Lamp) -> Surroundings {
    Surroundings::new(lamp, CELL_M as f32)
}

#[test]
fn slopes_go_on_over_the_borders_of_tiles() {
    const BEND: f32 = 40.0;
    let bowl = store(|x, y| BEND * (x * x + y * y) as f32);
    // Slope as a colour: in a paraboloid it increases equally with every cell.
    let scale = (CELL_M / QUANTUM_M) as f32 / (2.0 * BEND * 150.0);
    let light = move |spot: &Spot| {
        let [x, y] = spot.facet.slope.map(|slope| slope * scale);
        [x, y, 0.0]
    };
    let surroundings = Some(around(&upper_left()));
    let shown = drawn(&bowl, light, surroundings);
    let table = SrgbTable::default();
    let expected = |x: usize, y: usize| {
        let inside = |at: usize, size: u32| at > 0 && at + 1 < size as usize;
        (inside(x, CELLS[0]) && inside(y, CELLS[1]))
            .then(|| [x, y].map(|at| table.byte(at as f32 / 150.0)))
    };
    let off = |shown: &Picture| {
        let mut worst = 0;
        for (i, pixel) in shown.rgb.chunks_exact(3).enumerate() {
            let (x, y) = (i % shown.width, shown.height - 1 - i / shown.width);
            for (got, want) in expected(x, y).iter().flatten().zip(pixel) {
                worst = worst.max(got.abs_diff(*want));
            }
        }
        worst
    };
    assert!(off(&shown) <= 1, "{}", off(&shown));
    let torn = store(|x, y| BEND * (x * x + y * y) as f32 + f32::from(x as u16 / 64) * 2000.0);
    let shown = drawn(&torn, light, surroundings);
    assert!(off(&shown) > 1, "a seam would pass");
}

#[test]
fn a_flat_film_is_lit_to_its_unlit_colour_and_a_ridge_is_not() {
    let lamp = upper_left();
    let both = |store: &TileStore| {
        let (around, lamp) = (around(&lamp), lamp.clone());
        let lit = drawn(store, move |spot| lit(spot, &lamp), Some(around));
        (lit, drawn(store, |spot| flat(spot, [1.0; 3]), None))
    };
    let (flat, unlit) = both(&store(|_, _| 50_000.0));
    assert!(flat == unlit);
    let (ridge, unlit) = both(&store(|x, _| {
        50_000.0 + if x == 64 { 40_000.0 } else { 0.0 }
    }));
    let sum = |picture: &Picture, x: usize| -> u32 {
        let pixel = &picture.rgb[(30 * picture.width + x) * 3..][..3];
        pixel.iter().map(|channel| u32::from(*channel)).sum()
    };
    assert!(
        sum(&ridge, 63) > sum(&unlit, 63),
        "the flank toward the lamp"
    );
    assert!(sum(&ridge, 65) < sum(&unlit, 65), "the flank away from it");
}

#[test]
fn shadows_and_occlusion_go_on_over_the_borders_of_tiles() {
    // A wall of one millimetre across the corner where four tiles meet.
    let wall = store(|x, y| {
        let across = (60..64).contains(&(x + 64 - y.min(64)));
        50_000.0 + if across { 660_000.0 } else { 0.0 }
    });
    let lamp = upper_left();
    let whole = HeightField {
        heights: &heights(&wall),
        cells: CELLS.map(|cells| cells as usize),
        cell_m: CELL_M as f32,
    };
    let surroundings = around(&lamp);
    let of = |facet: &Facet| [facet.seen, facet.open, 0.0];
    let shown = drawn(&wall, move |spot| of(&spot.facet), Some(surroundings));
    let table = SrgbTable::default();
    let (mut dark, mut hidden) = (0, 0);
    for (i, pixel) in shown.rgb.chunks_exact(3).enumerate() {
        let (x, y) = (i % shown.width, shown.height - 1 - i / shown.width);
        let mut facet = [Facet::LEVEL];
        surroundings.row(&whole, [x, y], &mut facet);
        let expected = of(&facet[0]).map(|share| table.byte(share));
        assert_eq!(*pixel, expected, "{x} {y}");
        dark += u32::from(pixel[0] < 128);
        hidden += u32::from(pixel[1] < 200);
    }
    assert!(dark > 50 && hidden > 50, "{dark} {hidden}");
}

/// A cell of which paint covers a quarter shows the ground in the rest.
#[test]
fn the_ground_shows_beside_paint_at_its_edge() {
    let studio = studio();
    let (bare, look) = (bare(&studio), Appearance::new(studio));
    let quanta = |um: f64| (um * 1e-6 / QUANTUM_M) as f32;
    let red = |of: &dyn Fn(usize) -> f64, x: usize| {
        let store = store(|x, _| quanta(of(x)));
        let banded = Banded::new(&store, &bare, &look, CELL_M);
        let (id, tile) = banded.tiles(0).next().expect("a tile");
        banded.shown(id, tile, &mut Bakery::default()).rgb[0][x]
    };
    let edge = |x: usize| match x {
        0..20 => 300.0,
        20 => 75.0,
        _ => 0.0,
    };
    let (paint, ground) = (red(&|_| 75.0, 20), red(&|_| 0.0, 20));
    let off = |want: f32| (red(&edge, 20) - want).abs();
    assert!(off(0.25 * paint + 0.75 * ground) < 1e-5);
    assert!(off(paint) > 0.2, "an even film passes");
    assert_eq!(red(&edge, 21), ground);
}

/// What lies on top is seen over the rest, wet and dry, and not as its mixture.
#[test]
fn light_sees_two_sheets_in_order() {
    let mut studio = studio();
    let library = PaintLibrary::measured().expect("whole");
    let white = studio.add(library.find("Titanium White").expect("known"));
    let (bare, look) = (bare(&studio), Appearance::new(studio.clone()));
    let [blue_um, white_um] = [250.0, 60.0];
    let plane = |um: f64| vec![(um * 1e-6 / QUANTUM_M) as f32; TILE_CELLS];
    let planes = |order: [usize; 2]| {
        let [under, over] = order;
        let um = |slot: usize| if slot == white { white_um } else { blue_um };
        let counts = [under, over].map(|slot| (slot, plane(um(slot)).into()));
        let mut counts = Vec::from(counts);
        counts.sort_by_key(|(slot, _)| *slot);
        let planes = Planes::from_iter(counts);
        planes.with_own([sheet::note(over, plane(um(over)).into_iter())])
    };
    let seen = |tile: &Tile| {
        let store = TileStore::new(CELLS);
        let banded = Banded::new(&store, &bare, &look, CELL_M);
        let id = banded.tiles(0).next().expect("a tile").0;
        let shown = banded.shown(id, Some(tile), &mut Bakery::default());
        shown.rgb.map(|plane| plane[9])
    };
    let film = |paint: usize, um: f64, under: Under<'_>| {
        let metres = vec![1e-6 * um as f32; TILE_CELLS];
        let paints = [(paint, &metres[..])];
        let films = FilmPlanes {
            paints: &paints,
            opacity: 1.0,
            under,
        };
        let mut rgb = [(); 3].map(|()| vec![0.0; TILE_CELLS]);
        let [red, green, blue] = &mut rgb;
        studio.shade(&films, [red, green, blue]);
        (rgb.map(|plane| plane[9]), studio.bake(&films, TILE_CELLS))
    };
    let ground = vec![0.95; studio.wavelengths()];
    let (_, under) = film(0, blue_um, Under::Even(&ground));
    let (want, _) = film(white, white_um, Under::Planes(&under));
    let wet = Tile::of_pages(Some(Page::loose(planes([0, white]))), None);
    let dry = wet.dried(1, 1.0, &[]).expect("wet");
    let near = |got: [f32; 3]| (0..3).all(|i| (got[i] - want[i]).abs() < 1e-3);
    assert!(near(seen(&wet)), "{:?} {want:?}", seen(&wet));
    assert!(near(seen(&dry)), "{:?} {want:?}", seen(&dry));
    let other = Tile::of_pages(Some(Page::loose(planes([white, 0]))), None);
    assert!(!near(seen(&other)), "the other order passes");
    let mixed = Tile::of_pages(Some(Page::loose(planes([0, white]).with_own([]))), None);
    assert!(!near(seen(&mixed)), "a mixture passes");
}
