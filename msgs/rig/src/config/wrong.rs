//! A wrong value of `rig.toml`, and its line.

use crate::user_error::UserError;

/// A wrong value.
pub(super) struct Wrong {
    /// The defect.
    pub(super) what: String,
    /// Key by which its line is found.
    pub(super) key: &'static str,
    /// Value by which its line is found; empty if the key is enough.
    pub(super) value: String,
    /// Advice.
    pub(super) help: String,
}

impl Wrong {
    /// The error, with its line in the text of the file called `name`.
    pub(super) fn fault(self, text: &str, name: &str) -> UserError {
        UserError::usage(self.what)
            .at(format!("{name}:{}", line_of(text, self.key, &self.value)))
            .help(self.help)
    }

    /// The value of `key` in the section called `owner`.
    pub(super) fn value(
        owner: &str,
        key: &'static str,
        value: impl std::fmt::Debug,
        help: &str,
    ) -> Self {
        Self {
            what: format!("{key} = {value:?} of '{owner}'"),
            key,
            value: String::new(),
            help: help.into(),
        }
    }
}

/// The line, from 1, on which `key` and `value` first stand together: one that begins with the key, or else any.
pub(super) fn line_of(text: &str, key: &str, value: &str) -> usize {
    let is_key = |line: &str| {
        let rest = line.trim_start().strip_prefix(key);
        rest.is_some_and(|rest| {
            !rest.starts_with(|next: char| next.is_alphanumeric() || next == '_')
        })
    };
    let begins = text
        .lines()
        .position(|line| is_key(line) && line.contains(value));
    let holds = |line: &str| line.contains(key) && line.contains(value);
    let place = begins.or_else(|| text.lines().position(holds));
    place.map_or(1, |place| place + 1)
}
