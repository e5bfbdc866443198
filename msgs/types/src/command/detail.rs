//! Results of commands.

use std::fmt;

use crate::mixture::Mixture;
use crate::paint::StepName;
use crate::scene::Layer;
use crate::wire::define::wire_enum;
use crate::wire::worded::{Worded, words_alternative};

wire_enum! {
    /// Result of a command. A window has its own words for it; logs and command lines use `Display`.
    pub enum Detail {
        /// Nothing to report.
        Nothing,
        /// The step that was undone or redone, or to which the history went.
        Step {
            /// Its name.
            name: StepName,
        },
        /// The layer into which paint has dried.
        Dried {
            /// The layer.
            layer: Layer,
        },
        /// The mixture that a brush has taken up.
        Loaded {
            /// The mixture.
            mixture: Mixture,
        },
        /// A sentence, or a file's path.
        Words {
            /// The words.
            words: String,
        },
    }
}

impl Detail {
    /// These words; nothing to report if they are empty.
    #[must_use]
    pub fn say(words: impl Into<String>) -> Self {
        let words = words.into();
        if words.is_empty() {
            Self::Nothing
        } else {
            Self::Words { words }
        }
    }
}

impl fmt::Display for Detail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => Ok(()),
            Self::Step { name } => name.fmt(f),
            Self::Loaded { mixture } => {
                for (place, part) in mixture.without_traces().parts.iter().enumerate() {
                    let comma = if place == 0 { "" } else { "," };
                    write!(f, "{comma}{}={:.3}", part.paint, part.share)?;
                }
                Ok(())
            }
            Self::Dried { layer } => f.write_str(&layer.name),
            Self::Words { words } => f.write_str(words),
        }
    }
}

impl Worded for Detail {
    /// The words themselves: a reply is kept to be repeated, not to be read.
    fn of_words(words: &str) -> Self {
        Self::say(words)
    }

    words_alternative!();
}
