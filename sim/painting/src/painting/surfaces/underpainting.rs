//! Paint applied cell by cell: an underpainting after a picture.

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::tile::TileId;
use maulstick_types::Mixture;
use maulstick_types::mixture::Part;
use maulstick_types::paint::StepName;
use maulstick_types::scene::Scene;

use crate::ledger::Ledger;
use crate::painting::Painting;
use crate::painting::optics::{Optics, slot_of};

/// State of the paint after it was applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wetness {
    /// The underpainting stays wet.
    Wet,
    /// It dries at once, with all wet paint of the surface.
    Dry {
        /// Name of the layer; a number if it is empty.
        name: String,
    },
}

/// Paint for a tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaidTile {
    /// Tile number.
    pub id: TileId,
    /// Index of a paint, and its quanta in each of the [`TILE_CELLS`](maulstick_canvas::planes::TILE_CELLS) cells, row
    /// by row from the bottom.
    pub planes: Vec<(usize, Vec<u32>)>,
}

impl Painting {
    /// Applies paint to a surface, cell by cell, from the tubes of `paints`: one step that can be undone. Cells beyond
    /// the surface's edge and in wells get none, and the others at most their capacity. If it is to dry, wet paint
    /// dries before it, as a separate layer. Returns the name of its layer, if it dried.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface or paint, or one paint more than there are slots; then nothing is applied.
    pub fn underpaint(
        &mut self,
        surface: u32,
        paints: &[String],
        wetness: &Wetness,
        tiles: impl Iterator<Item = LaidTile>,
    ) -> Result<Option<String>, EditError> {
        let on = self.surfaces.at(surface)?;
        let slots = self.optics.slots_of(&mut self.scene, paints)?;
        let [across, up] = self.surfaces[on].store.grid();
        self.begin_step(StepName::Underpainting, None);
        if matches!(wetness, Wetness::Dry { .. }) {
            // Wet paint dries first, as a separate step: nothing dries on top of wet paint.
            self.dry_in_step(on, 1.0, "");
        }
        for tile in tiles {
            if tile.id.x >= across || tile.id.y >= up {
                continue;
            }
            let mut by_slot: [&[u32]; SLOTS] = [&[]; SLOTS];
            for (paint, plane) in &tile.planes {
                if let Some(slot) = slots.get(*paint) {
                    by_slot[*slot] = plane;
                }
            }
            let quanta = |cell: usize, slot: usize| {
                let count = by_slot[slot].get(cell);
                count.map_or(0.0, |count| *count as f32)
            };
            self.lay_on((on, tile.id), quanta, None, Ledger::from_tube);
        }
        let name = match wetness {
            Wetness::Wet => None,
            Wetness::Dry { name } => self.dry_in_step(on, 1.0, name),
        };
        self.end_own_step();
        // No message describes it.
        self.break_record();
        Ok(name)
    }
}

impl Optics {
    /// The slot of each of `paints`.
    fn slots_of(&mut self, scene: &mut Scene, paints: &[String]) -> Result<Vec<usize>, EditError> {
        if paints.is_empty() {
            return Ok(Vec::new());
        }
        let share = 1.0 / paints.len() as f64;
        let part = |paint: &String| Part {
            paint: paint.clone(),
            share,
        };
        let parts = paints.iter().map(part).collect();
        self.slots(scene, &Mixture { parts })?;
        let slot =
            |paint: &String| slot_of(scene, paint).ok_or_else(|| EditError::NoSlot(paint.clone()));
        paints.iter().map(slot).collect()
    }
}
