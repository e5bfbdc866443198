//! Paint applied cell by cell: an underpainting after a picture.

use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::tile::TileId;
use maulstick_types::paint::StepName;

use super::Painting;
use crate::error::EditError;
use crate::ledger::Ledger;

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
        let Self { bench, clock } = self;
        let on = bench.desk.surfaces.at(surface)?;
        let slots = bench.desk.slots_of(paints)?;
        let [across, up] = bench.desk.surfaces[on].store.grid();
        bench.begin_step(StepName::Underpainting, None);
        if matches!(wetness, Wetness::Dry { .. }) {
            // Wet paint dries first, as a step of its own: nothing dries on top of wet paint.
            bench.dry(clock, on, 1.0, "");
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
            bench.lay_on((on, tile.id), quanta, None, Ledger::from_tube);
        }
        let name = match wetness {
            Wetness::Wet => None,
            Wetness::Dry { name } => bench.dry(clock, on, 1.0, name),
        };
        bench.end_own_step();
        // No message describes it.
        self.break_record();
        Ok(name)
    }
}
