//! The stages of dAb: those of a step, of each drawing of the head in it, and of each blend of a drawing.

use crate::touching::BRIDGED;
use crate::volume::{MOST, UNIT};

use maulstick_gpu::steps::kernels::{Binding as B, Groups, Kernel, RASTERIZER};

/// Shared WGSL of the model's stages.
const COMMON: &str = include_str!("shaders/common/blend.wgsl");

/// Kernels. A step runs [`WEIGH`], for each of its drawings [`DRAW`] and a [`BLEND`] a place, [`NEXT_DRAWING`] between two
/// drawings, and [`REFILL`].
pub(crate) static KERNELS: [Kernel; 7] = [
    Kernel {
        name: "weigh",
        source: &[COMMON, include_str!("shaders/weigh.wgsl")],
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
        source: &[COMMON, include_str!("shaders/draw_cells.wgsl")],
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
        source: &[COMMON, include_str!("shaders/blend.wgsl")],
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
        source: &[COMMON, include_str!("shaders/give_back.wgsl")],
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Strips,
    },
    Kernel {
        name: "next_drawing",
        source: &[COMMON, include_str!("shaders/next_drawing.wgsl")],
        constants: &[],
        bindings: &[B::Keys, B::Stats],
        groups: Groups::Grid,
    },
    Kernel {
        name: "refill",
        source: &[COMMON, include_str!("shaders/refill.wgsl")],
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
