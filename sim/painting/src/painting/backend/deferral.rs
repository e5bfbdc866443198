//! Progress of a brush's deferred steps.

/// Largest number of deferred steps. The fullness of the brush is read just when they are settled: the time at which a
/// caller looks at the painting must not matter.
const SETTLE_EVERY: u32 = 256;

/// Progress of the deferred steps of a brush.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Deferral {
    /// Deferred steps since its stroke began.
    steps: u32,
    /// Number of them that are unsettled.
    unsettled: u32,
    /// Fullness of the brush when it was last read.
    pub(in crate::painting) fullness: Option<f32>,
}

impl Deferral {
    /// Deferred steps that are not settled.
    pub(in crate::painting) fn unsettled(&self) -> u32 {
        self.unsettled
    }

    /// Counts a step; true where all are to be settled, and the fullness read anew.
    pub(in crate::painting) fn count(&mut self) -> bool {
        self.steps += 1;
        self.unsettled += 1;
        let is_due = self.steps.is_multiple_of(SETTLE_EVERY);
        if is_due {
            self.fullness = None;
        }
        is_due
    }

    /// All steps are settled; returns their number.
    pub(in crate::painting) fn settle(&mut self) -> u32 {
        std::mem::take(&mut self.unsettled)
    }
}
