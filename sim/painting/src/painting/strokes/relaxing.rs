//! Paint after a stroke: once the brush is lifted the model moves it as it would move by itself.
//!
//! It is a part of the stroke, so undo takes both back, and it follows from the journal alone: the same bytes live and
//! offline. Palettes are left out, for their wells are heaps that stand.

use maulstick_model::interface::Rest;
use maulstick_types::paint::TILE;

use crate::painting::Painting;
use crate::painting::optics::thinner_slot;
use crate::painting::surfaces::preparation::Preparation;

impl Painting {
    /// Has the model move the paint that a brush's stroke has reached on a surface.
    pub(super) fn relax(&mut self, brush: usize, on: usize) {
        let (surface, model) = (self.surfaces[on].id, self.surfaces[on].model);
        let halo = self.backend.models.of(model).rest_halo();
        let Some(halo) = halo.filter(|_| self.scene.surfaces[on].wells.is_empty()) else {
            return;
        };
        let Some(open) = self.history.open_of(Some(&self.brushes[brush].name)) else {
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
        // Tiles between those that it reached may be another brush's.
        self.claim((brush, on), from, to);
        // With what the model looks at beside it, whatever the window held before.
        let halo = halo as i64;
        let (outer_from, outer_to) = (from.map(|cell| cell - halo), to.map(|cell| cell + halo));
        if !self.reach((brush, on), outer_from, outer_to) {
            return;
        }
        let Some((_, window)) = &mut self.brushes[brush].window else {
            return;
        };
        let area = window.area(from, to);
        if area.is_empty() {
            return;
        }
        self.backend.models.of(model).rest(&mut Rest {
            window,
            area,
            cell_m: self.surfaces[on].cell_m,
            stain: Preparation::of(&self.scene.surfaces[on]).stain,
            thinner: thinner_slot(&self.scene),
        });
    }
}
