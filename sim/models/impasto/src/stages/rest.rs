//! Levelling after a stroke: once the brush is lifted the paint levels for a second, as far as its yield stress allows.

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::window::Area;
use maulstick_model::interface::Rest;

use super::advection::{Advection, Axis};
use super::levelling::{Body, Levelling, Round};
use super::velocity::Faces;

/// Duration of the levelling once the brush is lifted, s.
const SECONDS: f64 = 1.0;
/// Number of rounds: they leave a fifth of ripples six cells long.
const ROUNDS: u32 = 64;
/// Number of rounds of heights alone before their paint follows at once.
const AT_ONCE: u32 = 16;
/// Flow per round below which blocks rest, as a share of a cell.
const RESTS: f32 = 1e-3;

/// Levels the paint of a stroke.
pub fn level(rest: &mut Rest<'_>) {
    let Rest {
        window,
        area,
        cell_m,
        stain,
        thinner,
    } = rest;
    let to_cells = (QUANTUM_M / *cell_m) as f32;
    let seconds = SECONDS / f64::from(ROUNDS);
    let round = Round::new(Body::TUBE, *cell_m, seconds, to_cells, *stain);
    let (mut levelling, mut advection) = (Levelling::default(), Advection::default());
    let mut faces = Faces::still(area);
    for number in 0..ROUNDS / AT_ONCE {
        faces.stop();
        let planes = [&mut faces.right[..], &mut faces.above[..]];
        let most = levelling.add(window, area, &round, *thinner, (AT_ONCE, RESTS), planes);
        if most < RESTS {
            break;
        }
        let first = if number % 2 == 0 { Axis::X } else { Axis::Y };
        faces.limit(area.size[0]);
        advection.run(*area, &faces, window, first, *stain);
    }
    let Area { from, size } = *area;
    window.touch((from, [from[0] + size[0], from[1] + size[1]]));
}
