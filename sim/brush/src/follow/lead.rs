//! Lead of a pen: an offset of the handle that brings the mark under the pen's point.
//!
//! A pen or a mouse gives a point of the surface, and the painter looks there; but a pressed head bends, and touches
//! beside the point where the handle's axis meets the surface. So the handle stands beside the point, as in the hand
//! of a painter who watches the mark. At the first touch the offset is that of the mark. Later it is the table's,
//! [`Beside`](crate::mark::Beside), for the pose; the remainder, for example from drag, decays along the path.

use glam::DVec2;
use maulstick_num::exp;

/// Path length over which the remainder of the lead decays to 1/e, m.
const BACK_M: f64 = 1e-3;
/// Largest change of the lead along a path, in lengths of the path.
const STEEPEST_LEAD: f64 = 4.0;

/// Offset of a pen's handle from its point, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lead {
    /// Whole offset.
    pub shift: DVec2,
    /// Part of the offset beyond the table's.
    rest: DVec2,
}

impl Lead {
    /// Lead of a pen at its first touch, with its mark `beside` its point; `tabled` is the table's offset.
    #[must_use]
    pub fn landed(beside: DVec2, tabled: DVec2) -> Self {
        Self {
            shift: -beside,
            rest: tabled - beside,
        }
    }

    /// Updates the lead after `way_m` of a path, at the end of which the mark is `beside` the point despite the lead;
    /// `tabled` as in [`landed`](Self::landed).
    pub fn go(&mut self, beside: DVec2, tabled: DVec2, way_m: f64, length_m: f64) {
        self.rest += beside * (exp(-way_m / BACK_M) - 1.0);
        self.rest = self.rest.clamp_length_max(0.5 * length_m);
        let lacking = self.rest - tabled - self.shift;
        self.shift += lacking.clamp_length_max(STEEPEST_LEAD * way_m);
    }
}
