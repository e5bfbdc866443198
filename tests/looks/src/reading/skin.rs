//! Relief of bristles, ends, edges, and lattices.

use maulstick_rig::UserError;

use super::case::{Case, line};
use super::spectrum::{band_rms, peak};
use super::{Bound, Found, Readings};
use crate::easel::Easel;
use crate::map::{Frame, Map, correlation};
use crate::marks::{Painter, rough};

const PAINT: &str = "Ultramarine Blue=0.6,Titanium White=0.4";
/// A film counts as paint from here on, µm.
const COVERED_UM: f64 = 10.0;

/// Six loads of one brush, each as a step of a script.
pub const VARIETY: Readings = Readings {
    read: variety,
    rows: &[("variety.most", "", Bound::Most(0.6))],
    shows: |case| case.cell_mm > 0.1,
};

fn variety(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = case.easel([25.0, 75.0], "linen", case.brush("flat", 14.0)?)?;
    let half = 7.0 * case.size;
    let mut profiles = Vec::new();
    for stroke in 0..6 {
        if painter == Painter::Faulty {
            (easel, _) = case.easel([25.0, 75.0], "linen", case.brush("flat", 14.0)?)?;
        }
        let across = 24.0 * (f64::from(stroke) - 2.5);
        easel.script_stroke(PAINT, &line(frame, [-20.0, across], [20.0, across], 0.5))?;
        let film = easel.film(None);
        let part = film.turned(
            frame,
            [-6.0, 12.0],
            [across - half + 2.0, across + half - 2.0],
        );
        profiles.push(part.profile(1));
    }
    let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    let alike = pairs.map(|(i, j)| correlation(&profiles[i], &profiles[j]));
    Ok(vec![("variety.most", alike.fold(-1.0, f64::max))])
}

/// Ridges of single bristles, and smoothness along them.
pub const BRISTLES: Readings = Readings {
    read: bristles,
    rows: &[
        ("bristle_band_um", "um", Bound::Least(4.0)),
        ("bristle_band.along_um", "um", Bound::Most(8.0)),
        ("persist_80", "", Bound::Most(0.4)),
        ("bead", "", Bound::Least(1.3)),
        ("bead.most", "", Bound::Most(2.5)),
    ],
    shows: |case| case.cell_mm < 0.1,
};

/// One long stroke of a full 14 mm flat on a smooth panel.
fn long_stroke(case: Case, painter: Painter) -> Result<(Easel, Frame), UserError> {
    let flat = case.brush("flat", 14.0)?;
    let (mut easel, frame) = case.easel([66.0, 10.0], "panel", flat)?;
    easel.load(match painter {
        Painter::Able => PAINT,
        Painter::Faulty => "Ultramarine Blue=0.3,Titanium White=0.2,Thinner=0.5",
    })?;
    easel.stroke(&line(frame, [-60.0, 0.0], [60.0, 0.0], 0.5))?;
    Ok((easel, frame))
}

fn bristles(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = long_stroke(case, painter)?;
    let half = 7.0 * case.size;
    let (film, ground) = (easel.film(None), easel.ground());
    let inner = [-half + 1.5, half - 1.5];
    let surface = film.plus(&ground).turned(frame, [-50.0, -20.0], inner);
    let profile = |at: f64| film.turned(frame, [at - 1.0, at + 1.0], inner).profile(1);
    let across = film
        .turned(frame, [-45.0, -25.0], [-half - 2.0, half + 2.0])
        .profile(1);
    let cell = |mm: f64| ((mm + half + 2.0) / case.cell_mm) as usize;
    let middle = &across[cell(-0.5 * half)..cell(0.5 * half)];
    let middle = middle.iter().sum::<f64>() / middle.len() as f64;
    // The ridge is a quarter of a millimetre wide at least.
    let wide = (0.25 / case.cell_mm) as usize;
    let ridge = |part: &[f64]| {
        let runs = part
            .windows(wide)
            .map(|run| run.iter().sum::<f64>() / wide as f64);
        runs.fold(0.0, f64::max)
    };
    let edges = [
        ridge(&across[..cell(-half + 2.0)]),
        ridge(&across[cell(half - 2.0)..]),
    ];
    Ok(vec![
        ("bristle_band_um", band_rms(&surface, 1, [0.25, 0.5])),
        ("bristle_band.along_um", rough(&surface, 0)),
        ("persist_80", correlation(&profile(-40.0), &profile(40.0))),
        ("bead", edges[0].min(edges[1]) / middle),
        ("bead.most", edges[0].max(edges[1]) / middle),
    ])
}

/// Outline of a long stroke.
pub const OUTLINE: Readings = Readings {
    read: outline,
    rows: &[
        ("ends_mm", "mm", Bound::Least(0.4)),
        ("edge_mm", "mm", Bound::Least(0.1)),
        ("edge.most_mm", "mm", Bound::Most(0.6)),
    ],
    shows: |_| true,
};

fn outline(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = match painter {
        Painter::Able => long_stroke(case, painter)?,
        Painter::Faulty => return Ok(ruled(case)),
    };
    let half = 7.0 * case.size;
    Ok(outline_of(
        &easel
            .film(None)
            .turned(frame, [-66.0, 66.0], [-half - 3.0, half + 3.0]),
        half,
    ))
}

