//! The stages of dAb: those of a step, of each drawing of the head in it, and of each blend of a drawing.

use maulstick_dab::touching::BRIDGED;
use maulstick_dab::volume::{MOST, UNIT};

use crate::steps::kernels::{Binding as B, Groups, Kernel, RASTERIZER, source};

/// The stages; a step does [`BEGINS`], those of [`DRAWS`] and [`BLENDS`] for each of its drawings, [`GOES_ON`] between two of
/// them, and [`ENDS`].
pub(crate) static KERNELS: [Kernel; 7] = [
    Kernel {
        name: "weigh",
        source: source!("dab/weigh", "dab/common/blend"),
        constants: &[],
        bindings: &[
            B::Planes,
            B::Base,
            B::Load,
            B::Asks,
            B::Keys,
            B::Stats,
            B::Blend,
        ],
        groups: Groups::GridAndStrips,
    },
    RASTERIZER,
    Kernel {
        name: "draw_cells",
        source: source!("dab/draw_cells", "dab/common/blend"),
        constants: &[],
        bindings: &[
            B::Poses,
            B::Head,
            B::Segments,
            B::Asks,
            B::Keys,
            B::Contacts,
            B::Stats,
            B::Blend,
        ],
        groups: Groups::Grid,
    },
    Kernel {
        name: "blend",
        source: source!("dab/blend", "dab/common/blend"),
        constants: &[
            ("UNIT", UNIT as f64),
            ("MOST_UNITS", MOST as f64),
            ("BRIDGED", BRIDGED as f64),
        ],
        bindings: &[
            B::Planes,
            B::Other,
            B::Base,
            B::Load,
            B::Asks,
            B::Contacts,
            B::Stats,
            B::Blend,
        ],
        groups: Groups::Grid,
    },
    Kernel {
        name: "give_back",
        source: source!("dab/give_back", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Strips,
    },
    Kernel {
        name: "next_drawing",
        source: source!("dab/next_drawing", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Keys, B::Stats],
        groups: Groups::Grid,
    },
    Kernel {
        name: "refill",
        source: source!("dab/refill", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats, B::Blend],
        groups: Groups::Strips,
    },
];

/// How thick films are, and how high paint stands.
pub(crate) const BEGINS: usize = 0;
/// The head is drawn.
pub(crate) const DRAWS: [usize; 2] = [1, 2];
/// It is blended with the canvas at one place.
pub(crate) const BLENDS: usize = 3;
/// Texels get what their cells hold, and the next drawing begins.
pub(crate) const GOES_ON: [usize; 2] = [4, 5];
/// The last drawing's texels get it, and reservoirs fill them again.
pub(crate) const ENDS: usize = 6;
