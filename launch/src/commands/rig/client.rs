//! The rig of a command, and its client there.

use clap::Args;

pub use maulstick_client::connection::{Client, Feed};

/// Options that select the rig of a command.
#[derive(Args, Clone, Debug)]
pub struct Target {
    /// Name of the rig
    #[arg(long, value_name = "RIG", default_value = "studio")]
    name: String,
}

impl Target {
    /// Name of the rig.
    #[must_use]
    pub fn rig(&self) -> &str {
        &self.name
    }

    /// The rig called `name`.
    #[must_use]
    pub fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
        }
    }
}

impl AsRef<str> for Target {
    fn as_ref(&self) -> &str {
        &self.name
    }
}
