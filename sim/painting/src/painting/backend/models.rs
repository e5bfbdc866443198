//! The paint models at work in a painting.

use std::collections::BTreeMap;

use maulstick_model::interface::PaintModel;
use maulstick_models::ModelEntry;
use maulstick_types::paint::Decision;

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
    pub(crate) fn take_backend_change(&mut self) -> Option<String> {
        self.0
            .values_mut()
            .find_map(|model| model.take_backend_change())
    }

    /// Limit of its backend that a model has met; returned once.
    pub(crate) fn take_limit(&mut self) -> Option<Decision> {
        self.0.values_mut().find_map(|model| model.take_limit())
    }
}
