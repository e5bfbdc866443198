//! Windows: the tiles that brushes work on.

use crate::painting::Painting;

/// A window reaches this many cells beyond the head, so that it is not opened anew at each step.
const WINDOW_MARGIN: i64 = 32;

impl Painting {
    /// Makes sure that the brush's window on a surface holds the cells `from`..`to`; false if they are all outside the
    /// surface.
    pub(super) fn reach(
        &mut self,
        (brush, on): (usize, usize),
        from: [i64; 2],
        to: [i64; 2],
    ) -> bool {
        let store = &self.surfaces[on].store;
        let Some(needed) = store.around(from, to) else {
            return false;
        };
        if let Some((at, window)) = &self.brushes[brush].window
            && *at == on
            && window.rect().holds(&needed)
        {
            return true;
        }
        let wide = |edge: [i64; 2], by: i64| edge.map(|cell| cell + by);
        let rect = store
            .around(wide(from, -WINDOW_MARGIN), wide(to, WINDOW_MARGIN))
            .unwrap_or(needed);
        self.commit();
        if let Some((at, window)) = self.brushes[brush].window.take() {
            window.close(&mut self.surfaces[at].store);
        }
        let window = self.surfaces[on].open_window(rect).or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.close_windows();
            self.surfaces[on].open_window(rect)
        });
        let opened = window.is_some();
        self.brushes[brush].window = window.map(|window| (on, window));
        opened
    }

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
