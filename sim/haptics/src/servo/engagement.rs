//! Begin of a force. A hand deep in the canvas would be pushed out, so force begins where the models ask for little,
//! and a hand that stays deep gets none until it has come up.

/// Consecutive ticks with a small request before force begins: one alone may be chance.
pub(super) const CALM_TICKS: u32 = 4;

/// Stage of an engagement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Number of consecutive ticks with a small request.
    Waiting(u32),
    /// Force has begun.
    Begun,
}

/// Stage of the engagement, and the ramp of the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Engagement {
    stage: Stage,
    /// Time since the ramp began, s.
    ramp_s: f64,
}

impl Engagement {
    /// State before any tick.
    pub(super) const NEW: Self = Self {
        stage: Stage::Waiting(0),
        ramp_s: 0.0,
    };

    /// True once force has begun.
    pub(super) fn has_begun(&self) -> bool {
        self.stage == Stage::Begun
    }

    /// Waits again for a small request.
    pub(super) fn wait_anew(&mut self) {
        self.stage = Stage::Waiting(0);
    }

    /// Restarts the ramp.
    pub(super) fn ramp_anew(&mut self) {
        self.ramp_s = 0.0;
    }

    /// Advances the ramp by a tick.
    pub(super) fn age(&mut self, dt: f64) {
        self.ramp_s += dt;
    }

    /// Share of the force along a ramp of `whole_s`, 0 to 1.
    pub(super) fn ramp(&self, whole_s: f64) -> f64 {
        (self.ramp_s / whole_s).min(1.0)
    }

    /// True until force begins, after a tick in which `asked_n` was requested, NaN if unknown. Force begins where at
    /// most `most_n` is requested, never with a bound that is NaN, and starts the ramp.
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
