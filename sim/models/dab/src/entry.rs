//! Entry of `dab` in the registry.

use maulstick_model::rheology::Rheology;
use maulstick_model_entry::{AutoRole, ModelEntry};

use crate::layers::Layers;
use crate::sheet::PANELS;
use crate::step::Dab;

/// Strength of the embossing, change of an encoded channel per metre.
const EMBOSS: f32 = 250.0;

/// Rheology of oil paint from the tube, for the hand alone: in this model paint does not flow (Baxter 2004, § 5.2).
const RHEOLOGY: Rheology = Rheology {
    viscosity_m2_s: 1e-2,
    thinning: -4.6,
    bears: 0.2,
    yields: |thinner| {
        let left = (1.0 - 2.0 * thinner).max(0.0);
        left * left * left
    },
};

/// Registry entry of `dab`.
pub const ENTRY: ModelEntry = ModelEntry {
    shown: &Layers { emboss: EMBOSS },
    auto: Some(AutoRole::Lighter),
    panels: &PANELS,
    #[cfg(feature = "device")]
    make_on: Some(crate::device::make),
    ..ModelEntry::new("dab", || Box::new(Dab::default()), RHEOLOGY)
};
