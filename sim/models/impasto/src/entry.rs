//! Entry of `impasto` in the registry.

use maulstick_model::rheology::Rheology;
use maulstick_model_entry::{AutoRole, ModelEntry};

use crate::stages::Impasto;
use crate::stages::levelling::thinned;

/// Oil paint from the tube (Baxter 2004, § 5.2).
pub const RHEOLOGY: Rheology = Rheology {
    viscosity_m2_s: 1e-2,
    thinning: -4.6,
    bears: 0.2,
    yields: |thinner| {
        let [yields, _] = thinned(thinner);
        yields
    },
};

/// Registry entry of `impasto`.
pub const ENTRY: ModelEntry = ModelEntry {
    auto: Some(AutoRole::First),
    #[cfg(feature = "device")]
    make_on: Some(crate::device::make),
    ..ModelEntry::new("impasto", || Box::new(Impasto::default()), RHEOLOGY)
};
