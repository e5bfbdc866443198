//! Form of an edit in a script and on the command line.

#[cfg(feature = "cli")]
use maulstick_types::Edit;
use maulstick_types::EditFields;
use maulstick_types::values::ValueError;

use super::PaintingEdit;

/// Form of an edit as a step of a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepForm {
    /// Key of the step.
    pub key: &'static str,
    /// True if that key takes `true` alone.
    pub switch: bool,
    /// The keys that say how.
    pub with: &'static [&'static str],
    /// Examples, the first of which is [`Form::example`].
    pub example: &'static str,
}

impl StepForm {
    /// A step whose key has a value.
    #[must_use]
    pub const fn new(
        key: &'static str,
        with: &'static [&'static str],
        example: &'static str,
    ) -> Self {
        Self {
            key,
            switch: false,
            with,
            example,
        }
    }

    /// A step whose key takes `true` alone.
    #[must_use]
    pub const fn switch(
        key: &'static str,
        with: &'static [&'static str],
        example: &'static str,
    ) -> Self {
        Self {
            switch: true,
            ..Self::new(key, with, example)
        }
    }
}

/// Form of an edit as a command of a group.
#[cfg(feature = "cli")]
#[derive(Clone, Copy, Debug)]
pub struct CommandForm {
    /// Name of the command.
    pub name: &'static str,
    /// Name of the group of commands that it belongs to.
    pub group: &'static str,
    /// Adds its options.
    pub augment: fn(clap::Command) -> clap::Command,
    /// Reads them.
    pub read: fn(&clap::ArgMatches) -> Result<Edit, clap::Error>,
}

#[cfg(feature = "cli")]
impl CommandForm {
    /// A command whose options are those of `T`.
    #[must_use]
    pub const fn of<T: clap::Args + Into<Edit>>(name: &'static str, group: &'static str) -> Self {
        Self {
            name,
            group,
            augment: T::augment_args,
            read: |matches| T::from_arg_matches(matches).map(Into::into),
        }
    }
}

/// Form of an edit, defined in the edit's own file.
pub trait Form: EditFields + PaintingEdit {
    /// Its steps in scripts; empty if scripts do not have it.
    const STEPS: &'static [StepForm];
    /// Words of the command line that means [`example`](Self::example), without the program; `None` if there is none.
    const ARGUMENTS: Option<&'static [&'static str]>;
    /// Its command; `None` if it has none of its own.
    #[cfg(feature = "cli")]
    const COMMAND: Option<CommandForm> = None;

    /// One of its kind, for tests and documents.
    ///
    /// # Errors
    /// None, if it is in range.
    fn example() -> Result<Self, ValueError>;

    /// Reads a step of a script.
    ///
    /// # Errors
    /// Those of its fields.
    fn read_step<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        <Self as serde::Deserialize>::deserialize(from)
    }
}
