//! Lead of a pen: an offset of the handle that brings the mark under the pen's point.
//!
//! A pen or a mouse gives a point of the surface, and the painter looks there; but a head that is pressed down bends,
//! and touches beside the point where the handle's axis meets the surface. So the handle stands beside the point, as in
//! a hand that watches the mark: at the first touch by the mark's offset, then as [`Beside`](crate::mark::Beside) gives
//! it for the pose, and the rest, for example of the drag, is taken back along the path.

use glam::DVec2;
use maulstick_num::exp;

/// Way along which the share 1 − 1/e of what is left is taken back, m.
const BACK_M: f64 = 1e-3;
/// Largest change of the lead along a path, in lengths of the path.
const STEEPEST_LEAD: f64 = 4.0;

/// Offset of a pen's handle from its point, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lead {
    /// In all.
    pub shift: DVec2,
    /// Of it, what the table does not say.
    rest: DVec2,
}

impl Lead {
    /// Lead of a pen that is set down, whose mark is `beside` its point, where the table gives `tabled`.
    #[must_use]
    pub fn landed(beside: DVec2, tabled: DVec2) -> Self {
        Self {
            shift: -beside,
            rest: tabled - beside,
        }
    }

    /// Continues along a path at the end of which the mark is `beside` the point although the handle is led; `tabled`
    /// as in [`landed`](Self::landed).
    pub fn go(&mut self, beside: DVec2, tabled: DVec2, way_m: f64, length_m: f64) {
        self.rest += beside * (exp(-way_m / BACK_M) - 1.0);
        self.rest = self.rest.clamp_length_max(0.5 * length_m);
        let lacking = self.rest - tabled - self.shift;
        self.shift += lacking.clamp_length_max(STEEPEST_LEAD * way_m);
    }
}
