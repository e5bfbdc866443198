//! Entry of `stokes` in the registry.

use maulstick_impasto::stages::levelling::Body;
use maulstick_model::rheology::Rheology;
use maulstick_model_entry::ModelEntry;

use crate::drag::DENSITY_KG_M3;
use crate::overhangs::Overhangs;
use crate::step::StokesPaint;

/// Registry entry of `stokes`.
const RHEOLOGY: Rheology = Rheology {
    viscosity_m2_s: Body::TUBE.viscosity_pa_s / DENSITY_KG_M3,
    ..Rheology::TUBE
};

/// The entry.
pub const ENTRY: ModelEntry = ModelEntry {
    shown: &Overhangs,
    #[cfg(feature = "device")]
    make_on: Some(crate::device::make),
    ..ModelEntry::new("stokes", || Box::new(StokesPaint::default()), RHEOLOGY)
};
