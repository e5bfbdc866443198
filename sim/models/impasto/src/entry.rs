//! Entry of `impasto` in the registry.

use maulstick_model::rheology::Rheology;
use maulstick_model_entry::{AutoRole, ModelEntry};

use crate::stages::Impasto;

/// Registry entry of `impasto`.
pub const ENTRY: ModelEntry = ModelEntry {
    auto: Some(AutoRole::First),
    #[cfg(feature = "device")]
    make_on: Some(crate::device::make),
    ..ModelEntry::new("impasto", || Box::new(Impasto::default()), Rheology::TUBE)
};
