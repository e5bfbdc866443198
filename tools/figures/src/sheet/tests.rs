//! Measured appearance of a brush's marks.

use maulstick_appearance::picture::Picture;
use maulstick_optics::PaintLibrary;

use super::marks::stroke;
use super::*;

const SIZE_MM: [f64; 2] = [90.0, 50.0];
/// Side of a cell, and of a pixel, mm.
const CELL_MM: f64 = 0.25;

fn paints() -> PaintLibrary {
    PaintLibrary::measured().expect("whole")
}

/// One stroke of a brush from left to right, its broad side across, with this pressure.
fn one(kind: &str, pressure: impl Fn(f64) -> f64 + 'static) -> Picture {
    let file = library_brush(kind).expect(kind);
    let mut panel =
        Panel::new((SIZE_MM, Board::new(CELL_MM)), "gesso", file, paints()).expect("a panel");
    panel.load(BRUSH, "Ultramarine Blue").expect("loaded");
    let way = vec![[12.0, 25.0], [76.0, 25.0]];
    panel
        .paint(&stroke(way, 1.6, 90.0, pressure))
        .expect("painted");
    panel.picture()
}

/// True for each painted pixel of a column, from the top.
fn column(picture: &Picture, x: usize) -> Vec<bool> {
    (0..picture.height)
        .map(|y| {
            let at = 3 * (y * picture.width + x);
            let [r, g, b] = [0, 1, 2].map(|i| i32::from(picture.rgb[at + i]));
            r.max(g).max(b) - r.min(g).min(b) > 60
        })
        .collect()
}

fn painted(picture: &Picture, x: usize) -> usize {
    column(picture, x).into_iter().filter(|p| *p).count()
}

/// From the first painted pixel of a column to the last.
fn span(picture: &Picture, x: usize) -> usize {
    let column = column(picture, x);
    let first = column.iter().position(|p| *p);
    let last = column.iter().rposition(|p| *p);
    first.zip(last).map_or(0, |(first, last)| last - first + 1)
}

/// Runs of painted pixels in a column with at least a millimetre between them.
fn lines(picture: &Picture, x: usize) -> usize {
    let (mut lines, mut bare) = (0, usize::MAX);
    for painted in column(picture, x) {
        if painted {
            lines += usize::from(bare >= 4);
            bare = 0;
        } else {
            bare = bare.saturating_add(1);
        }
    }
    lines
}

/// The leftmost painted column.
fn start(picture: &Picture) -> usize {
    (0..picture.width)
        .find(|x| painted(picture, *x) > 1)
        .expect("a mark")
}

#[test]
fn a_fan_makes_separated_lines_and_a_flat_does_not() {
    let light = |t: f64| 0.02 + 0.2 * gesture::swell(t, 0.1);
    let (fan, flat) = (one("fan", light), one("flat", light));
    let most = |picture: &Picture| (140..260).map(|x| lines(picture, x)).max().unwrap_or(0);
    assert!(most(&fan) >= 5, "{}", most(&fan));
    assert!(most(&flat) <= 2, "{}", most(&flat));
}

#[test]
fn a_filbert_begins_round_and_a_flat_with_its_edge() {
    let at_once = |t: f64| 0.3 * gesture::swell(t, 0.08).max(0.1);
    let share = |kind: &str| {
        let picture = one(kind, at_once);
        let x = start(&picture) + 4;
        span(&picture, x) as f64 / span(&picture, 180) as f64
    };
    let (filbert, flat) = (share("filbert"), share("flat"));
    assert!(flat > 0.8, "{flat}");
    assert!(filbert < flat - 0.15, "{filbert} {flat}");
}

#[test]
fn a_fude_goes_from_hairline_to_broad_in_one_stroke() {
    let picture = one("fude", |t| 0.01 + 0.85 * gesture::ease(1.2 * t - 0.2));
    let thin = (start(&picture) + 6..start(&picture) + 30)
        .map(|x| span(&picture, x))
        .max()
        .unwrap_or(0);
    let broad = (0..picture.width)
        .map(|x| span(&picture, x))
        .max()
        .unwrap_or(0);
    assert!(
        (1..=7).contains(&thin),
        "{thin} pixels of a quarter millimetre"
    );
    assert!(broad > 5 * thin, "{thin} {broad}");
}

#[test]
fn a_badger_softens_the_edge_between_two_wet_colours() {
    let file = library_brush("badger").expect("badger");
    let picture = softening_panel(&file, paints(), CELL_MM).expect("a panel");
    // The steepest change of blueness down the columns of a side, over half a millimetre.
    let steepest = |columns: std::ops::Range<usize>| {
        let mean = |y: usize| {
            let of = |x: usize| {
                let at = 3 * (y * picture.width + x);
                f64::from(picture.rgb[at + 2]) - f64::from(picture.rgb[at])
            };
            columns.clone().map(of).sum::<f64>() / columns.len() as f64
        };
        let middle = picture.height / 2;
        (middle - 24..middle + 24)
            .map(|y| (mean(y + 2) - mean(y)).abs())
            .fold(0.0, f64::max)
    };
    let (laid, softened) = (steepest(250..420), steepest(600..800));
    assert!(softened < 0.75 * laid, "{laid} {softened}");
    assert!(laid > 20.0, "there was an edge: {laid}");
}

#[test]
fn a_double_loaded_brush_paints_two_colours_side_by_side() {
    let file = library_brush("flat").expect("flat");
    let mut panel =
        Panel::new((SIZE_MM, Board::new(CELL_MM)), "grey", file, paints()).expect("a panel");
    panel
        .load_beside(BRUSH, "Pyrrole Red", Some("Titanium White"))
        .expect("loaded");
    let way = vec![[12.0, 25.0], [76.0, 25.0]];
    let gesture = stroke(way, 1.6, 90.0, |t| 0.3 * gesture::swell(t, 0.1));
    panel.paint(&gesture).expect("painted");
    assert_eq!(panel.offline.painting_mut().report().quanta_missing, 0);
    let picture = panel.picture();
    // The mean of a part of the stroke: single pixels lie in the shadow of a ridge.
    let colour = |y: usize| {
        let rows = y - 12..y + 12;
        let part = rows.flat_map(|y| (100..260).map(move |x| 3 * (y * picture.width + x)));
        let mean = |i: usize| {
            let of = part.clone().map(|at| i32::from(picture.rgb[at + i]));
            of.sum::<i32>() / part.clone().count() as i32
        };
        [0, 1, 2].map(mean)
    };
    let saturation = |y: usize| {
        let [r, g, b] = colour(y);
        r.max(g).max(b) - r.min(g).min(b)
    };
    let (above, below) = (saturation(80), saturation(120));
    assert!(
        (above - below).abs() > 80,
        "{:?} {:?}",
        colour(80),
        colour(120)
    );
}
