//! Claims of strokes to tiles: no two open steps of the history change one.

use super::cells::Cells;
use super::stroke::Stroke;
use crate::history::OpenStep;

impl Stroke<'_> {
    /// Begins an undo step of its own for the rest of a stroke whose step a command has ended.
    pub(super) fn resume_undo_step(&mut self) {
        let name = &self.painting.brushes[self.brush].name;
        if self.painting.history.open_of(Some(name)).is_none() {
            self.painting.begin_stroke_step(self.brush);
        }
    }

    /// Records the tiles reached by the brush's step, and ends the open steps of other brushes that have reached one of
    /// them.
    pub(super) fn claim(&mut self, cells: Cells) {
        let (surface, store) = (self.surface().id, &self.surface().store);
        let Some(rect) = store.around(cells.from, cells.to) else {
            return;
        };
        let name = &self.painting.brushes[self.brush].name;
        let Some(open) = self.painting.history.open_of(Some(name)) else {
            return;
        };
        if open.last_reach == Some((surface, rect)) {
            return;
        }
        open.last_reach = Some((surface, rect));
        open.reached.extend(rect.tiles().map(|id| (surface, id)));
        let own = open.id;
        let shares = |step: &OpenStep| {
            let mut tiles = rect.tiles();
            step.id != own && tiles.any(|id| step.reached.contains(&(surface, id)))
        };
        if self.painting.history.open().any(shares) {
            self.painting.end_step(shares);
        }
    }
}
