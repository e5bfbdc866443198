//! Levelling after a stroke: once the brush is lifted the paint levels for a second, as far as its yield stress lets
//! it.
//!
//! It is a part of the stroke, so undo takes both back, and it follows from the journal alone: the same bytes live and
//! offline. Palettes are left out, for their wells are heaps that stand.

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::window::Area;
use maulstick_impasto::stages::advection::{Advection, Axis};
use maulstick_impasto::stages::levelling::{Body, HALO, Levelling, Round};
use maulstick_impasto::stages::velocity::Faces;
use maulstick_types::paint::TILE;

use super::Painting;
use super::brush_modes::Prepared;

/// Duration of the levelling once the brush is lifted, s.
const SECONDS: f64 = 1.0;
/// Rounds in which it does: of ripples six cells long a fifth is left after them.
const ROUNDS: u32 = 64;
/// Of them heights alone go through so many, before their paint follows at once.
const AT_ONCE: u32 = 16;
/// Flow per round below which all rests, as a share of a cell.
const RESTS: f32 = 1e-3;

impl Painting {
    /// Levels the paint that a brush's stroke has reached on a surface.
    pub(super) fn relax(&mut self, name: &str, sheet: usize) {
        if self.has_wells(sheet) {
            return;
        }
        let surface = self.sheets[sheet].id;
        let Some(open) = self.history.open_of(Some(name)) else {
            return;
        };
        let reached = open.reached.iter().filter(|(on, _)| *on == surface);
        let bounds = reached.fold(None, |bounds: Option<[[u32; 2]; 2]>, (_, id)| {
            let [low, high] = bounds.unwrap_or([[u32::MAX; 2], [0; 2]]);
            let low = [low[0].min(id.x), low[1].min(id.y)];
            Some([low, [high[0].max(id.x + 1), high[1].max(id.y + 1)]])
        });
        let Some([low, high]) = bounds else {
            return;
        };
        let cells = |tiles: [u32; 2]| tiles.map(|tile| i64::from(tile) * TILE as i64);
        let (from, to) = (cells(low), cells(high));
        self.settle();
        // With what levelling looks at beside it, whatever the window held before.
        let halo = HALO as i64;
        let (outer_from, outer_to) = (from.map(|cell| cell - halo), to.map(|cell| cell + halo));
        if !self.reach(name, sheet, outer_from, outer_to) {
            return;
        }
        let (thinner, cell_m) = (self.thinner(), self.sheets[sheet].cell_m);
        let mut surfaces = self.scene.surfaces.iter();
        let stain = Prepared::of(surfaces.find(|own| own.id == surface)).stain;
        let Some((_, window)) = self.brushes.get_mut(name).and_then(|t| t.window.as_mut()) else {
            return;
        };
        let area = window.area(from, to);
        if area.is_empty() {
            return;
        }
        let to_cells = (QUANTUM_M / cell_m) as f32;
        let seconds = SECONDS / f64::from(ROUNDS);
        let round = Round::new(Body::TUBE, cell_m, seconds, to_cells, stain);
        let (mut levelling, mut advection) = (Levelling::default(), Advection::default());
        let mut faces = Faces::still(&area);
        for number in 0..ROUNDS / AT_ONCE {
            faces.stop();
            let planes = [&mut faces.right[..], &mut faces.above[..]];
            let most = levelling.add(window, &area, &round, thinner, (AT_ONCE, RESTS), planes);
            if most < RESTS {
                break;
            }
            let first = if number % 2 == 0 { Axis::X } else { Axis::Y };
            faces.limit(area.size[0]);
            advection.run(area, &faces, window, first, stain);
        }
        let Area { from, size } = area;
        window.touch((from, [from[0] + size[0], from[1] + size[1]]));
    }
}
