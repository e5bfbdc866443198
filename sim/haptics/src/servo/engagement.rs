//! Engagement of a force. Given to a hand that is deep in the canvas it would push it out; so it begins where little is asked
//! for, and a hand that stays deep feels nothing until it has come up.

/// Ticks in which little must be asked for before force begins: one alone may be chance.
pub(super) const CALM_TICKS: u32 = 4;

/// Stage of an engagement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Consecutive ticks in which little was asked for.
    Waiting(u32),
    /// Force has begun.
    Begun,
}

/// Whether force has begun, and the ramp by which it comes up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Engagement {
    stage: Stage,
    /// Time since the ramp began, s.
    ramp_s: f64,
}

impl Engagement {
    /// Before any tick.
    pub(super) const NEW: Self = Self {
        stage: Stage::Waiting(0),
        ramp_s: 0.0,
    };

    /// True once force has begun.
    pub(super) fn has_begun(&self) -> bool {
        self.stage == Stage::Begun
    }

    /// Waits anew until little is asked for.
    pub(super) fn wait_anew(&mut self) {
        self.stage = Stage::Waiting(0);
    }

    /// Begins the ramp anew.
    pub(super) fn ramp_anew(&mut self) {
        self.ramp_s = 0.0;
    }

    /// The ramp goes on by a tick.
    pub(super) fn age(&mut self, dt: f64) {
        self.ramp_s += dt;
    }

    /// Share of the force along a ramp of `whole_s`, 0 to 1.
    pub(super) fn ramp(&self, whole_s: f64) -> f64 {
        (self.ramp_s / whole_s).min(1.0)
    }

    /// True until force begins, after a tick in which `asked_n` was asked for: NaN if nothing is known of it. Force
    /// begins where `most_n` at most is asked for; with a bound that is NaN it never does. The ramp begins with the force.
    pub(super) fn waits(&mut self, asked_n: f64, most_n: f64) -> bool {
        let Stage::Waiting(calm) = self.stage else {
            return false;
        };
        self.stage = if asked_n <= most_n {
            if calm + 1 >= CALM_TICKS {
                Stage::Begun
            } else {
                Stage::Waiting(calm + 1)
            }
        } else {
            Stage::Waiting(0)
        };
        self.ramp_anew();
        true
    }
}
