//! Oil's numbers, each with a painter who misses it.

use std::ops::RangeInclusive;

use super::marks::{self, Measure, Painter, Trial};
use super::reading::{self, Bound, Readings, case::CASES};

const ANY: f64 = f64::INFINITY;

/// Ranges that an able painter reaches, and a faulty one misses.
fn holds(measure: Measure, wants: &[(&str, RangeInclusive<f64>)]) {
    let numbers = |painter| {
        let cell_mm = 0.125;
        measure(Trial { cell_mm, painter }).expect("painted")
    };
    let (able, faulty) = (numbers(Painter::Able), numbers(Painter::Faulty));
    for (name, want) in wants {
        let of = |numbers: &[marks::Number]| {
            let found = numbers.iter().find(|(own, ..)| own == name);
            found.expect("measured").1
        };
        let (able, faulty) = (of(&able), of(&faulty));
        println!("{name}: {able:.4}, of the fault {faulty:.4}, wanted {want:?}");
        assert!(want.contains(&able), "{name}: {able}");
        assert!(
            !want.contains(&faulty),
            "{name}: a fault of {faulty} passes"
        );
    }
}

#[test]
fn a_stroke_lays_films_of_oil_that_fill_the_tooth() {
    holds(
        marks::long_strokes,
        &[
            ("film_um.10mm", 150.0..=400.0),
            ("film_um.150mm", 60.0..=ANY),
            ("tooth_fill", -1.0..=-0.6),
            ("tooth_fill.in_rows", -1.0..=-0.5),
            ("ridges", 3.0..=ANY),
        ],
    );
}

#[test]
fn six_loads_pile_up_without_towers() {
    holds(marks::six_loads, &[("six_loads_um", 800.0..=ANY)]);
}

#[test]
fn three_strokes_use_a_quarter_of_a_load() {
    holds(marks::three_strokes, &[("load_used_share", 0.25..=1.0)]);
}

#[test]
fn a_dry_brush_catches_on_the_tooth() {
    holds(
        marks::dry_brush,
        &[
            ("dry_brush.covered", 0.05..=0.5),
            ("dry_brush.high_by_low", 4.0..=ANY),
        ],
    );
}

#[test]
fn a_scumble_catches_on_ridges() {
    holds(
        marks::scumble,
        &[
            ("scumble.covered_low", 0.0..=0.2),
            ("scumble.high_by_low", 4.0..=ANY),
        ],
    );
}

#[test]
fn a_knife_leaves_a_thin_smooth_film_and_a_bead() {
    holds(marks::knife, &[("knife_left_um", 0.0..=80.0)]);
}

#[test]
fn loads_of_their_own_have_streaks_of_their_own() {
    holds(
        marks::separate_loads,
        &[("streaks.correlation", -1.0..=0.8)],
    );
}

#[test]
fn white_through_wet_blue_keeps_its_streaks() {
    holds(marks::through_wet, &[("through_wet.streaks", 0.03..=1.0)]);
}

#[test]
fn paints_dry_to_glosses_of_their_own() {
    holds(marks::glosses, &[("gloss_span", 0.02..=ANY)]);
}

/// The worst that a painter shows of each row in the first case that shows it, with its bound.
fn read(own: &Readings, painter: Painter) -> Vec<(&'static str, f64, Bound)> {
    let case = CASES.iter().find(|case| (own.shows)(case)).expect("a case");
    let found = (own.read)(*case, painter).expect("painted");
    let rows = found.into_iter().map(|(name, value)| {
        let row = own.rows.iter().find(|(row, ..)| *row == name);
        (name, value, row.expect("bounded").2)
    });
    rows.collect()
}

#[test]
fn each_row_of_reading_distance_has_a_fault_that_breaks_it() {
    for own in reading::ALL {
        let faulty = read(own, Painter::Faulty);
        println!("{faulty:?}");
        let is_told = faulty.iter().any(|(_, value, bound)| !bound.keeps(*value));
        assert!(is_told, "a fault passes: {faulty:?}");
    }
}

/// Each step of a script has streaks of its own; the first strokes of two paintings have the same.
#[test]
fn strokes_of_a_script_are_not_alike() {
    let likest = |painter| read(&reading::skin::VARIETY, painter)[0].1;
    let (able, faulty) = (likest(Painter::Able), likest(Painter::Faulty));
    println!("likest of six {able:.3}, of six first strokes {faulty:.3}");
    assert!(able < 0.9 && faulty > 0.95, "{able} {faulty}");
}

