//! The stages of dAb: those of a step, of each drawing of the head in it, and of each blend of a drawing.

use maulstick_dab::touching::BRIDGED;
use maulstick_dab::volume::{MOST, UNIT};

use crate::steps::kernels::{Binding as B, Groups, Kernel, RASTERIZER, source};

/// Kernels. A step runs [`WEIGH`], for each of its drawings [`DRAW`] and a [`BLEND`] a place, [`NEXT_DRAWING`] between two
/// drawings, and [`REFILL`].
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

/// Weighs films and wet paint, once a step.
pub(crate) const WEIGH: usize = 0;
/// Draws the head: rasterizer, then cells.
pub(crate) const DRAW: [usize; 2] = [1, 2];
/// Blends the drawn head with the canvas at one place.
pub(crate) const BLEND: usize = 3;
/// Gives the films of cells back to their texels and clears the grid, between two drawings.
pub(crate) const NEXT_DRAWING: [usize; 2] = [4, 5];
/// Gives back the films of the last drawing, and refills the brush's surface from its reservoirs.
pub(crate) const REFILL: usize = 6;
