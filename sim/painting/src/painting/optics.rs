//! Optics of a painting: its paints, and how they look under its light.

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::blank_surface::{
    BlankSurface, CLEANER_RGB, HeapColours, MEDIUM_RGB, WellLook, WellShape,
};
use maulstick_appearance::colouring::Colouring;
use maulstick_appearance::ground::Ground;
use maulstick_appearance::heap::{Heap, HeapCells};
use maulstick_appearance::light::studio_settings;
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::relief::Relief;
use maulstick_model::brush::load::by_slot;
use maulstick_optics::{Paint, PaintLibrary, Spectrum, Studio, THINNER};
use maulstick_types::Mixture;
use maulstick_types::scene::{Light, PaintSlot, Scene, Surface, WellKind};

use maulstick_models::model_called;

use crate::error::EditError;
use crate::history::materials;
use crate::setup::relief_called;

/// Thickness of an opaque layer, m.
const OPAQUE_M: f64 = 0.01;

/// Paints by slot, and shares of them.
pub(crate) type SlotShares = Vec<(usize, f64)>;

/// Paints, their appearance under the light, and the files of grounds and teeth.
#[derive(Clone)]
pub(crate) struct Optics {
    pub(crate) library: PaintLibrary,
    pub(crate) look: Arc<Appearance>,
    pub(crate) assets: Assets,
}

impl Optics {
    /// The optics of a scene.
    pub(crate) fn of(
        scene: &Scene,
        library: PaintLibrary,
        assets: Assets,
    ) -> Result<Self, EditError> {
        let settings = studio_settings(&scene.light)?;
        let mut look = Appearance::new(Studio::new(&settings, library.paints()));
        for (place, slot) in scene.paints.iter().enumerate() {
            let paint = library.find(&slot.name)?;
            look.studio.add(paint);
            look.register(place, paint);
        }
        let mut optics = Self {
            library,
            look: Arc::new(look),
            assets,
        };
        optics.set_layers(scene);
        optics.emboss(scene);
        Ok(optics)
    }

    /// An unpainted surface; `relief` is the earlier one, if known.
    pub(crate) fn blank(
        &self,
        surface: &Surface,
        relief: Option<Arc<Relief>>,
    ) -> Result<ShownSurface, EditError> {
        self.blank_in(&self.look.studio, surface, relief)
    }

    pub(crate) fn blank_in(
        &self,
        studio: &Studio,
        surface: &Surface,
        relief: Option<Arc<Relief>>,
    ) -> Result<ShownSurface, EditError> {
        let ground = Ground::called(&surface.ground, surface.cells, studio, &self.assets)?;
        let relief = match relief {
            Some(relief) => relief,
            None => {
                let (name, seed) = (&surface.tooth, surface.tooth_seed);
                Arc::new(relief_called(name, seed, surface.cell_m, &self.assets)?)
            }
        };
        let mut wells = Vec::new();
        for well in &surface.wells {
            let center = well.center_m.map(|m| m / surface.cell_m);
            let radius = well.radius_m / surface.cell_m;
            let jar = |rgb| WellLook {
                center,
                radius,
                shape: WellShape::Jar(rgb),
            };
            let mixture = match &well.kind {
                WellKind::Paint { mixture } => mixture,
                WellKind::Cleaner => {
                    wells.push(jar(CLEANER_RGB));
                    continue;
                }
                WellKind::Medium => {
                    wells.push(jar(MEDIUM_RGB));
                    continue;
                }
            };
            let mixture = self.library.check(mixture)?;
            let mut mixed = studio.clone();
            let mut shares = Vec::new();
            for part in &mixture.parts {
                let paint = self.library.find(&part.paint)?;
                shares.push((mixed.add(paint), part.share));
            }
            let colours = HeapColours::of(&mixed, &shares, ground.mean());
            let heap = HeapCells::of(&Heap::of(&mixture), center, radius);
            wells.push(WellLook {
                center,
                radius,
                shape: WellShape::Heap(heap, colours),
            });
        }
        Ok(ShownSurface {
            blank: BlankSurface {
                cells: surface.cells,
                ground,
                relief,
                wells,
            },
            shown: model_called(&surface.model)?.shown,
        })
    }

