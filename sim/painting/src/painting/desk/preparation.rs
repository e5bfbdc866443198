//! Preparation of surfaces: size that stains, piles that last, a palette that fills brushes (Baxter 2004, § 6.4.1, 6.8).

use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::Transfer;
use maulstick_types::scene::{PALETTE, Surface};

/// Share of a film's deficit filled from inside, and of its surplus returned, at each flow in a brush on the palette,
/// on reference cells: there it is filled through.
const REFILL_SHARE: f64 = 0.6;
/// Factor on the path length where a brush is filled: it is stirred and turned.
const STIRRED: f32 = 4.0;

/// Preparation of a surface for a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preparation {
    /// Quanta that stay on a cell.
    pub(crate) stain: f32,
    /// True if paint that is taken up stays there all the same.
    pub(crate) lasting: bool,
    /// True if brushes are filled on it.
    fills: bool,
}

impl Preparation {
    pub(crate) fn of(surface: &Surface) -> Self {
        Self {
            stain: (surface.stain_m / QUANTUM_M) as f32,
            lasting: surface.piles_last,
            fills: surface.id == PALETTE,
        }
    }

    /// Traits of a brush on it; one that is stirred is used to take paint up.
    pub(crate) fn traits(&self, traits: BrushTraits, transfer: Transfer) -> BrushTraits {
        let stirred = matches!(transfer, Transfer::Paint | Transfer::Sponge);
        if !(self.fills && stirred) {
            return traits;
        }
        BrushTraits {
            refill: 1.0
                - maulstick_num::powf(1.0 - REFILL_SHARE, f64::from(traits.cell_per_reference)),
            cell_per_reference: STIRRED * traits.cell_per_reference,
            ..traits
        }
    }
}
