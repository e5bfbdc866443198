//! Paint after a stroke: once the brush is lifted the model lets it relax.
//!
//! It is a part of the stroke, so undo reverts both, and it follows from the journal alone: the same bytes live and
//! offline. Palettes are left out, because their wells are standing heaps.

use maulstick_canvas::quantum::BySlot;
use maulstick_model::interface::Rest;
use maulstick_model::rheology::Setting;
use maulstick_optics::body::PaintBody;
use maulstick_types::paint::TILE;

use super::cells::Cells;
use super::stroke::Stroke;
use crate::painting::bench::Workbench;
use crate::painting::desk::Desk;
use crate::painting::desk::preparation::Preparation;
use crate::painting::optics::thinner_slot;

impl Stroke<'_> {
    /// Makes the model relax the paint within the stroke's reach.
    pub(super) fn relax(&mut self) {
        let model = self.surface().model;
        let halo = self.bench.backend.models.of(model).rest_halo();
        let Some(halo) = halo.filter(|_| !self.has_wells()) else {
            return;
        };
        let Some(reached) = self.reached() else {
            return;
        };
        self.bench.settle();
        // Tiles between those that it reached may be another brush's.
        self.claim(reached);
        // Including the cells that the model reads beside it, independent of the window's earlier extent.
        if !self.open_window(reached.grown(halo as i64)) {
            return;
        }
        let Workbench {
            desk,
            brushes,
            backend,
            ..
        } = &mut *self.bench;
        let Some((_, window)) = &mut brushes[self.brush].window else {
            return;
        };
        let area = window.area(reached.from, reached.to);
        if area.is_empty() {
            return;
        }
        backend.models.of(model).rest(&mut Rest {
            window,
            area,
            cell_m: desk.surfaces[self.surface].cell_m,
            stain: Preparation::of(&desk.scene.surfaces[self.surface]).stain,
            thinner: thinner_slot(&desk.scene),
            settings: settings(desk),
        });
    }

    /// Cells of the tiles that the stroke has reached on the surface.
    fn reached(&mut self) -> Option<Cells> {
        let surface = self.surface().id;
        let name = &self.bench.brushes[self.brush].name;
        let open = self.bench.past.history.open_of(Some(name))?;
        let reached = open.reached.iter().filter(|(on, _)| *on == surface);
        let [low, high] = reached.fold(None, |bounds: Option<[[u32; 2]; 2]>, (_, id)| {
            let [low, high] = bounds.unwrap_or([[u32::MAX; 2], [0; 2]]);
            let low = [low[0].min(id.x), low[1].min(id.y)];
            Some([low, [high[0].max(id.x + 1), high[1].max(id.y + 1)]])
        })?;
        let cells = |tiles: [u32; 2]| tiles.map(|tile| i64::from(tile) * TILE as i64);
        Some(Cells {
            from: cells(low),
            to: cells(high),
        })
    }
}

/// How the paint of each slot sets.
fn settings(desk: &Desk) -> BySlot<Setting> {
    let mut settings = BySlot::default();
    for (setting, slot) in settings.iter_mut().zip(&desk.scene.paints) {
        if let Ok(paint) = desk.optics.library.find(&slot.name) {
            let PaintBody {
                rest_pa,
                recovers_s,
            } = paint.body;
            *setting = Setting {
                rest_pa,
                recovers_s,
            };
        }
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A paint of unknown pigments sets as a slot without a paint does.
    #[test]
    fn usual_paint_is_the_same_for_the_palette_and_for_the_models() {
        let PaintBody {
            rest_pa,
            recovers_s,
        } = PaintBody::of_pigments("");
        let usual = Setting {
            rest_pa,
            recovers_s,
        };
        assert_eq!(usual, Setting::TUBE);
        assert_ne!(
            usual,
            Setting {
                rest_pa: 2.0 * rest_pa,
                ..usual
            }
        );
    }
}
