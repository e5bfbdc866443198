//! The paint that a brush carries, as a painter looks at it: the tip from left to right, and how full it is.

use glam::Vec3;
use maulstick_brush::Head;

use crate::render::brush::paint_colour::PaintColour;

/// Columns of the tip.
const COLUMNS: usize = 12;

/// The paint that a brush carries.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedPaint {
    /// Colours of its tip from left to right, linear.
    pub colours: Vec<Vec3>,
    /// Its paint by that of a fully loaded brush, 0 to 1.
    pub load_share: f32,
}

impl CarriedPaint {
    /// The paint of a head.
    #[must_use]
    pub fn of(coat: &PaintColour, head: &Head) -> Self {
        Self {
            colours: coat.across(head, COLUMNS),
            load_share: coat.load_share(),
        }
    }
}
