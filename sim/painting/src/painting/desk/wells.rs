//! The wells of a palette: their places and kinds.

use maulstick_types::scene::{Surface, Well, WellKind};

use crate::error::{EditError, SurfaceError};

use super::Desk;

/// Wells may reach beyond the edge of their surface by what rounding makes of it, m.
const EDGE_M: f64 = 1e-6;

impl Desk {
    /// A surface of the scene with other wells, which are checked.
    pub(crate) fn with_wells(&self, on: usize, wells: &[Well]) -> Result<Surface, EditError> {
        let mut changed = self.scene.surfaces[on].clone();
        let size = changed.cells.map(|cells| f64::from(cells) * changed.cell_m);
        changed.wells = wells.to_vec();
        for (place, well) in changed.wells.iter_mut().enumerate() {
            let lies = |i: usize| {
                let [low, high] = [-well.radius_m, well.radius_m].map(|r| well.center_m[i] + r);
                low >= -EDGE_M && high <= size[i] + EDGE_M
            };
            if well.radius_m <= 0.0 || !(lies(0) && lies(1)) {
                return Err(SurfaceError::WellBeside {
                    place: place + 1,
                    surface_mm: size.map(|m| m * 1e3),
                }
                .into());
            }
            if let WellKind::Paint { mixture } = &mut well.kind {
                *mixture = self.optics.library.check(mixture)?;
            }
        }
        Ok(changed)
    }

    /// Gives the paints of the palette's wells slots, as far as there are free ones: conversions may use them.
    pub(crate) fn take_up_wells(&mut self) -> Result<(), EditError> {
        let wells = self.scene.surfaces.iter().flat_map(|own| own.wells.clone());
        for well in wells.collect::<Vec<_>>() {
            if let WellKind::Paint { mixture } = well.kind {
                match self.slots(&mixture) {
                    Ok(_) | Err(EditError::TooManyPaints(_)) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(())
    }
}
