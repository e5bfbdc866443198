//! Levelling after a stroke: once the brush is lifted the paint levels and sets, as far as its yield stress lets it; thinned
//! paint flows on.

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::window::Area;
use maulstick_model::interface::Rest;

use super::advection::{Advection, Axis};
use super::levelling::{Body, Levelling, Paints, Round};
use super::velocity::Faces;

/// Times of the flows after each other, s: that in which paint sets, and later ones, in each of which about as much goes
/// as in the one before. A film of thinner has run off ridges by then.
const FLOWS_S: [f64; 6] = [0.25, 1.0, 1.0, 2.0, 4.0, 9.0];
/// Number of rounds of heights alone before their paint follows at once.
const ROUNDS: u32 = 16;
/// Flow per round of a flow of up to a second below which blocks rest, cells; in longer ones more by as much.
const RESTS: f32 = 1e-3;

/// Levels the paint of a stroke.
pub fn level(rest: &mut Rest<'_>) {
    let Rest {
        window,
        area,
        cell_m,
        stain,
        thinner,
        settings,
    } = rest;
    let to_cells = (QUANTUM_M / *cell_m) as f32;
    let (mut levelling, mut advection) = (Levelling::default(), Advection::default());
    let mut faces = Faces::still(area);
    let mut from_s = 0.0;
    for (number, lasts_s) in FLOWS_S.into_iter().enumerate() {
        let round = Round::new(
            Body::TUBE,
            *cell_m,
            lasts_s / f64::from(ROUNDS),
            to_cells,
            *stain,
        );
        let yield_pa = |slot: usize| settings[slot].mean_pa(from_s, from_s + lasts_s);
        let yields = std::array::from_fn(|slot| (yield_pa(slot) / Body::TUBE.yield_pa) as f32);
        let paints = Paints {
            thinner: *thinner,
            yields,
        };
        faces.stop();
        let planes = [&mut faces.right[..], &mut faces.above[..]];
        let rests = RESTS * lasts_s.max(1.0) as f32;
        let most = levelling.add(window, area, &round, &paints, (ROUNDS, rests), planes);
        if most < rests {
            break;
        }
        let first = if number % 2 == 0 { Axis::X } else { Axis::Y };
        faces.limit(area.size[0]);
        advection.run(*area, &faces, window, first, *stain);
        from_s += lasts_s;
    }
    let Area { from, size } = *area;
    window.touch((from, [from[0] + size[0], from[1] + size[1]]));
}
