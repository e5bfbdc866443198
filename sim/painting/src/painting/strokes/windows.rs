//! Windows: the tiles that brushes work on.

use super::cells::Cells;
use super::stroke::Stroke;
use crate::painting::Painting;

/// Number of cells of a window beyond the head, so that it is not reopened at each step.
const WINDOW_MARGIN: i64 = 32;

impl Stroke<'_> {
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
        self.painting.commit();
        if let Some((on, window)) = self.brush_mut().window.take() {
            window.close(&mut self.painting.surfaces[on].store);
        }
        let opened = self.painting.surfaces[self.surface].open_window(rect);
        let opened = opened.or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.painting.close_windows();
            self.painting.surfaces[self.surface].open_window(rect)
        });
        let is_open = opened.is_some();
        self.brush_mut().window = opened.map(|window| (self.surface, window));
        is_open
    }
}

impl Painting {
    /// Writes what the windows hold back to the tiles.
    pub fn commit(&mut self) {
        self.settle();
        for brush in self.brushes.iter_mut() {
            if let Some((on, window)) = &mut brush.window {
                self.surfaces.commit(*on, window, |place, before| {
                    self.history.replaced(Some(&brush.name), place, before);
                });
            }
        }
    }

    pub(crate) fn close_windows(&mut self) {
        self.commit();
        for brush in self.brushes.iter_mut() {
            if let Some((on, window)) = brush.window.take() {
                window.close(&mut self.surfaces[on].store);
            }
        }
    }
}
