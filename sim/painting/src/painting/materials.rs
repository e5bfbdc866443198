//! Materials of the surfaces.

use std::sync::Arc;

use super::{Painting, bare};
use crate::apply::{Applied, Apply};
use crate::history::SurfaceMaterial;
use crate::setup::relief_called;
use maulstick_appearance::ground::{add_spectrum, check_ground};
use maulstick_canvas::EditError;
use maulstick_canvas::assets::SPECTRUM;
use maulstick_types::edits::{Ground, GroundSource, Tooth};
use maulstick_types::scene::Surface;

impl Apply for Ground {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let surface = self.surface;
        painting.surface(surface)?;
        let ground = match &self.ground {
            GroundSource::Named { name } => name.to_string(),
            GroundSource::Spectrum { csv } => {
                format!("{SPECTRUM}{}", add_spectrum(&mut painting.embedded, csv)?)
            }
        };
        check_ground(&ground, &painting.embedded)?;
        painting.make("ground", surface, |make| make.ground = ground);
        Ok(Applied::Done)
    }
}

impl Apply for Tooth {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let cell_m = painting.surface(self.surface)?.cell_m;
        relief_called(&self.tooth, self.seed, cell_m, &painting.embedded)?;
        painting.make("tooth", self.surface, |make| {
            make.tooth = self.tooth.to_string();
            make.tooth_seed = self.seed;
        });
        Ok(Applied::Done)
    }
}

impl Painting {
    pub(super) fn surface(&self, id: u32) -> Result<&Surface, EditError> {
        let found = self.scene.surfaces.iter().find(|surface| surface.id == id);
        found.ok_or(EditError::NoSurface(id))
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
