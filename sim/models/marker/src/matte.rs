//! Appearance of ink: films of its paints, without gloss.

use maulstick_appearance::display::DisplayTile;
use maulstick_appearance::show_paint::{Seen, ShowPaint};

/// Ink soaks into its ground and is matt, wet or dry.
#[derive(Clone, Copy, Debug)]
pub struct Matte;

impl ShowPaint for Matte {
    fn finish(&self, _seen: &Seen<'_>, shown: &mut DisplayTile) {
        shown.gloss.fill(0.0);
    }
}
