//! The stages of dAb: those of a step, of each drawing of the head in it, and of each blend of a drawing.

use maulstick_dab::touching::BRIDGED;
use maulstick_dab::volume::{MOST, UNIT};

use crate::steps::kernels::{
    BOUND_HEAD, Binding as B, Groups, Kernel, RASTERIZER, WEIGH_FILMS, source,
};

/// The stages; a step does [`BEGINS`], those of [`DRAWS`] for each drawing and [`BLENDS`] for each of its blends, then
/// [`GIVES_BACK`], and [`ENDS`].
pub(crate) static KERNELS: [Kernel; 9] = [
    WEIGH_FILMS,
    Kernel {
        name: "weigh_canvas",
        source: source!("dab/weigh_canvas", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Planes, B::Base, B::Keys, B::Stats, B::Blend],
        groups: Groups::Grid,
    },
    BOUND_HEAD,
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
        name: "plan_blends",
        source: source!("dab/plan_blends", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Stats, B::Groups],
        groups: Groups::One,
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
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "give_back",
        source: source!("dab/give_back", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Planned(1),
    },
    Kernel {
        name: "refill",
        source: source!("dab/refill", "dab/common/blend"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats, B::Blend],
        groups: Groups::Segments,
    },
];

/// How thick films are, and how high paint stands.
pub(crate) const BEGINS: [usize; 2] = [0, 1];
/// The head is drawn.
pub(crate) const DRAWS: [usize; 4] = [2, 3, 4, 5];
/// It is blended with the canvas at one place.
pub(crate) const BLENDS: usize = 6;
/// Texels get what their cells hold.
pub(crate) const GIVES_BACK: usize = 7;
/// Reservoirs.
pub(crate) const ENDS: usize = 8;
