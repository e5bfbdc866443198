//! Materials of the surfaces.

use std::sync::Arc;

use maulstick_models::model_called;
use maulstick_types::scene::Layer;

use super::Desk;
use crate::history::SurfaceMaterial;

impl Desk {
    /// Makes layers and surfaces what they are to be; no window is open on these.
    pub(crate) fn restore(
        &mut self,
        layers: Option<&Vec<Layer>>,
        materials: Option<&Vec<SurfaceMaterial>>,
    ) {
        if let Some(layers) = layers {
            self.scene.layers.clone_from(layers);
            self.layers_changed();
        }
        if let Some(materials) = materials {
            self.set_materials(materials);
        }
    }

    /// Makes the surfaces of what they are to be made of; no window is open on them.
    pub(crate) fn set_materials(&mut self, materials: &[SurfaceMaterial]) {
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
