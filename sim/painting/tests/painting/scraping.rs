//! Scraping: wet paint goes to the cleaner, dry paint and wells keep theirs. Wells that move take their paint along.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_brush::palette_place::{mirrored, size_m};
use maulstick_painting::edits::{Dry, PaintingEdit as _, Redo, Scrape, Undo, Wells};
use maulstick_painting::setup::wells_of;
use maulstick_painting::{LayerError, Painting, PaintingSetup};
use maulstick_types::Mixture;
use maulstick_types::paint::TILE;
use maulstick_types::scene::{CANVAS, PALETTE, Surface, Well, WellKind};

use super::studio::{BRUSH, fill, load, painting, round, solve, state, wet_paint};

fn scrape(surface: u32, region: Option<&str>) -> Scrape {
    Scrape {
        region: region.map(|region| region.parse().expect("a region")),
        surface,
    }
}

#[test]
fn wet_paint_goes_and_comes_back_by_undo_and_dry_paint_stays() {
    let mut painting = painting(&PaintingSetup {
        cells: [128, 96],
        ..PaintingSetup::default()
    });
    let nothing = scrape(CANVAS, None).apply(&mut painting);
    assert_eq!(nothing, Err(LayerError::NothingWet(None).into()));
    assert_eq!(painting.history_depth().0, 0, "no step");
    fill("Bone Black", 30.0).apply(&mut painting).expect("laid");
    Dry::whole(CANVAS).apply(&mut painting).expect("dried");
    fill("Titanium White", 60.0)
        .apply(&mut painting)
        .expect("laid");
    let before = wet_paint(&painting);
    let dry = painting.store(CANVAS).expect("a canvas").dry_counts();

    scrape(CANVAS, None).apply(&mut painting).expect("wet");
    assert!(wet_paint(&painting).is_empty());
    let store = painting.store(CANVAS).expect("a canvas");
    assert_eq!(store.dry_counts(), dry);
    assert_eq!(painting.report().quanta_missing, 0);
    Undo { brush: None }.apply(&mut painting).expect("a step");
    assert!(wet_paint(&painting) == before);
    assert_eq!(painting.report().quanta_missing, 0);
}

#[test]
fn a_part_is_scraped_alone() {
    let mut painting = painting(&PaintingSetup {
        cells: [128, 96],
        ..PaintingSetup::default()
    });
    fill("Bone Black", 30.0).apply(&mut painting).expect("laid");
    let sum = |painting: &_| -> f64 {
        let planes = wet_paint(painting);
        let cells = planes.iter().flat_map(|plane| &plane.3);
        cells.map(|count| f64::from(*count)).sum()
    };
    let before = sum(&painting);
    // A quarter of 32 mm by 24 mm.
    let part = scrape(CANVAS, Some("0,0,16x12"));
    part.apply(&mut painting).expect("wet");
    assert!((sum(&painting) / before - 0.75).abs() < 1e-9);
    assert_eq!(painting.report().quanta_missing, 0);
    assert!(part.apply(&mut painting).is_err(), "there is no more");
}

/// Paint stirred in a well would form half discs beside the new wells.
#[test]
fn paint_of_wells_that_go_is_scraped_off_alone() {
    let mut painting = painting(&PaintingSetup::default());
    let file = round(10.0, 48);
    painting.define_brush(BRUSH, file.clone());
    painting.apply(load("Bone Black")).expect("known");
    let wells = palette_of(&painting).wells;
    let wet = |painting: &Painting| {
        let store = painting.store(PALETTE).expect("a palette");
        store.counts().iter().sum::<u64>()
    };
    let heap = (0..8).map(|at| {
        let mut solve = solve(&file, 1, [60.0 + f64::from(at), 60.0], 0.45, [0.3, 0.2]);
        solve.surface = PALETTE;
        solve
    });
    painting.state(BRUSH, 1, &state(heap)).expect("it fits");
    painting.commit();
    let heap = wet(&painting);
    assert!(heap > 0);
    let [x, y] = wells[0].center_m.map(|m| 1e3 * m);
    let stirred = (0..12).map(|at| {
        let mut solve = solve(
            &file,
            2,
            [x - 1.0 + 0.2 * f64::from(at), y],
            0.45,
            [0.3, 0.2],
        );
        solve.surface = PALETTE;
        solve
    });
    painting.state(BRUSH, 1, &state(stirred)).expect("it fits");
    painting.commit();
    let before = wet(&painting);
    assert!(before > heap);
    let same = Wells::new(PALETTE, wells.clone()).expect("valid");
    same.apply(&mut painting).expect("they fit");
    assert_eq!(wet(&painting), before, "nothing has moved");
    let moved = Wells::new(PALETTE, wells[1..].to_vec()).expect("valid");
    moved.apply(&mut painting).expect("they fit");
    let left = wet(&painting);
    assert!(left >= heap, "the heap stays");
    assert!(left - heap < (before - heap) / 10, "{left} of {before}");
    assert_eq!(painting.report().quanta_missing, 0);
}

