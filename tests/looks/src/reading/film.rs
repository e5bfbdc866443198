//! Thin films: glazes, and brushes painted out.

use maulstick_rig::UserError;

use super::case::{Case, line};
use super::{Bound, Found, Readings};
use crate::map::Map;
use crate::marks::Painter;

/// A glaze over dried ridges.
pub const GLAZE: Readings = Readings {
    read: glaze,
    rows: &[
        ("glaze_hollows", "", Bound::Least(1.5)),
        ("glaze_hollows.bare", "", Bound::Most(0.02)),
    ],
    shows: |case| case.size > 0.9 && case.cell_mm > 0.1,
};

/// Films below this are bare, µm.
const BARE_UM: f32 = 1.5;

fn glaze(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = case.easel([40.0, 28.0], "linen", case.brush("round", 6.0)?)?;
    for row in 0..12 {
        let across = 3.0 * (f64::from(row) - 5.5);
        easel.load(case.paints[0])?;
        for _ in 0..2 {
            easel.stroke(&line(frame, [-34.0, across], [34.0, across], 0.15))?;
        }
    }
    easel.dry()?;
    easel.take_up("glaze", case.brush("flat", 20.0)?)?;
    let thin = match painter {
        Painter::Able => 0.12,
        Painter::Faulty => 1.0,
    };
    for across in [-14.0, 0.0, 14.0] {
        easel.load(&thinned(case.paints[1], thin))?;
        easel.stroke(&line(frame, [-34.0, across], [34.0, across], 0.4))?;
    }
    let (film, ground) = (easel.film(None), easel.ground());
    let part = ([-18.0, 18.0], [-12.0, 12.0]);
    let [film, ground] = [film, ground].map(|map| map.turned(frame, part.0, part.1));
    let local = less_local_mean(&ground, 3.0);
    let mut order: Vec<usize> = (0..local.len()).collect();
    order.sort_by(|a, b| local[*a].total_cmp(&local[*b]));
    let tenth = order.len() / 10;
    let mean = |part: &[usize]| {
        part.iter().map(|i| f64::from(film.cells[*i])).sum::<f64>() / part.len() as f64
    };
    let (low, high) = (&order[..tenth], &order[order.len() - tenth..]);
    let bare = low.iter().filter(|i| film.cells[**i] < BARE_UM).count();
    Ok(vec![
        ("glaze_hollows", mean(low) / mean(high).max(1e-3)),
        ("glaze_hollows.bare", bare as f64 / tenth as f64),
    ])
}

/// A paint of which `share` is left beside thinner.
fn thinned(paint: &str, share: f64) -> String {
    if share < 1.0 {
        format!("{paint}={share},Thinner={}", 1.0 - share)
    } else {
        paint.to_owned()
    }
}

/// Heights less their mean over a square around each cell.
fn less_local_mean(map: &Map, wide_mm: f64) -> Vec<f32> {
    let half = (0.5 * wide_mm / map.cell_mm) as usize;
    let [width, height] = map.size;
    let mut sums = vec![0.0; (width + 1) * (height + 1)];
    for y in 0..height {
        for x in 0..width {
            let at = (y + 1) * (width + 1) + x + 1;
            sums[at] = f64::from(map.cells[y * width + x]) + sums[at - 1] + sums[at - width - 1]
                - sums[at - width - 2];
        }
    }
    let off = |i: usize| {
        let [x, y] = [i % width, i / width];
        let (left, right) = (x.saturating_sub(half), (x + half + 1).min(width));
        let (low, high) = (y.saturating_sub(half), (y + half + 1).min(height));
        let at = |x: usize, y: usize| sums[y * (width + 1) + x];
        let sum = at(right, high) - at(left, high) - at(right, low) + at(left, low);
        map.cells[i] - (sum / ((right - left) * (high - low)) as f64) as f32
    };
    (0..map.cells.len()).map(off).collect()
}

/// A brush that is painted out on the canvas, then drawn lightly.
pub const DRY_BRUSH: Readings = Readings {
    read: dry_brush,
    rows: &[
        ("painted_out.covered", "", Bound::Most(0.5)),
        ("painted_out.high_by_low", "", Bound::Least(4.0)),
        ("painted_out.film_um", "um", Bound::Least(1.0)),
    ],
    shows: |case| case.cell_mm > 0.1 || case.heading_deg == 0.0,
};

fn dry_brush(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = case.easel([60.0, 34.0], "linen", case.brush("flat", 14.0)?)?;
    easel.load(case.paints[1])?;
    let strokes = match painter {
        Painter::Able => 12,
        Painter::Faulty => 0,
    };
    for stroke in 0..strokes {
        let across = -30.0 + 8.0 * f64::from(stroke % 4);
        easel.stroke(&line(frame, [-50.0, across], [50.0, across], 0.5))?;
    }
    easel.stroke(&line(frame, [-50.0, 22.0], [50.0, 22.0], 0.05))?;
    let half = 4.0 * case.size;
    let part = ([-35.0, 35.0], [22.0 - half, 22.0 + half]);
    let [film, ground] =
        [easel.film(None), easel.ground()].map(|map| map.turned(frame, part.0, part.1));
    let [all, _, _, ratio] = crate::marks::by_height(&film, &ground);
    Ok(vec![
        ("painted_out.covered", all),
        ("painted_out.high_by_low", ratio),
        ("painted_out.film_um", film.mean()),
    ])
}
