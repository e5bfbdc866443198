//! Engagement of a force. Given to a hand that is deep in the canvas it would push it out; so it begins where little is asked
//! for, and a hand that stays deep feels nothing until it has come up.

/// Ticks in which little must be asked for before force begins: one alone may be chance.
pub(super) const CALM_TICKS: u32 = 4;

/// Whether force has begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Engagement {
    /// Consecutive ticks in which little was asked for.
    Waiting(u32),
    /// It has.
    Begun,
}

impl Engagement {
    /// Before any tick.
    pub(super) const ANEW: Self = Self::Waiting(0);

    /// True until force begins, after a tick in which `asked_n` was asked for: not a number if nothing is known of it. Force
    /// begins where `most_n` at most is asked for; with a bound that is no number it never does.
    pub(super) fn waits(&mut self, asked_n: f64, most_n: f64) -> bool {
        let Self::Waiting(calm) = *self else {
            return false;
        };
        *self = match asked_n <= most_n {
            true if calm + 1 >= CALM_TICKS => Self::Begun,
            true => Self::Waiting(calm + 1),
            false => Self::ANEW,
        };
        true
    }
}
