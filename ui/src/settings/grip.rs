//! How the mouse holds the brush.

/// Turn and pressure of the brush that a mouse moves: it has neither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grip {
    /// True if the broad side of the brush stays across the stroke.
    pub follows: bool,
    /// Turn of the brush, from there or from left to right, rad.
    pub turn_rad: f64,
    /// Pressure of a pressed button, 0 to 1.
    pub pressure: f64,
}
