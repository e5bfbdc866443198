//! What surfaces are made of, and paint that is laid over all of one.

use std::sync::Arc;

use maulstick_types::Mixture;
use maulstick_types::scene::Surface;

use super::{PaintRefusal, Painting, bare};
use crate::history::Make;
use crate::quantum::{QUANTUM_M, SLOTS};
use crate::setup::{check_ground, relief_called};
use crate::tile::{TILE_CELLS, Tile};

impl Painting {
    pub(super) fn surface(&self, id: u32) -> Result<&Surface, PaintRefusal> {
        let found = self.scene.surfaces.iter().find(|surface| surface.id == id);
        found.ok_or_else(|| {
            PaintRefusal::new(
                format!("there is no surface {id}"),
                "the canvas is 0, the palette 1",
            )
        })
    }

    /// Gives a surface another ground.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown surface or ground.
    pub fn set_ground(&mut self, surface: u32, ground: &str) -> Result<(), PaintRefusal> {
        self.surface(surface)?;
        check_ground(ground, &self.embedded)?;
        self.make("ground", surface, |make| {
            ground.clone_into(&mut make.ground)
        });
        Ok(())
    }

    /// Gives a surface another tooth.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown surface or tooth.
    pub fn set_tooth(&mut self, surface: u32, tooth: &str, seed: u64) -> Result<(), PaintRefusal> {
        let cell_m = self.surface(surface)?.cell_m;
        relief_called(tooth, seed, cell_m, &self.embedded)?;
        self.make("tooth", surface, |make| {
            tooth.clone_into(&mut make.tooth);
            make.tooth_seed = seed;
        });
        Ok(())
    }

    fn make(&mut self, what: &str, surface: u32, change: impl FnOnce(&mut Make)) {
        self.begin_step(what, None);
        let mut makes = self.rest().makes;
        let found = makes.iter_mut().find(|make| make.surface == surface);
        if let Some(found) = found {
            change(found);
        }
        self.remake(&makes);
        self.end_own_step();
    }

    /// Makes the surfaces of what they are to be made of.
    pub(super) fn remake(&mut self, makes: &[Make]) {
        self.close_windows();
        for make in makes {
            let surfaces = &mut self.scene.surfaces;
            let Some(surface) = surfaces.iter_mut().find(|other| other.id == make.surface) else {
                continue;
            };
            let tooth = (&surface.tooth, surface.tooth_seed) != (&make.tooth, make.tooth_seed);
            if !tooth && surface.ground == make.ground {
                continue;
            }
            surface.ground.clone_from(&make.ground);
            surface.tooth.clone_from(&make.tooth);
            surface.tooth_seed = make.tooth_seed;
            let Some(sheet) = self
                .sheets
                .iter_mut()
                .find(|sheet| sheet.id == make.surface)
            else {
                continue;
            };
            let relief = (!tooth).then(|| Arc::clone(&sheet.bare.relief));
            // What a step brings back was checked when it was made.
            let makers = (&self.library, &self.embedded);
            if let Ok(bare) = bare(surface, &self.look.studio, makers, relief) {
                sheet.bare = Arc::new(bare);
            }
        }
        let mut look = (*self.look).clone();
        look.renew();
        self.look = Arc::new(look);
        self.scene.version += 1;
        self.note_look();
    }

    /// Lays an even film of wet paint over a whole surface, but for its wells.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown surface or paint, or a 17th paint.
    pub fn lay(
        &mut self,
        surface: u32,
        mixture: &Mixture,
        thickness_m: f64,
    ) -> Result<(), PaintRefusal> {
        self.surface(surface)?;
        let slots = self.slots(mixture)?;
        let mut quanta = [0.0f32; SLOTS];
        for (slot, share) in slots {
            quanta[slot] += (share * thickness_m / QUANTUM_M).round() as f32;
        }
        self.begin_step("fill", None);
        let store = self.sheet(surface).map(|sheet| sheet.store.grid());
        let [across, up] = store.unwrap_or_default();
        for y in 0..up {
            for x in 0..across {
                self.lay_on((surface, crate::tile::TileId { x, y }), |_, slot| {
                    quanta[slot]
                });
            }
        }
        self.end_own_step();
        Ok(())
    }

    /// Adds wet paint to a tile, `quanta` by cell and slot: as much as the cells still hold. Cells
    /// beyond the surface's edge and in wells get none.
    pub(super) fn lay_on(
        &mut self,
        place: crate::history::Place,
        quanta: impl Fn(usize, usize) -> f32,
    ) {
        let Some(sheet) = self.sheets.iter().find(|sheet| sheet.id == place.0) else {
            return;
        };
        let before = sheet.store.version(place.1).tile.clone();
        let wet = before.as_deref().map(Tile::wet).unwrap_or_default();
        let mut planes: Vec<Option<Vec<f32>>> = vec![None; SLOTS];
        let mut room = vec![crate::quantum::CELL_MAX as f32; TILE_CELLS];
        for (slot, plane) in &*wet {
            room.iter_mut()
                .zip(plane.iter())
                .for_each(|(room, held)| *room -= held);
            planes[*slot] = Some(plane.to_vec());
        }
        let [width, height] = sheet.store.cells().map(|cells| cells as usize);
        let side = maulstick_types::paint::TILE;
        for cell in 0..TILE_CELLS {
            let x = place.1.x as usize * side + cell % side;
            let y = place.1.y as usize * side + cell / side;
            if x >= width || y >= height {
                room[cell] = 0.0;
            }
        }
        for (cell, _) in sheet.bare.in_wells(place.1) {
            room[cell] = 0.0;
        }
        let mut given = [0u64; SLOTS];
        let mut top = 0.0f32;
        for cell in 0..TILE_CELLS {
            for (slot, plane) in planes.iter_mut().enumerate() {
                let part = quanta(cell, slot).min(room[cell]).max(0.0).floor();
                if part > 0.0 {
                    plane.get_or_insert_with(|| vec![0.0; TILE_CELLS])[cell] += part;
                    room[cell] -= part;
                    given[slot] += part as u64;
                }
            }
            top = top.max(crate::quantum::CELL_MAX as f32 - room[cell]);
        }
        if given.iter().all(|count| *count == 0) {
            return;
        }
        let dry = before.as_deref().and_then(Tile::dry).cloned();
        let beneath = dry.as_ref().map_or(0.0, |stack| {
            stack.height().iter().copied().fold(0.0, f32::max)
        });
        let planes = planes.into_iter().enumerate();
        let planes = planes.filter_map(|(slot, plane)| Some((slot, plane?.into())));
        let tile = Tile::paged(&self.pager, planes, dry, before.as_deref());
        let replaced = self.put(place, Some(Arc::new(tile)));
        self.history.replaced(None, place, replaced);
        self.ledger.from_tube(&given);
        self.book(None);
        if let Some(sheet) = self.sheets.iter_mut().find(|sheet| sheet.id == place.0) {
            sheet.top = sheet.top.max(top + beneath);
        }
    }
}