/// A stroke with the outline of tape.
fn ruled(case: Case) -> Vec<Found> {
    let half = 7.0 * case.size;
    let size = [132.0, 2.0 * half + 6.0].map(|mm| (mm / case.cell_mm) as usize);
    let mut map = Map {
        size,
        cell_mm: case.cell_mm,
        cells: vec![0.0; size[0] * size[1]],
    };
    let inside = |i: usize, n: usize, margin: f64| {
        let at = (i as f64 + 0.5) * case.cell_mm;
        at > margin && at < n as f64 * case.cell_mm - margin
    };
    for (i, cell) in map.cells.iter_mut().enumerate() {
        let [x, y] = [i % size[0], i / size[0]];
        if inside(x, size[0], 6.0) && inside(y, size[1], 3.0) {
            *cell = 200.0;
        }
    }
    outline_of(&map, half)
}

/// Unevenness of the two ends and of the two sides of a stroke that lies along a map's rows.
fn outline_of(map: &Map, half: f64) -> Vec<Found> {
    let [width, height] = map.size;
    let is_paint = |x: usize, y: usize| f64::from(map.cells[y * width + x]) > COVERED_UM;
    let rows = |y: f64| ((y + 0.5 * height as f64 * map.cell_mm) / map.cell_mm) as usize;
    let across = rows(-half + 1.0)..rows(half - 1.0);
    let ends = [
        uneven(
            across
                .clone()
                .filter_map(|y| (0..width).find(|x| is_paint(*x, y))),
            map,
            None,
        ),
        uneven(
            across.filter_map(|y| (0..width).rev().find(|x| is_paint(*x, y))),
            map,
            None,
        ),
    ];
    let along = (width / 4)..(width * 3 / 4);
    let trend = Some((8.0 / map.cell_mm) as usize);
    let sides = [
        uneven(
            along
                .clone()
                .filter_map(|x| (0..height).find(|y| is_paint(x, *y))),
            map,
            trend,
        ),
        uneven(
            along.filter_map(|x| (0..height).rev().find(|y| is_paint(x, *y))),
            map,
            trend,
        ),
    ];
    vec![
        ("ends_mm", ends[0].min(ends[1])),
        ("edge_mm", sides[0].min(sides[1])),
        ("edge.most_mm", sides[0].max(sides[1])),
    ]
}

/// Standard deviation of places in cells, mm: about their mean, or about a running mean of so many.
fn uneven(places: impl Iterator<Item = usize>, map: &Map, trend: Option<usize>) -> f64 {
    let places: Vec<f64> = places.map(|place| place as f64).collect();
    if places.is_empty() {
        return 0.0;
    }
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let off = |i: usize| {
        let part = match trend {
            Some(wide) => {
                let half = (wide / 2).min(i).min(places.len() - 1 - i);
                &places[i - half..=i + half]
            }
            None => &places[..],
        };
        places[i] - mean(part)
    };
    let squares = (0..places.len()).map(|i| off(i) * off(i)).sum::<f64>();
    (squares / places.len() as f64).sqrt() * map.cell_mm
}

/// What repeats at the pitch of the cells or of the weave.
pub const LATTICE: Readings = Readings {
    read: lattice,
    rows: &[
        ("lattice.weave", "", Bound::Most(1.5)),
        ("lattice.cell", "", Bound::Most(1.5)),
    ],
    shows: |case| case.size > 0.9,
};

/// Pitch of the threads of linen, mm.
const WEAVE_MM: f64 = 0.9;

fn lattice(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = case.easel([45.0, 10.0], "linen", case.brush("flat", 14.0)?)?;
    easel.load(PAINT)?;
    easel.stroke(&line(frame, [-40.0, 0.0], [40.0, 0.0], 0.5))?;
    let (mut film, ground) = (easel.film(None), easel.ground());
    if painter == Painter::Faulty {
        let width = film.size[0];
        for (i, cell) in film.cells.iter_mut().enumerate() {
            *cell += if (i / width + i % width) % 2 == 0 {
                4.0
            } else {
                -4.0
            };
            let at = (i % width) as f64 * case.cell_mm;
            *cell += 20.0 * maulstick_num::sin(std::f64::consts::TAU * at / WEAVE_MM) as f32;
        }
    }
    let [x, y] = frame.middle;
    // The largest square in the stroke along the cells, as the lattice lies.
    let turned = case.heading_deg.to_radians();
    let side = 10.0 / (maulstick_num::sin(turned).abs() + maulstick_num::cos(turned).abs());
    let reach = if case.heading_deg % 90.0 == 0.0 {
        30.0
    } else {
        0.5 * side
    };
    let reach = match case.heading_deg {
        90.0 => [0.5 * side, reach],
        _ => [reach, 0.5 * side],
    };
    let corners = [[x - reach[0], y - reach[1]], [x + reach[0], y + reach[1]]];
    let surface = film.plus(&ground).cut(corners[0], corners[1]);
    let film = film.cut(corners[0], corners[1]);
    let worst = |wave: f64| {
        let maps = [&surface, &film].into_iter();
        let found = maps.flat_map(|map| [0, 1].map(|axis| peak(map, axis, wave)));
        found.fold(0.0, f64::max)
    };
    Ok(vec![
        ("lattice.weave", worst(WEAVE_MM)),
        ("lattice.cell", worst(2.0 * case.cell_mm)),
    ])
}