/// The track of a knife is smooth; ripples of half a millimetre would be detected.
#[test]
fn a_knife_leaves_no_ripples() {
    let able = Trial {
        cell_mm: 0.125,
        painter: Painter::Able,
    };
    let film = marks::knife(able).expect("painted");
    let rough = film.iter().find(|(name, ..)| *name == "knife_rough_um");
    let rough = rough.expect("measured").1;
    assert!(rough <= 15.0, "{rough}");
    let mut map = crate::map::Map::level([100, 100], 0.125, 50.0);
    assert!(marks::rough(&map, 0) < 1.0);
    for (cell, height) in map.cells.iter_mut().enumerate() {
        *height += if cell % 4 < 2 { 20.0 } else { -20.0 };
    }
    assert!(marks::rough(&map, 0) > 15.0);
}

/// Wet paint has no towers of a cell and is smooth along a stroke; either would be found.
#[test]
fn wet_paint_is_smooth_along_a_stroke() {
    let able = Trial {
        cell_mm: 0.125,
        painter: Painter::Able,
    };
    let stroke = marks::long_strokes(able).expect("painted");
    let number = |name| {
        stroke
            .iter()
            .find(|(own, ..)| *own == name)
            .expect("measured")
            .1
    };
    let (towers, along) = (number("towers_um"), number("rough_um.along"));
    assert!(towers <= 60.0, "{towers}");
    assert!(along <= 8.0, "{along}");
    let mut map = crate::map::Map::level([100, 100], 0.125, 300.0);
    assert!(marks::towers(&map) < 1.0);
    for k in 0..20 {
        map.cells[517 + 411 * k] += 500.0;
    }
    assert!(marks::towers(&map) > 60.0);
    assert!(marks::rough(&map, 0) > 8.0);
}

/// Strokes that leave the canvas leave no strip along its edge; one along the edge does.
#[test]
fn strokes_past_the_border_leave_no_strip() {
    use crate::easel::{Easel, Stroke, brush};
    let across = [Stroke::along(20.0, 20.0, 75.0, 0.5); 3];
    let along = Stroke {
        from: [58.0, 8.0],
        to: [58.0, 32.0],
        ..across[0]
    };
    let edge = |strokes: &[Stroke]| {
        let flat = brush("flat", 14.0).expect("flat");
        let mut easel = Easel::new([60.0, 40.0], 0.125, "linen", flat).expect("easel");
        for stroke in strokes {
            easel.load("Titanium White").expect("loaded");
            easel.stroke(stroke).expect("painted");
        }
        let film = easel.film(None);
        let mean = |from: f64, to: f64| film.cut([from, 16.0], [to, 24.0]).mean();
        mean(59.0, 60.0) / mean(45.0, 50.0)
    };
    let past = edge(&across);
    let along = edge(&[&across[..], &[along]].concat());
    println!("{past:.2} past, {along:.2} along the border");
    assert!(past < 1.1 && along > 1.1, "{past} {along}");
}

/// A stroke across a band of dry paint covers the ground on both sides of it, too.
#[test]
fn a_stroke_comes_down_beside_dry_paint() {
    use crate::easel::{Easel, Stroke, brush};
    let flat = brush("flat", 14.0).expect("flat");
    let mut easel = Easel::new([60.0, 40.0], 0.125, "panel", flat).expect("easel");
    let band = Stroke {
        from: [30.0, -6.0],
        to: [30.0, 46.0],
        ..Stroke::along(20.0, 0.0, 0.0, 0.2)
    };
    for _ in 0..4 {
        easel.load("Titanium White").expect("loaded");
        easel.stroke(&band).expect("painted");
    }
    easel.dry().expect("dried");
    let ridge = easel.ground().cut([28.0, 16.0], [32.0, 24.0]).mean();
    easel.load("Ultramarine Blue").expect("loaded");
    easel
        .stroke(&Stroke::along(20.0, 10.0, 50.0, 0.3))
        .expect("painted");
    let film = easel.film(None);
    let covered = (15..45).map(|mm| {
        let at = f64::from(mm);
        let cells = film.cut([at, 17.0], [at + 1.0, 23.0]).cells;
        let count = cells.iter().filter(|um| **um > 3.0).count();
        count as f64 / cells.len() as f64
    });
    let least = covered.fold(1.0, f64::min);
    println!("{ridge:.0} µm high, {least:.2} covered");
    assert!(ridge > 400.0 && least > 0.7, "{ridge} {least}");
}
