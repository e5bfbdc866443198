//! Faults that latch the force at zero until the servo is re-armed.

/// A latched fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A reading or a force was not a number.
    NotANumber,
    /// The hand was faster than a human hand, with force on it.
    TooFast,
    /// The hand kept shaking at the softest force.
    Oscillation,
    /// The force state of an earlier servo could not be read.
    UnknownState,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NotANumber => "a reading or a force was not a number",
            Self::TooFast => "the hand was faster than its limit",
            Self::Oscillation => "the hand kept shaking at the softest force",
            Self::UnknownState => "the saved force state cannot be read, so force is switched off",
        })
    }
}