/// Wet paint of the palette by slot and cell.
fn on_palette(painting: &Painting) -> BTreeMap<(usize, u32, u32), f32> {
    let store = painting.store(PALETTE).expect("a palette");
    let tiles = store
        .iter()
        .filter_map(|(id, version)| Some((id, version.tile.as_ref()?)));
    let mut cells = BTreeMap::new();
    for (id, tile) in tiles {
        for (slot, plane) in tile.wet().iter() {
            for (at, count) in plane.iter().enumerate().filter(|(_, count)| **count > 0.0) {
                let side = TILE as u32;
                let (x, y) = (at as u32 % side, at as u32 / side);
                cells.insert((*slot, id.x * side + x, id.y * side + y), *count);
            }
        }
    }
    cells
}

fn palette_of(painting: &Painting) -> Surface {
    let mut surfaces = painting.scene().surfaces.iter();
    surfaces
        .find(|own| own.id == PALETTE)
        .cloned()
        .expect("a palette")
}

/// A palette with black stirred in its third well and in the middle of the board.
fn stirred() -> (Painting, Surface) {
    let mut painting = painting(&PaintingSetup::default());
    let file = round(10.0, 48);
    painting.define_brush(BRUSH, file.clone());
    painting.apply(load("Bone Black")).expect("known");
    let palette = palette_of(&painting);
    let [x, y] = palette.wells[2].center_m.map(|m| 1e3 * m);
    for (stroke, [x, y]) in [(1, [50.0, 100.0]), (2, [x - 1.0, y])] {
        let solves = (0..12).map(|at| {
            let at = [x + 0.2 * f64::from(at), y];
            let mut solve = solve(&file, stroke, at, 0.45, [0.3, 0.2]);
            solve.surface = PALETTE;
            solve
        });
        painting.state(BRUSH, 1, &state(solves)).expect("it fits");
    }
    painting.commit();
    (painting, palette)
}

/// True if a cell of a slot is in a well.
fn is_in(cell: &(usize, u32, u32), well: &Well, cell_m: f64) -> bool {
    let [dx, dy] = [0, 1].map(|i| {
        let at = f64::from([cell.1, cell.2][i]) + 0.5;
        at * cell_m - well.center_m[i]
    });
    dx * dx + dy * dy < well.radius_m * well.radius_m
}

/// Paint in the middle of the board.
fn board(cells: &BTreeMap<(usize, u32, u32), f32>) -> BTreeMap<(usize, u32, u32), f32> {
    let cells = cells.iter().filter(|(cell, _)| cell.1 < 300);
    cells.map(|(cell, count)| (*cell, *count)).collect()
}

/// The wells of a palette with one more before them.
fn one_more(palette: &Surface) -> Vec<Well> {
    let mut mixtures: Vec<Mixture> = ["Cobalt Blue"].map(Mixture::pure).to_vec();
    mixtures.extend(palette.wells.iter().filter_map(|well| match &well.kind {
        WellKind::Paint { mixture } => Some(mixture.clone()),
        _ => None,
    }));
    wells_of(&mixtures, palette.cells, palette.cell_m)
}

