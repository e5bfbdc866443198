//! Levelling after a stroke: once the brush is lifted the paint levels and sets, as far as its yield stress lets it; thinned
//! paint flows on.

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::window::Area;
use maulstick_model::interface::Rest;

use super::advection::{Advection, Axis};
use super::levelling::{BLOCK, Body, Levelling, Paints, Round};
use super::velocity::Faces;

/// Time in which paint sets, s.
const SETS_S: f64 = 0.25;
/// Time of each later flow, s, and their number: a film of thinner has run off ridges by then.
const LATER_S: f64 = 1.0;
const LATER: u32 = 17;
/// Number of rounds of heights alone before their paint follows at once.
const ROUNDS: u32 = 16;
/// Flow per round below which blocks rest, as a share of a cell.
const RESTS: f32 = 1e-3;

/// Blocks around those in which paint has moved that may move next.
const AROUND: usize = 1;

/// The blocks of an area where a share of at least `least` of a cell's paint has moved, and those around them; `None`
/// where none has.
fn moving(area: &Area, faces: &Faces, least: f32) -> Option<Area> {
    let width = area.size[0].max(1);
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    let rows = faces
        .right
        .chunks_exact(width)
        .zip(faces.above.chunks_exact(width));
    for (y, (right, above)) in rows.enumerate() {
        let moves = |x: &usize| right[*x].abs() >= least || above[*x].abs() >= least;
        let first = (0..width).find(moves);
        let last = (0..width).rev().find(moves);
        for at in [first, last].into_iter().flatten().map(|x| [x, y]) {
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis] / BLOCK);
                high[axis] = high[axis].max(at[axis] / BLOCK + 1);
            }
        }
    }
    (low[0] <= high[0]).then(|| {
        let from = [0, 1].map(|axis| low[axis].saturating_sub(AROUND) * BLOCK);
        let to = [0, 1].map(|axis| ((high[axis] + AROUND) * BLOCK).min(area.size[axis]));
        Area {
            from: [0, 1].map(|axis| area.from[axis] + from[axis]),
            size: [0, 1].map(|axis| to[axis] - from[axis]),
        }
    })
}

/// Levels the paint of a stroke, later only where it still moves.
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
    let (reached, mut area) = (*area, *area);
    for number in 0..=LATER {
        let from_s = SETS_S * f64::from(number.min(1)) + LATER_S * f64::from(number.max(1) - 1);
        let lasts_s = if number == 0 { SETS_S } else { LATER_S };
        // Rounds of the next flow last longer.
        let least = RESTS * (lasts_s / LATER_S) as f32;
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
        let mut faces = Faces::still(&area);
        let planes = [&mut faces.right[..], &mut faces.above[..]];
        let most = levelling.add(window, &area, &round, &paints, (ROUNDS, RESTS), planes);
        if most < RESTS {
            break;
        }
        let first = if number % 2 == 0 { Axis::X } else { Axis::Y };
        faces.limit(area.size[0]);
        advection.run(area, &faces, window, first, *stain);
        let Some(moves) = moving(&area, &faces, least) else {
            break;
        };
        area = moves;
    }
    let Area { from, size } = reached;
    window.touch((from, [from[0] + size[0], from[1] + size[1]]));
}
