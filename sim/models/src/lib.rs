//! The registry of paint models, the only place that names them all. Each is a folder beside it and exports its entry.
//!
//! ```
//! let impasto = maulstick_models::model_called("impasto")?;
//! assert_eq!((impasto.make)().name(), "impasto");
//! assert!(maulstick_models::model_called("oil").is_err());
//! # Ok::<(), maulstick_models::NoModel>(())
//! ```

mod error;

pub use error::NoModel;
pub use maulstick_model_entry::{AutoRole, ModelEntry, SheetError, SheetPanel};

/// All paint models; the first is the default.
pub static MODELS: [ModelEntry; 4] = [
    maulstick_impasto::ENTRY,
    maulstick_dab::ENTRY,
    maulstick_stokes_paint::ENTRY,
    maulstick_marker::ENTRY,
];

/// Name that leaves the choice of a new painting's model to the rig.
pub const AUTO: &str = "auto";

/// Names of the paint models.
pub fn model_names() -> impl Iterator<Item = &'static str> + Clone {
    MODELS.iter().map(|entry| entry.name)
}

/// The model of this name.
///
/// # Errors
/// [`NoModel`] with the known names.
pub fn model_called(name: &str) -> Result<&'static ModelEntry, NoModel> {
    let found = MODELS.iter().find(|entry| entry.name == name);
    found.ok_or_else(|| NoModel {
        name: name.to_owned(),
        known: model_names().collect(),
    })
}

/// The model with this role where the rig chooses one.
#[must_use]
pub fn auto_model(role: AutoRole) -> &'static ModelEntry {
    let mut models = MODELS.iter();
    let found = models.find(|entry| entry.auto == Some(role));
    found.unwrap_or(&MODELS[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_found_by_the_name_that_it_has_itself() {
        for entry in &MODELS {
            assert_eq!((entry.make)().name(), entry.name);
            assert!(model_called(entry.name).is_ok_and(|found| found.name == entry.name));
        }
    }

    #[test]
    fn the_first_is_that_of_scenes_that_name_none() {
        assert_eq!(MODELS[0].name, maulstick_types::scene::default_model());
    }

    #[test]
    fn auto_begins_with_one_model_and_proposes_one() {
        for role in [AutoRole::First, AutoRole::Lighter] {
            let having = MODELS.iter().filter(|entry| entry.auto == Some(role));
            assert_eq!(having.count(), 1, "{role:?}");
            assert_eq!(auto_model(role).auto, Some(role));
        }
        assert!(model_called(AUTO).is_err(), "no surface has it");
    }

    #[test]
    fn an_unknown_name_comes_back_with_the_known_ones() {
        let unknown = NoModel {
            name: "impatso".to_owned(),
            known: model_names().collect(),
        };
        assert_eq!(model_called("impatso").err(), Some(unknown));
    }
}
