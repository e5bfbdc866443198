//! Tiles of a stroke: the window that its brush works on, and claims, so that no two open steps of the history change
//! a tile.

use super::cells::Cells;
use super::stroke::Stroke;
use crate::history::OpenStep;

/// A window reaches this many cells beyond the head, so that it is not opened anew at each step.
const WINDOW_MARGIN: i64 = 32;

impl Stroke<'_> {
    /// Begins an undo step of its own for the rest of a stroke whose step a command has ended.
    pub(super) fn resume_undo_step(&mut self) {
        let name = &self.bench.brushes[self.brush].name;
        if self.bench.past.history.open_of(Some(name)).is_none() {
            self.bench.begin_stroke_step(self.brush);
        }
    }

    /// Notes which tiles the brush's step reaches, and ends the open steps of other brushes that have reached one of
    /// them.
    pub(super) fn claim(&mut self, cells: Cells) {
        let (surface, store) = (self.surface().id, &self.surface().store);
        let Some(rect) = store.around(cells.from, cells.to) else {
            return;
        };
        let name = &self.bench.brushes[self.brush].name;
        let Some(open) = self.bench.past.history.open_of(Some(name)) else {
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
        if self.bench.past.history.open().any(shares) {
            self.bench.end_step(shares);
        }
    }

    /// Opens a window of the brush that holds these cells, unless it has one; false if they are all outside the
    /// surface.
    pub(super) fn open_window(&mut self, cells: Cells) -> bool {
        let store = &self.surface().store;
        let Some(needed) = store.around(cells.from, cells.to) else {
            return false;
        };
        if let Some((on, window)) = &self.brush().window
            && *on == self.surface
            && window.rect().holds(&needed)
        {
            return true;
        }
        let wide = cells.grown(WINDOW_MARGIN);
        let rect = store.around(wide.from, wide.to).unwrap_or(needed);
        self.bench.commit();
        if let Some((on, window)) = self.brush_mut().window.take() {
            window.close(&mut self.bench.desk.surfaces[on].store);
        }
        let opened = self.bench.desk.surfaces[self.surface].open_window(rect);
        let opened = opened.or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.bench.close_windows();
            self.bench.desk.surfaces[self.surface].open_window(rect)
        });
        let is_open = opened.is_some();
        self.brush_mut().window = opened.map(|window| (self.surface, window));
        is_open
    }
}
