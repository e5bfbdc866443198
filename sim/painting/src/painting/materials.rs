//! Materials of the surfaces.

use std::sync::Arc;

use maulstick_appearance::ground::{add_spectrum, check_ground};
use maulstick_canvas::EditError;
use maulstick_canvas::assets::SPECTRUM;
use maulstick_types::scene::Surface;

use super::{Painting, bare};
use crate::history::SurfaceMaterial;
use crate::setup::relief_called;

impl Painting {
    pub(super) fn surface(&self, id: u32) -> Result<&Surface, EditError> {
        let found = self.scene.surfaces.iter().find(|surface| surface.id == id);
        found.ok_or_else(|| {
            EditError::new(
                format!("there is no surface {id}"),
                "the canvas is 0, the palette 1",
            )
        })
    }

    /// Gives a surface another ground.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface or ground.
    pub fn set_ground(&mut self, surface: u32, ground: &str) -> Result<(), EditError> {
        self.surface(surface)?;
        check_ground(ground, &self.embedded)?;
        self.make("ground", surface, |make| {
            ground.clone_into(&mut make.ground)
        });
        Ok(())
    }

    /// Gives a surface a ground of a measured reflectance, a CSV file of nm,reflectance, which the
    /// painting holds from then on.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface, or with the line of what is no reflectance.
    pub fn set_ground_spectrum(&mut self, surface: u32, text: &str) -> Result<(), EditError> {
        self.surface(surface)?;
        let hash = add_spectrum(&mut self.embedded, text)?;
        self.set_ground(surface, &format!("{SPECTRUM}{hash}"))
    }

    /// Gives a surface another tooth.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface or tooth.
    pub fn set_tooth(&mut self, surface: u32, tooth: &str, seed: u64) -> Result<(), EditError> {
        let cell_m = self.surface(surface)?.cell_m;
        relief_called(tooth, seed, cell_m, &self.embedded)?;
        self.make("tooth", surface, |make| {
            tooth.clone_into(&mut make.tooth);
            make.tooth_seed = seed;
        });
        Ok(())
    }

    fn make(&mut self, what: &str, surface: u32, change: impl FnOnce(&mut SurfaceMaterial)) {
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
    pub(super) fn remake(&mut self, makes: &[SurfaceMaterial]) {
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
            // A material that a step brings back was checked when it was made.
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
}
