//! The desk: the scene, its surfaces, and how their paint looks.

mod converting;
mod layers;
mod materials;
pub(crate) mod preparation;
mod relief_below;
mod wells;

use std::sync::Arc;

use crate::error::EditError;

use maulstick_appearance::light::{changes_colour, studio_settings};
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::Pager;
use maulstick_optics::{PaintLibrary, Studio};
use maulstick_types::Mixture;
use maulstick_types::mixture::Part;
use maulstick_types::scene::{Light, Scene, Surface};

use super::optics::{Optics, SlotShares, paint_slot, slot_of};
use super::surfaces::Surfaces;

/// The scene, its surfaces and the look of their paint.
#[derive(Clone)]
pub(crate) struct Desk {
    /// The desk as those who follow the painting see it. Its surfaces stand in the order of `surfaces`.
    pub(crate) scene: Scene,
    pub(crate) optics: Optics,
    pub(crate) surfaces: Surfaces,
}

impl Desk {
    /// The desk of a scene, blank.
    pub(crate) fn new(
        scene: Scene,
        library: PaintLibrary,
        assets: Assets,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        let optics = Optics::of(&scene, library, assets)?;
        let surfaces = Surfaces::new(&scene, &optics, pager)?;
        Ok(Self {
            scene,
            optics,
            surfaces,
        })
    }

    /// Slots of a mixture's paints; new paints get the next free ones.
    pub(crate) fn slots(&mut self, mixture: &Mixture) -> Result<SlotShares, EditError> {
        self.optics.slots(&mut self.scene, mixture)
    }

    /// Slots of several mixtures; where one is refused no paint gets a slot.
    pub(crate) fn all_slots(&mut self, mixtures: &[Mixture]) -> Result<Vec<SlotShares>, EditError> {
        let known = (self.scene.paints.clone(), Arc::clone(&self.optics.look));
        let slots: Result<_, _> = mixtures.iter().map(|mixture| self.slots(mixture)).collect();
        if slots.is_err() {
            (self.scene.paints, self.optics.look) = known;
        }
        slots
    }

    /// The slot of each of `paints`.
    pub(crate) fn slots_of(&mut self, paints: &[String]) -> Result<Vec<usize>, EditError> {
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
            slot_of(&self.scene, paint).ok_or_else(|| EditError::NoSlot(paint.clone()))
        };
        paints.iter().map(slot).collect()
    }

    /// Changes a surface of the scene, but for its materials.
    pub(crate) fn change_surface(
        &mut self,
        id: u32,
        change: impl FnOnce(&mut Surface),
    ) -> Result<(), EditError> {
        let on = self.surfaces.at(id)?;
        change(&mut self.scene.surfaces[on]);
        self.scene.version += 1;
        Ok(())
    }

    /// Changes the light, without choosing the exposure anew.
    pub(crate) fn relight(&mut self, light: &Light) -> Result<(), EditError> {
        let settings = studio_settings(light)?;
        if changes_colour(light, &self.scene.light) {
            let mut studio = Studio::new(&settings, self.optics.library.paints());
            let mut slots = Vec::new();
            for slot in &self.scene.paints {
                let paint = self.optics.library.find(&slot.name)?;
                slots.push(paint_slot(&mut studio, paint, slot.file_hash));
            }
            let mut bares = Vec::new();
            for (own, surface) in self.surfaces.iter().zip(&self.scene.surfaces) {
                let relief = Some(Arc::clone(&own.bare.relief));
                bares.push(Arc::new(self.optics.blank_in(&studio, surface, relief)?));
            }
            let surfaces = self.surfaces.iter_mut().zip(bares);
            surfaces.for_each(|(surface, bare)| surface.bare = bare);
            self.scene.paints = slots;
            Arc::make_mut(&mut self.optics.look).relight(studio);
        }
        self.scene.light = light.clone();
        self.scene.version += 1;
        self.optics.emboss(&self.scene);
        self.optics.note(&self.scene);
        Ok(())
    }

    /// Sets the exposure so that the bare canvas does not clip.
    pub(crate) fn expose(&mut self) {
        let ground = self.surfaces[0].bare.ground.mean();
        let rgb = self.optics.look.studio.colour(&[], ground);
        let light = &mut self.scene.light;
        light.exposure = maulstick_optics::light::starting_exposure(rgb, light.intensity);
        self.scene.version += 1;
    }
}