    /// The slots of a mixture's paints; new paints get the next free ones of the scene.
    pub(crate) fn slots(
        &mut self,
        scene: &mut Scene,
        mixture: &Mixture,
    ) -> Result<SlotShares, EditError> {
        let mixture = self.library.check(mixture)?;
        let mut new = Vec::new();
        for part in &mixture.parts {
            if slot_of(scene, &part.paint).is_none() {
                new.push(self.library.find(&part.paint)?);
            }
        }
        // All or none: a refused mixture changes nothing.
        if scene.paints.len() + new.len() > SLOTS {
            let first = &new[SLOTS - scene.paints.len()];
            return Err(EditError::TooManyPaints(first.name.clone()));
        }
        for paint in new {
            let look = Arc::make_mut(&mut self.look);
            let slot = paint_slot(&mut look.studio, paint, self.library.hash());
            look.register(scene.paints.len(), paint);
            scene.paints.push(slot);
            scene.version += 1;
        }
        by_slot(&mixture, |name| {
            slot_of(scene, name).ok_or_else(|| EditError::NoSlot(name.to_owned()))
        })
    }

    /// Copies the dry layers of a scene.
    pub(crate) fn set_layers(&mut self, scene: &Scene) {
        Arc::make_mut(&mut self.look).set_layers(&scene.layers);
        self.note(scene);
    }

    /// Takes over how strongly relief is embossed where it is part of the colours.
    pub(crate) fn emboss(&mut self, scene: &Scene) {
        if embosses(scene) {
            Arc::make_mut(&mut self.look).set_relief(scene.light.relief as f32);
            self.note(scene);
        }
    }

    /// Counts all that was shown of the scene as outdated.
    pub(crate) fn renew(&mut self, scene: &Scene) {
        Arc::make_mut(&mut self.look).renew();
        self.note(scene);
    }

    /// Adds the parts of the appearance to its hash: light, layers, grounds and wells, paints.
    pub(crate) fn note(&mut self, scene: &Scene) {
        let materials = materials(scene);
        let light = Light {
            exposure: 1.0,
            intensity: 1.0,
            direction: [0.0, 0.0, 1.0],
            relief: if embosses(scene) {
                scene.light.relief
            } else {
                1.0
            },
            softness: 0.0,
            ..scene.light.clone()
        };
        // Only the opacity of layers is visible.
        let layers = scene.layers.iter();
        let veiled = layers.filter(|layer| layer.opacity != 1.0);
        let veiled: Vec<(u32, f32)> = veiled.map(|layer| (layer.number, layer.opacity)).collect();
        let hash = self.library.hash();
        let made_of = format!("6 {light:?} {veiled:?} {materials:?} {hash}");
        Arc::make_mut(&mut self.look).note(&made_of);
    }
}

/// True if the relief of a surface is part of its colours.
fn embosses(scene: &Scene) -> bool {
    let mut models = scene.surfaces.iter().map(|own| model_called(&own.model));
    models.any(|model| model.is_ok_and(|model| model.shown.colouring() != Colouring::Films))
}

/// Slot of a paint in a scene.
pub(crate) fn slot_of(scene: &Scene, paint: &str) -> Option<usize> {
    scene.paints.iter().position(|slot| slot.name == paint)
}

/// Slot of the thinner, if the scene has one.
pub(crate) fn thinner_slot(scene: &Scene) -> Option<usize> {
    slot_of(scene, THINNER)
}

/// Gives a paint a slot of the studio and of the scene.
pub(crate) fn paint_slot(studio: &mut Studio, paint: &Paint, file_hash: u32) -> PaintSlot {
    let slot = studio.add(paint);
    let seen = |films: &[(usize, f64)], ground: f64| {
        let ground = studio.sample(&Spectrum::flat(ground));
        studio.colour(films, &ground).map(|channel| channel as f32)
    };
    PaintSlot {
        name: paint.name.clone(),
        masstone: seen(
            &[(slot, OPAQUE_M)],
            if paint.is_thinner() || paint.is_varnish() {
                1.0
            } else {
                0.0
            },
        ),
        // A tint is one part in ten of the strongest white's scattering.
        tint: seen(&[(slot, 1e-5)], 0.9),
        file_hash,
    }
}
