//! Strokes over wet strokes: what lies on top stays there, until it is worked in.

use maulstick_rig::UserError;

use super::case::{Case, fill_band, line};
use super::{Bound, Found, Readings};
use crate::easel::Easel;
use crate::map::Frame;
use crate::marks::Painter;

/// A loaded stroke over a wet one, and both worked into one.
pub const OVER_WET: Readings = Readings {
    read: over_wet,
    rows: &[
        ("over_wet.own", "", Bound::Least(0.75)),
        ("over_wet.worked", "", Bound::Most(0.6)),
    ],
    shows: |case| case.cell_mm > 0.1 || case.heading_deg == 0.0,
};

/// Mean colour of a part of a frame.
fn colour(easel: &mut Easel, frame: Frame, along: [f64; 2], half: f64) -> [f64; 3] {
    let colours = easel.colours();
    colours.map(|map| map.turned(frame, along, [-half, half]).mean())
}

/// How far a colour is on the way from one to another, 0 to 1.
fn on_the_way(colour: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let off = |of: [f64; 3]| [0, 1, 2].map(|i| of[i] - from[i]);
    dot(off(colour), off(to)) / dot(off(to), off(to)).max(1e-9)
}

/// Share of the upper stroke's own colour over a wet band of another paint, by that over the same band dried: as it is
/// laid with a light touch; and what is left of it once a clean brush has gone over it twelve times.
fn over_wet(case: Case, painter: Painter) -> Result<Vec<Found>, UserError> {
    let [[wet, worked], [dried, _]] = [over(case, painter, false)?, over(case, painter, true)?];
    Ok(vec![
        ("over_wet.own", wet / dried),
        ("over_wet.worked", worked / wet),
    ])
}

/// Share of the upper stroke's own colour as it is laid, and worked, over a band that is dry or wet.
fn over(case: Case, painter: Painter, dry: bool) -> Result<[f64; 2], UserError> {
    let [light, dark] = case.paints;
    let wide = crate::easel::brush("flat", 14.0)?;
    let (mut easel, frame) = case.easel([46.0, 16.0], "linen", wide)?;
    fill_band(&mut easel, frame, dark, [0.0, 26.0], 10.0)?;
    if dry {
        easel.dry()?;
    }
    let under = colour(&mut easel, frame, [6.0, 20.0], 2.0);
    easel.take_up("upper", case.brush("flat", 10.0)?)?;
    easel.load(light)?;
    // From the bare ground onto the wet band.
    easel.stroke(&line(frame, [-40.0, 0.0], [22.0, 0.0], 0.15))?;
    let half = 2.0 * case.size;
    let own = colour(&mut easel, frame, [-20.0, -8.0], half);
    let passes = |easel: &mut Easel, count: usize| -> Result<(), UserError> {
        easel.take_up("clean", case.brush("filbert", 10.0)?)?;
        for pass in 0..count {
            let ends = if pass % 2 == 0 {
                [4.0, 22.0]
            } else {
                [22.0, 4.0]
            };
            easel.stroke(&line(frame, [ends[0], 0.0], [ends[1], 0.0], 0.6))?;
        }
        Ok(())
    };
    if painter == Painter::Faulty {
        passes(&mut easel, 12)?;
    }
    let shown = |easel: &mut Easel| {
        let over = colour(easel, frame, [8.0, 18.0], half);
        on_the_way(over, under, own)
    };
    let laid = shown(&mut easel);
    passes(&mut easel, 12)?;
    Ok([laid, shown(&mut easel)])
}
