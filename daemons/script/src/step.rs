//! A step as it is written, and what it is one of.

use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::StepForm;
use maulstick_rig::UserError;

use crate::Act;
use crate::entries::Entries;

/// Reader of a step.
pub(super) type Read = fn(&Step<'_>, &PaintLibrary) -> Result<Act, UserError>;

/// Reader of a step with files, changes and counts, which an edit does not hold; `None` where it has none of them.
pub(super) type More = fn(&Step<'_>) -> Result<Option<Act>, UserError>;

/// A kind of step.
#[derive(Debug)]
pub(super) struct Kind {
    /// Its keys.
    pub(super) form: StepForm,
    /// What reads one.
    pub(super) act: Read,
    /// What reads one that says more than its edit holds.
    pub(super) more: Option<More>,
}

impl Kind {
    /// The keys that it takes, as help.
    pub(super) fn takes(&self) -> String {
        if self.form.with.is_empty() {
            format!("'{}' takes no other key", self.form.key)
        } else {
            format!("'{}' takes: {}", self.form.key, self.form.with.join(", "))
        }
    }
}

/// A step as it is written.
#[derive(Debug)]
pub(super) struct Step<'a> {
    /// What it is one of.
    pub(super) kind: &'static Kind,
    /// Its keys.
    pub(super) keys: Entries<'a>,
}

impl Step<'_> {
    /// File and line.
    pub(super) fn place(&self) -> String {
        self.keys.place(self.kind.form.key)
    }

    /// Value of a required key: it makes the step one of its kind, or is reported as missing.
    pub(super) fn due<T>(&self, value: Option<T>) -> Result<T, UserError> {
        value.ok_or_else(|| UserError::usage(format!("'{}' lacks a key", self.kind.form.key)))
    }
}
