//! Entry of `marker` in the registry.

use maulstick_model::rheology::Rheology;
use maulstick_model_entry::ModelEntry;

use crate::matte::Matte;
use crate::step::Marker;

/// Rheology of ink: a few mPa·s, without a yield stress.
const RHEOLOGY: Rheology = Rheology {
    viscosity_m2_s: 5e-6,
    thinning: 0.0,
    bears: 0.0,
    yields: |_| 0.0,
};

/// Registry entry of `marker`.
pub const ENTRY: ModelEntry = ModelEntry {
    shown: &Matte,
    ..ModelEntry::new("marker", || Box::new(Marker::default()), RHEOLOGY)
};
