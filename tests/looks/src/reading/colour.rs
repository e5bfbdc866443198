//! Colour that travels between wet paints.

use maulstick_rig::UserError;

use super::case::{Case, fill_band, line};
use super::{Bound, Found, Readings};
use crate::easel::Easel;
use crate::map::{Frame, Map};
use crate::marks::Painter;

/// Shares of one paint in the film of two, cell by cell, where there is a film.
fn mean_share(own: &Map, other: &Map) -> f64 {
    let (own, other) = (own.mean(), other.mean());
    own / (own + other).max(1e-9)
}

/// Variation across of the share of a paint, waves below 1.5 mm, by the most that it could be.
pub(crate) fn streaks(own: &Map, other: &Map) -> f64 {
    let shares: Vec<f64> = (own.profile(1).iter().zip(other.profile(1)))
        .map(|(own, other)| own / (own + other).max(1e-9))
        .collect();
    let half = ((0.75 / own.cell_mm).round() as usize).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let inner = half..shares.len() - half;
    let count = inner.len() as f64;
    let off = inner.map(|k| shares[k] - mean(&shares[k - half..=k + half]));
    let all = mean(&shares);
    off.map(|off| off * off).sum::<f64>() / count / (all * (1.0 - all)).max(1e-9)
}

/// Slot of a paint of the painting.
fn films(easel: &mut Easel, paints: [&str; 2]) -> Result<[Map; 2], UserError> {
    let mut films = Vec::new();
    for paint in paints {
        let slot = easel.slot(paint)?;
        films.push(easel.film(Some(slot)));
    }
    let [own, other] = [films.remove(0), films.remove(0)];
    Ok([own, other])
}

/// A loaded brush through a wet band of another colour.
pub const CARRY: Readings = Readings {
    read: carry,
    rows: &[
        ("carry.20mm", "", Bound::Least(0.10)),
        ("carry.20mm.most", "", Bound::Most(0.6)),
        ("carry.streaks_10mm", "", Bound::Least(0.03)),
    ],
    shows: |case| case.cell_mm > 0.1 || case.heading_deg == 0.0,
};

/// Half the width of the band, mm.
const BAND_MM: f64 = 13.5;

fn carry(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let [light, dark] = case.paints;
    let (mut easel, frame) = case.easel([48.0, 14.0], "linen", case.brush("flat", 14.0)?)?;
    easel.load(light)?;
    easel.take_up("wide", crate::easel::brush("flat", 14.0)?)?;
    fill_band(&mut easel, frame, dark, [-BAND_MM, BAND_MM], 9.0)?;
    if painter == Painter::Faulty {
        easel.dry()?;
    }
    easel.take_up(crate::easel::BRUSH, case.brush("flat", 14.0)?)?;
    easel.stroke(&line(frame, [-40.0, 0.0], [44.0, 0.0], 0.5))?;
    let [own, other] = films(&mut easel, [dark, light])?;
    let half = 5.0 * case.size;
    let share = |past: f64| {
        let along = [BAND_MM + past - 1.0, BAND_MM + past + 1.0];
        let [own, other] = [&own, &other].map(|map| map.turned(frame, along, [-half, half]));
        (mean_share(&own, &other), streaks(&own, &other))
    };
    let (far, near) = (share(20.0), share(10.0));
    Ok(vec![
        ("carry.20mm", far.0),
        ("carry.20mm.most", far.0),
        ("carry.streaks_10mm", near.1),
    ])
}

/// Two wet colours that meet across the frame's origin: dark behind, light ahead.
fn two_colours(case: Case, reach: f64) -> Result<(Easel, Frame), UserError> {
    let [light, dark] = case.paints;
    let wide = crate::easel::brush("flat", 14.0)?;
    let (mut easel, frame) = case.easel([reach + 6.0, 16.0], "linen", wide)?;
    fill_band(&mut easel, frame, dark, [-reach, 0.0], 10.0)?;
    fill_band(&mut easel, frame, light, [0.0, reach], 10.0)?;
    Ok((easel, frame))
}

/// A clean brush from one wet colour into another.
pub const SMEAR: Readings = Readings {
    read: smear,
    rows: &[
        ("clean_smear", "", Bound::Least(0.10)),
        ("clean_smear.most", "", Bound::Most(0.7)),
    ],
    shows: |case| case.cell_mm > 0.1 || case.heading_deg == 0.0,
};

fn smear(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = two_colours(case, 26.0)?;
    easel.take_up("clean", case.brush("filbert", 10.0)?)?;
    let pressure = match painter {
        Painter::Able => 0.4,
        Painter::Faulty => 0.02,
    };
    easel.stroke(&line(frame, [-13.0, 0.0], [24.0, 0.0], pressure))?;
    let [light, dark] = case.paints;
    let [own, other] = films(&mut easel, [dark, light])?;
    let half = 2.0 * case.size;
    let [own, other] = [own, other].map(|map| map.turned(frame, [9.0, 11.0], [-half, half]));
    let share = mean_share(&own, &other);
    Ok(vec![("clean_smear", share), ("clean_smear.most", share)])
}

/// Ten sweeps of a badger over an edge.
pub const SOFTEN: Readings = Readings {
    read: soften,
    rows: &[
        ("soften_mm", "mm", Bound::Least(6.0)),
        ("soften.lifted", "", Bound::Most(0.1)),
    ],
    shows: |case| case.cell_mm > 0.1 || case.heading_deg == 0.0,
};

fn soften(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let (mut easel, frame) = two_colours(case, 26.0)?;
    let [light, dark] = case.paints;
    let part = ([-20.0, 20.0], [-4.0, 4.0]);
    let before = easel.film(None).turned(frame, part.0, part.1).mean();
    easel.take_up("badger", case.brush("badger", 40.0)?)?;
    let sweeps = match painter {
        Painter::Able => 10,
        Painter::Faulty => 1,
    };
    for sweep in 0..sweeps {
        let ends = if sweep % 2 == 0 {
            [-18.0, 18.0]
        } else {
            [18.0, -18.0]
        };
        easel.stroke(&line(frame, [ends[0], 0.0], [ends[1], 0.0], 0.1))?;
    }
    let after = easel.film(None).turned(frame, part.0, part.1).mean();
    let [own, other] = films(&mut easel, [dark, light])?;
    let [own, other] = [own, other].map(|map| map.turned(frame, part.0, part.1).profile(0));
    let shares: Vec<f64> = (own.iter().zip(&other))
        .map(|(own, other)| own / (own + other))
        .collect();
    let place = |share: f64| shares.iter().rposition(|own| *own >= share).unwrap_or(0) as f64;
    Ok(vec![
        ("soften_mm", (place(0.02) - place(0.36)) * case.cell_mm),
        ("soften.lifted", 1.0 - after / before),
    ])
}
