//! Materials and places of the surfaces.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_models::model_called;
use maulstick_types::paint::StepName;
use maulstick_types::scene::Surface;

use crate::edits::Applied;
use crate::history::SurfaceMaterial;
use crate::painting::Painting;
use crate::painting::undo::materials;

impl Painting {
    pub(crate) fn change_surface(
        &mut self,
        id: u32,
        change: impl FnOnce(&mut Surface),
    ) -> Result<Applied, EditError> {
        let on = self.surfaces.at(id)?;
        change(&mut self.scene.surfaces[on]);
        self.scene.version += 1;
        Ok(Applied::Done)
    }

    pub(crate) fn change_material(
        &mut self,
        what: StepName,
        on: usize,
        change: impl FnOnce(&mut SurfaceMaterial),
    ) {
        self.begin_step(what, None);
        let mut materials = materials(&self.scene);
        change(&mut materials[on]);
        self.set_materials(&materials);
        self.end_own_step();
    }

    /// Sets the materials of the surfaces.
    pub(crate) fn set_materials(&mut self, materials: &[SurfaceMaterial]) {
        self.close_windows();
        for material in materials {
            let Ok(on) = self.surfaces.at(material.surface) else {
                continue;
            };
            let (surface, own) = (&mut self.scene.surfaces[on], &mut self.surfaces[on]);
            let tooth =
                (&surface.tooth, surface.tooth_seed) != (&material.tooth, material.tooth_seed);
            let model = if material.model.is_empty() {
                own.model
            } else {
                model_called(&material.model).unwrap_or(own.model)
            };
            let is_model = std::ptr::eq(model, own.model);
            let is_ground = surface.ground == material.ground;
            if !tooth && is_model && is_ground && surface.wells == material.wells {
                continue;
            }
            own.model = model;
            model.name.clone_into(&mut surface.model);
            surface.wells.clone_from(&material.wells);
            surface.ground.clone_from(&material.ground);
            surface.tooth.clone_from(&material.tooth);
            surface.tooth_seed = material.tooth_seed;
            let relief = (!tooth).then(|| Arc::clone(&own.bare.relief));
            // A material that a step brings back was checked when it was made.
            if let Ok(bare) = self.optics.blank(surface, relief) {
                own.bare = Arc::new(bare);
            }
        }
        self.optics.renew(&self.scene);
        self.scene.version += 1;
    }
}
