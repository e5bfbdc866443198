//! Entry of `dab` in the registry.

use maulstick_model::rheology::Rheology;
use maulstick_model_entry::{AutoRole, ModelEntry};

use crate::layers::Layers;
use crate::sheet::PANELS;
use crate::step::Dab;

/// Strength of the embossing, change of an encoded channel per metre.
const EMBOSS: f32 = 250.0;

/// The entry; the hand alone feels its rheology, for in this model paint does not flow.
pub const ENTRY: ModelEntry = ModelEntry {
    shown: &Layers { emboss: EMBOSS },
    auto: Some(AutoRole::Lighter),
    panels: &PANELS,
    #[cfg(feature = "device")]
    make_on: Some(crate::device::make),
    ..ModelEntry::new("dab", || Box::new(Dab::default()), Rheology::TUBE)
};
