//! Paint applied cell by cell: an underpainting after a picture.

use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::tile::TileId;
use maulstick_types::Mixture;
use maulstick_types::mixture::Part;

use super::Painting;
use crate::ledger::Ledger;

/// State of the paint after it was applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wetness {
    /// It stays wet.
    Wet,
    /// It dries at once, with all that is wet on the surface.
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
    /// Number of a paint, and its quanta in each of the [`TILE_CELLS`](maulstick_canvas::planes::TILE_CELLS) cells,
    /// row after row from the bottom.
    pub planes: Vec<(usize, Vec<u32>)>,
}

impl Painting {
    /// Takes a picture in, for a ground or a tooth that is called by its hash, which is returned.
    ///
    /// # Errors
    /// As [`Assets::add`].
    pub fn embed(&mut self, bytes: std::sync::Arc<[u8]>) -> Result<String, EditError> {
        self.embedded.add(bytes)
    }

    /// The pictures that were taken in.
    #[must_use]
    pub fn embedded(&self) -> &Assets {
        &self.embedded
    }

    /// Applies paint to a surface, cell by cell, from the tubes of `paints`: one step that can be undone. Cells beyond
    /// the surface's edge and in wells get none, and none more than it can hold. If it is to dry, wet paint dries
    /// before it, as a layer of its own. Returns the name of its layer, if it dried.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface or paint, or a 17th paint; then nothing is applied.
    pub fn underpaint(
        &mut self,
        surface: u32,
        paints: &[String],
        wetness: &Wetness,
        tiles: impl Iterator<Item = LaidTile>,
    ) -> Result<Option<String>, EditError> {
        self.surface(surface)?;
        let slots = self.slots_of(paints)?;
        let grid = self.sheet(surface).map(|sheet| sheet.store.grid());
        let [across, up] = grid.unwrap_or_default();
        self.begin_step("underpaint", None);
        if matches!(wetness, Wetness::Dry { .. }) {
            // Wet paint dries first, as a step of its own: nothing dries on top of wet paint.
            self.dry_in_step(surface, 1.0, "").ok();
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
            self.lay_on((surface, tile.id), quanta, None, Ledger::from_tube);
        }
        let name = match wetness {
            Wetness::Wet => None,
            Wetness::Dry { name } => self.dry_in_step(surface, 1.0, name).ok(),
        };
        self.end_own_step();
        Ok(name)
    }

    /// The slot of each of `paints`.
    fn slots_of(&mut self, paints: &[String]) -> Result<Vec<usize>, EditError> {
        if paints.is_empty() {
            return Ok(Vec::new());
        }
        let share = 1.0 / paints.len() as f64;
        let part = |paint: &String| Part {
            paint: paint.clone(),
            share,
        };
        let parts = paints.iter().map(part).collect();
        self.slots(&Mixture { parts })?;
        let slot = |paint: &String| {
            let mut slots = self.scene.paints.iter();
            let found = slots.position(|slot| slot.name == *paint);
            found.ok_or_else(|| EditError::NoSlot(paint.clone()))
        };
        paints.iter().map(slot).collect()
    }
}
