//! The wells of a palette: their places and kinds.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_types::paint::StepName;
use maulstick_types::scene::{Well, WellKind};

use crate::error::paint_error;
use crate::painting::Painting;
use crate::painting::surfaces::well_moves::WellMoves;

/// Distance by which wells may exceed the edge of their surface because of rounding, m.
const EDGE_M: f64 = 1e-6;

impl Painting {
    pub(crate) fn set_wells(&mut self, surface: u32, wells: &[Well]) -> Result<(), EditError> {
        let on = self.surfaces.at(surface)?;
        let mut changed = self.scene.surfaces[on].clone();
        let size = changed.cells.map(|cells| f64::from(cells) * changed.cell_m);
        changed.wells = wells.to_vec();
        for (place, well) in changed.wells.iter_mut().enumerate() {
            let lies = |i: usize| {
                let [low, high] = [-well.radius_m, well.radius_m].map(|r| well.center_m[i] + r);
                low >= -EDGE_M && high <= size[i] + EDGE_M
            };
            if well.radius_m <= 0.0 || !(lies(0) && lies(1)) {
                return Err(EditError::WellBeside {
                    place: place + 1,
                    surface_mm: size.map(|m| m * 1e3),
                });
            }
            if let WellKind::Paint { mixture } = &mut well.kind {
                *mixture = self.optics.library.check(mixture).map_err(paint_error)?;
            }
        }
        let before = &self.scene.surfaces[on].wells;
        if changed.wells == *before {
            return Ok(());
        }
        let ways = WellMoves::between((before, &changed.wells), &changed);
        let relief = Some(Arc::clone(&self.surfaces[on].bare.relief));
        let bare = Arc::new(self.optics.blank(&changed, relief)?);
        self.close_windows();
        let moved = self.surfaces[on].with_moved_paint(&ways, &self.surfaces.pager);
        // A palette that is laid out before anything was painted is no step to undo.
        let is_step = !moved.is_empty() || self.history.has_changed_surfaces();
        if !moved.is_empty() {
            self.clock.stop(Some(surface));
        }
        if is_step {
            self.begin_step(StepName::Wells, None);
        }
        self.scene.surfaces[on] = changed;
        self.surfaces[on].bare = bare;
        self.scene.version += 1;
        self.optics.renew(&self.scene);
        if !moved.is_empty() {
            self.put_scraped(on, moved);
        }
        if is_step {
            self.end_own_step();
        }
        Ok(())
    }
}
