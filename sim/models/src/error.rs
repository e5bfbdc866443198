//! Error of a model's name.

use maulstick_types::command::advice::Advice;
use maulstick_types::nearest::choice;

/// A name that no paint model has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no paint model called '{name}'")]
pub struct NoModel {
    /// The name.
    pub name: String,
    /// Those that there are.
    pub known: Vec<&'static str>,
}

impl NoModel {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        Advice::say(choice(&self.name, self.known.iter().copied()))
    }
}
