//! Decisions of the paint node.

use std::fmt;

use crate::wire::define::wire_enum;
use crate::wire::worded::{Worded, words_alternative};

wire_enum! {
    /// A decision of the paint node itself. A window has its own words for it; the log of a painting uses `Display`.
    #[derive(Eq)]
    pub enum Decision {
        /// Backend that computes the paint.
        Backend {
            /// `cpu`, or `gpu` and the adapter's name.
            name: String,
        },
        /// Backend that computes the paint from now on, because the one before has failed.
        Fallback {
            /// As that of `Backend`.
            name: String,
            /// Error of the backend before.
            why: String,
        },
        /// Flow is found on coarser cells, for the backend has no room for the window.
        CoarserFlow {
            /// Error of the backend.
            why: String,
        },
        /// The painting continues after its program ended: its brushes' last contacts are not joined to their next ones.
        Resumed,
        /// Painting falls behind, and a lighter paint model is proposed.
        LighterModel {
            /// Its name.
            model: String,
        },
        /// A decision that only another version knows.
        Words {
            /// Its words.
            words: String,
        },
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Backend { name } => write!(f, "backend {name}"),
            Self::Fallback { name, why } => write!(f, "backend {name}: {why}"),
            Self::CoarserFlow { why } => write!(f, "flow on coarser cells: {why}"),
            Self::Resumed => f.write_str("the painting goes on"),
            Self::LighterModel { model } => write!(f, "model {model} proposed"),
            Self::Words { words } => f.write_str(words),
        }
    }
}

impl Worded for Decision {
    fn of_words(words: &str) -> Self {
        let between = |before: &str, after: &str| {
            let rest = words.strip_prefix(before)?.strip_suffix(after)?;
            Some(rest.to_owned())
        };
        // A device that failed was always followed by the processor.
        if let Some(why) = between("backend cpu: ", "") {
            let name = "cpu".to_owned();
            Self::Fallback { name, why }
        } else if let Some(name) = between("backend ", "") {
            Self::Backend { name }
        } else if let Some(why) = between("flow on coarser cells: ", "") {
            Self::CoarserFlow { why }
        } else if let Some(model) = between("model ", " proposed") {
            Self::LighterModel { model }
        } else if words == "the painting goes on" {
            Self::Resumed
        } else {
            let words = words.to_owned();
            Self::Words { words }
        }
    }

    words_alternative!();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decision_in_words_is_the_same_decision() {
        let text = str::to_owned;
        let name = || text("gpu A: B");
        let why = || text("a window needs 3 MiB");
        for decision in [
            Decision::Backend { name: text("cpu") },
            Decision::Backend { name: name() },
            Decision::Fallback {
                name: text("cpu"),
                why: why(),
            },
            Decision::CoarserFlow { why: why() },
            Decision::Resumed,
            Decision::LighterModel { model: text("dab") },
            Decision::Words {
                words: text("none of these"),
            },
        ] {
            assert_eq!(Decision::of_words(&decision.to_string()), decision);
        }
    }
}
