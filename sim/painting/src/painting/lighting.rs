//! The light over a painting.

use std::sync::Arc;

use maulstick_appearance::light::{changes_colour, studio_settings};
use maulstick_canvas::EditError;
use maulstick_optics::Studio;
use maulstick_types::edits::Relight;
use maulstick_types::scene::{CANVAS, Light, PaintSlot};

use super::{Painting, bare};
use crate::apply::{Applied, Apply};
use crate::error::paint_error;

/// Thickness of an opaque layer, m.
const OPAQUE_M: f64 = 0.01;

impl Apply for Relight {
    /// Changes the light. If its spectrum, or its conversion to colour, changes, dry layers are baked anew on demand,
    /// tile by tile.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.relight(&self.light)?;
        if self.expose {
            painting.expose();
        }
        Ok(Applied::Done)
    }
}

impl Painting {
    /// Changes the light, without choosing the exposure anew.
    ///
    /// # Errors
    /// [`EditError`] for an invalid light.
    pub fn relight(&mut self, light: &Light) -> Result<(), EditError> {
        let settings = studio_settings(light)?;
        if changes_colour(light, &self.scene.light) {
            let mut studio = Studio::new(&settings, self.library.paints());
            let mut slots = Vec::new();
            for slot in &self.scene.paints {
                let paint = self.library.find(&slot.name).map_err(paint_error)?;
                slots.push(paint_slot(&mut studio, paint, slot.file_hash));
            }
            let mut bares = Vec::new();
            for (sheet, surface) in self.sheets.iter().zip(&self.scene.surfaces) {
                let relief = Some(Arc::clone(&sheet.bare.relief));
                let makers = (&self.library, &self.embedded);
                bares.push(Arc::new(bare(surface, &studio, makers, relief)?));
            }
            self.sheets
                .iter_mut()
                .zip(bares)
                .for_each(|(sheet, bare)| sheet.bare = bare);
            self.scene.paints = slots;
            Arc::make_mut(&mut self.look).relight(studio);
        }
        self.scene.light = light.clone();
        self.scene.version += 1;
        self.note_look();
        Ok(())
    }

    /// Notes in the look what it is made of: light, layers, grounds, wells, paints.
    pub(super) fn note_look(&mut self) {
        let makes = super::undo::makes(&self.scene);
        let light = Light {
            exposure: 1.0,
            intensity: 1.0,
            direction: [0.0, 0.0, 1.0],
            relief: 1.0,
            softness: 0.0,
            ..self.scene.light.clone()
        };
        // Of the layers only how opaque they are is seen.
        let layers = self.scene.layers.iter();
        let veiled = layers.filter(|layer| layer.opacity != 1.0);
        let veiled: Vec<(u32, f32)> = veiled.map(|layer| (layer.number, layer.opacity)).collect();
        let wells: Vec<_> = self.scene.surfaces.iter().map(|own| &own.wells).collect();
        let hash = self.library.hash();
        let made_of = format!("4 {light:?} {veiled:?} {makes:?} {wells:?} {hash}");
        Arc::make_mut(&mut self.look).note(&made_of);
    }

    /// Sets the exposure so that the bare canvas does not clip.
    pub fn expose(&mut self) {
        let Some(sheet) = self.sheets.iter().find(|sheet| sheet.id == CANVAS) else {
            return;
        };
        let rgb = self.look.studio.colour(&[], sheet.bare.ground.mean());
        let light = &mut self.scene.light;
        light.exposure = maulstick_optics::light::starting_exposure(rgb, light.intensity);
        self.scene.version += 1;
    }
}

/// Gives a paint a slot of the studio and of the scene.
pub(super) fn paint_slot(
    studio: &mut Studio,
    paint: &maulstick_optics::Paint,
    file_hash: u32,
) -> PaintSlot {
    let slot = studio.add(paint);
    let seen = |films: &[(usize, f64)], ground: f64| {
        let ground = studio.sample(&maulstick_optics::Spectrum::flat(ground));
        studio.colour(films, &ground).map(|channel| channel as f32)
    };
    PaintSlot {
        name: paint.name.clone(),
        masstone: seen(
            &[(slot, OPAQUE_M)],
            if paint.is_thinner() { 1.0 } else { 0.0 },
        ),
        // A tint is one part in ten of the strongest white's scattering.
        tint: seen(&[(slot, 1e-5)], 0.9),
        file_hash,
    }
}
