//! Scraping: wet paint goes to the cleaner, dry paint and wells keep theirs.

use maulstick_canvas::EditError;
use maulstick_painting::{Apply as _, PaintingSetup};
use maulstick_types::edits::{Dry, Scrape, Undo, Wells};
use maulstick_types::scene::{CANVAS, PALETTE};

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
    assert_eq!(nothing, Err(EditError::NothingWet(None)));
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

/// Paint stirred in a well would lie as half discs beside the new wells.
#[test]
fn paint_of_wells_that_go_is_scraped_off_alone() {
    let mut painting = painting(&PaintingSetup::default());
    let file = round(10.0, 48);
    painting.define_brush(BRUSH, file.clone());
    painting.apply(load("Bone Black")).expect("known");
    let palette = |painting: &maulstick_painting::Painting| {
        let mut surfaces = painting.scene().surfaces.iter();
        surfaces
            .find(|own| own.id == PALETTE)
            .cloned()
            .expect("a palette")
    };
    let wells = palette(&painting).wells;
    let wet = |painting: &maulstick_painting::Painting| {
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
