//! How the mouse holds the brush.

/// Turn and pressure of the mouse's brush; a mouse senses neither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grip {
    /// True if the broad side of the brush stays across the stroke.
    pub follows: bool,
    /// Turn of the broad side, rad, counter-clockwise: from across the stroke if it follows, else from the desk's x axis.
    pub turn_rad: f64,
    /// Pressure of a pressed button, 0 to 1.
    pub pressure: f64,
}
