//! Appearance of a painting under its light: the studio, and the opacity of its dry layers.

use std::collections::BTreeMap;

use maulstick_optics::light::gloss::dry_gloss;
use maulstick_optics::oil::USUAL;
use maulstick_optics::{Paint, Studio};
use maulstick_types::scene::Layer;

/// Conversion of a tile's paint into colour.
#[derive(Clone, Debug)]
pub struct Appearance {
    /// Optics of the paints in use.
    pub studio: Studio,
    /// Slot of the thinner, if it is in use.
    pub thinner: Option<usize>,
    /// Slots of varnishes in use.
    pub varnishes: Vec<usize>,
    /// Gloss of dry paint by slot.
    glosses: BTreeMap<usize, f32>,
    /// Factor on the optical thickness of dry layers by number, where it is not 1.
    opacities: BTreeMap<u32, f32>,
    relief: f32,
    generation: u64,
    print: i64,
}

impl Appearance {
    /// The initial appearance of a painting.
    #[must_use]
    pub fn new(studio: Studio) -> Self {
        Self {
            studio,
            thinner: None,
            varnishes: Vec::new(),
            glosses: BTreeMap::new(),
            opacities: BTreeMap::new(),
            relief: 1.0,
            generation: 0,
            print: 0,
        }
    }

    /// Registers the paint in a slot: whether it is the thinner or a varnish, and its gloss once dry.
    pub fn register(&mut self, slot: usize, paint: &Paint) {
        if paint.is_thinner() {
            self.thinner = Some(slot);
        }
        if paint.is_varnish() && !self.varnishes.contains(&slot) {
            self.varnishes.push(slot);
        }
        self.glosses.insert(slot, paint.dry_gloss());
    }

    /// True for the thinner and varnishes, which hide nothing in any colouring.
    #[must_use]
    pub fn is_clear(&self, slot: usize) -> bool {
        self.thinner == Some(slot) || self.varnishes.contains(&slot)
    }

    /// Gloss of the paint in a slot once it is dry.
    #[must_use]
    pub fn gloss(&self, slot: usize) -> f32 {
        let own = self.glosses.get(&slot).copied();
        own.unwrap_or_else(|| dry_gloss(USUAL))
    }

    /// Content hash: appearances with equal hashes show the same paint alike, in every process.
    #[must_use]
    pub fn print(&self) -> i64 {
        self.print
    }

    /// Adds one of its parts to the content hash.
    pub fn note(&mut self, made_of: &str) {
        // FNV-1a, 64 bits (Fowler, Noll, Vo).
        let hash = made_of
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            });
        self.print = hash as i64;
    }

    /// Counter of changes of light or opacities, each of which makes baked and displayed tiles obsolete.
    #[must_use]
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// This appearance under another light; `studio` has the same paints in the same slots.
    pub fn relight(&mut self, studio: Studio) {
        self.studio = studio;
        self.generation += 1;
    }

    /// The appearance after all surfaces were replaced.
    pub fn renew(&mut self) {
        self.generation += 1;
    }

    /// Factor on the slopes of a relief that is part of the colours, as where it is embossed (Baxter 2004, § 4.6.2).
    #[must_use]
    pub fn relief(&self) -> f32 {
        self.relief
    }

    /// Sets the factor on the slopes of a relief in the colours.
    pub fn set_relief(&mut self, relief: f32) {
        if self.relief != relief {
            self.relief = relief;
            self.generation += 1;
        }
    }

    /// Copies the opacities of `layers`.
    pub fn set_layers(&mut self, layers: &[Layer]) {
        let changed = layers.iter().filter(|layer| layer.opacity != 1.0);
        let opacities = changed.map(|layer| (layer.number, layer.opacity)).collect();
        if self.opacities != opacities {
            self.opacities = opacities;
            self.generation += 1;
        }
    }

    /// Factor on the optical thickness of a dry layer.
    #[must_use]
    pub fn opacity(&self, layer: u32) -> f32 {
        self.opacities.get(&layer).copied().unwrap_or(1.0)
    }
}
