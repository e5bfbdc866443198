//! The paint models that a surface can have: the one place that names them.

use std::collections::BTreeMap;
use std::fmt;

use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_canvas::EditError;
use maulstick_convert::Colouring;
use maulstick_dab::{Dab, Layers};
use maulstick_impasto::Impasto;
use maulstick_marker::{Marker, Matte};
use maulstick_model::interface::PaintModel;
use maulstick_stokes_paint::StokesPaint;
use maulstick_stokes_paint::overhangs::Overhangs;
use maulstick_types::paint::Decision;

/// Entry of a paint model in [`MODELS`].
pub struct ModelEntry {
    /// Its name in `rig.toml`, in the scene and in a document.
    pub name: &'static str,
    /// How its paint is shown.
    pub shown: &'static dyn ShowPaint,
    /// How its counts become colours: between models that differ in it, conversions fit colours.
    pub colouring: Colouring,
    /// Makes one that runs on the processor.
    make: fn() -> Box<dyn PaintModel>,
}

/// Strength of dAb's embossing, encoded channel by metre.
const EMBOSS: f32 = 250.0;

/// Name that leaves the choice of a new painting's model to the rig.
pub const AUTO: &str = "auto";
/// The model that [`AUTO`] begins with, and the lighter one that it proposes where painting falls behind.
pub const AUTO_MODELS: [&str; 2] = ["impasto", "dab"];

/// All paint models.
pub static MODELS: [ModelEntry; 4] = [
    ModelEntry {
        name: "impasto",
        shown: &Counted,
        colouring: Colouring::Films,
        make: || Box::new(Impasto::default()),
    },
    ModelEntry {
        name: "dab",
        shown: &Layers { emboss: EMBOSS },
        colouring: Colouring::Volumes,
        make: || Box::new(Dab::default()),
    },
    ModelEntry {
        name: "stokes",
        shown: &Overhangs,
        colouring: Colouring::Films,
        make: || Box::new(StokesPaint::default()),
    },
    ModelEntry {
        name: "marker",
        shown: &Matte,
        colouring: Colouring::Films,
        make: || Box::new(Marker::default()),
    },
];

/// Names of the paint models.
pub fn model_names() -> impl Iterator<Item = &'static str> + Clone {
    MODELS.iter().map(|entry| entry.name)
}

/// The model of this name.
///
/// # Errors
/// [`EditError::NoModel`] with the known names.
pub fn model_called(name: &str) -> Result<&'static ModelEntry, EditError> {
    let found = MODELS.iter().find(|entry| entry.name == name);
    found.ok_or_else(|| EditError::NoModel {
        name: name.to_owned(),
        known: model_names().collect(),
    })
}

impl fmt::Debug for ModelEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ModelEntry").field(&self.name).finish()
    }
}

/// The models at work in a painting, each made when a surface first needs it.
#[derive(Default)]
pub(crate) struct Models(BTreeMap<&'static str, Box<dyn PaintModel>>);

impl Models {
    /// The model of a surface.
    pub(crate) fn of(&mut self, entry: &ModelEntry) -> &mut dyn PaintModel {
        self.0.entry(entry.name).or_insert_with(entry.make).as_mut()
    }

    /// Replaces the model of the same name, for another backend.
    pub(crate) fn replace(&mut self, model: Box<dyn PaintModel>) {
        self.0.insert(model.name(), model);
    }

    /// Backend of a model's steps.
    pub(crate) fn backend(&self, entry: &ModelEntry) -> String {
        let model = self.0.get(entry.name);
        model.map_or_else(|| (entry.make)().backend(), |model| model.backend())
    }

    /// Reason why a model changed its backend; returned once.
    pub(crate) fn take_fall(&mut self) -> Option<String> {
        self.0.values_mut().find_map(|model| model.take_fall())
    }

    /// Limit of its backend that a model has met; returned once.
    pub(crate) fn take_limit(&mut self) -> Option<Decision> {
        self.0.values_mut().find_map(|model| model.take_limit())
    }
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
    fn what_auto_chooses_and_proposes_is_there() {
        assert!(
            AUTO_MODELS
                .into_iter()
                .all(|name| model_called(name).is_ok())
        );
        assert!(model_called(AUTO).is_err(), "no surface has it");
    }

    #[test]
    fn an_unknown_name_is_told_with_those_that_there_are_and_the_nearest() {
        let error = model_called("impatso").expect_err("unknown");
        assert!(error.to_string().contains("'impatso'"), "{error:?}");
        let advice = |error: EditError| error.advice().to_string();
        assert!(advice(error).contains("did you mean 'impasto'"));
        assert!(model_called("oil").is_err_and(|error| advice(error).contains("marker")));
    }
}