#[test]
fn paint_moves_with_its_well_quantum_by_quantum() {
    let (mut painting, palette) = stirred();
    let before = on_palette(&painting);
    let in_well = |cell: &(usize, u32, u32), well: &Well| is_in(cell, well, palette.cell_m);
    let old = &palette.wells[2];
    let heap: Vec<_> = before.keys().filter(|cell| in_well(cell, old)).collect();
    assert!(heap.len() > 500, "{}", heap.len());
    let wells = one_more(&palette);
    let new = &wells[3];
    let steps = painting.history_depth().0;
    let edit = Wells::new(PALETTE, wells.clone()).expect("valid");
    edit.apply(&mut painting).expect("they fit");
    assert_eq!(painting.history_depth().0, steps + 1, "one step");
    let after = on_palette(&painting);
    let way = [0, 1].map(|i| {
        let way = (new.center_m[i] - old.center_m[i]) / palette.cell_m;
        way.round() as i64
    });
    assert!(way[1] < -20, "it moves down: {way:?}");
    for cell in &heap {
        let to = [cell.1, cell.2].map(i64::from);
        let to = (cell.0, (to[0] + way[0]) as u32, (to[1] + way[1]) as u32);
        assert_eq!(after.get(&to), before.get(*cell), "{cell:?}");
    }
    // In the middle of the board nothing has changed, and beside the well lies only what lay beside it before.
    assert!(!board(&before).is_empty() && board(&before) == board(&after));
    let moved: BTreeSet<_> = heap
        .iter()
        .map(|(slot, x, y)| {
            let to = [i64::from(*x) + way[0], i64::from(*y) + way[1]].map(|at| at as u32);
            (*slot, to[0], to[1])
        })
        .collect();
    // A brush renews the edges of wells beside it, too.
    let others = palette.wells[..10].iter().zip(&wells[1..]);
    let others: Vec<_> = others
        .map(|(from, to)| {
            let way = (to.center_m[1] - from.center_m[1]) / palette.cell_m;
            (from, way.round() as i64)
        })
        .collect();
    for (cell, count) in after.iter().filter(|(cell, _)| !moved.contains(*cell)) {
        let stayed = before.get(cell) == Some(count) && !in_well(cell, old);
        let came = others.iter().any(|(well, up)| {
            let from = (cell.0, cell.1, (i64::from(cell.2) - up) as u32);
            before.get(&from) == Some(count) && in_well(&from, well)
        });
        assert!(stayed || came, "{cell:?}");
    }
    assert_eq!(painting.report().quanta_missing, 0);

    Undo { brush: None }.apply(&mut painting).expect("a step");
    assert!(on_palette(&painting) == before);
    assert_eq!(palette_of(&painting).wells, palette.wells);
    assert_eq!(painting.report().quanta_missing, 0);
    Redo { brush: None }.apply(&mut painting).expect("a step");
    assert!(on_palette(&painting) == after);
    assert_eq!(palette_of(&painting).wells, wells);
    assert_eq!(painting.report().quanta_missing, 0);
}

#[test]
fn a_mirrored_palette_has_its_paint_on_the_other_side_and_twice_the_same_bytes() {
    let (mut painting, palette) = stirred();
    let before = on_palette(&painting);
    let mirror = |painting: &mut Painting| {
        let own = palette_of(painting);
        let wells = mirrored(&own.wells, size_m(&own));
        let edit = Wells::new(PALETTE, wells).expect("valid");
        edit.apply(painting).expect("they fit");
        assert_eq!(painting.report().quanta_missing, 0);
    };
    mirror(&mut painting);
    let once = on_palette(&painting);
    let last = palette.cells[0] - 1;
    let expected: BTreeMap<_, _> = before
        .iter()
        .map(|((slot, x, y), count)| ((*slot, last - x, *y), *count))
        .collect();
    assert!(once == expected && once != before);
    mirror(&mut painting);
    assert!(on_palette(&painting) == before);
    for _ in 0..2 {
        Undo { brush: None }.apply(&mut painting).expect("a step");
    }
    assert!(on_palette(&painting) == before);
    assert_eq!(painting.report().quanta_missing, 0);
}

#[test]
fn a_palette_laid_out_before_anything_is_painted_is_no_step() {
    let mut painting = painting(&PaintingSetup::default());
    let palette = palette_of(&painting);
    let wells = mirrored(&palette.wells, size_m(&palette));
    let edit = Wells::new(PALETTE, wells.clone()).expect("valid");
    edit.apply(&mut painting).expect("they fit");
    assert_eq!(painting.history_depth(), (0, 0));
    assert_eq!(palette_of(&painting).wells, wells);
}
