//! The stages of impasto in their order.

use maulstick_impasto::stages::velocity::{EASE, SLIP, SQUISH, STABLE};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::transfer::{POOL, SWAP_FILM};

use crate::steps::kernels::{Binding as B, Groups, Kernel, RASTERIZER, source};

/// The stage that pushes paint along an axis.
pub(crate) const PUSHES: &str = "advection";

/// The stages of a step, in order.
pub(crate) static KERNELS: [Kernel; 14] = [
    Kernel {
        name: "weigh_films",
        source: source!("impasto/weigh_films", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "bound_head",
        source: source!("impasto/bound_head", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Poses, B::Head, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "weigh_grid",
        source: source!("impasto/weigh_grid", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Planes, B::Base, B::Keys, B::Totals, B::Stats],
        groups: Groups::Grid,
    },
    RASTERIZER,
    Kernel {
        name: "footprint",
        source: source!("impasto/footprint", "impasto/common/axes"),
        constants: &[
            ("SQUISH", SQUISH as f64),
            ("STABLE", STABLE as f64),
            ("SLIP", SLIP as f64),
            ("EASE", EASE as f64),
        ],
        bindings: &[
            B::Poses,
            B::Head,
            B::Segments,
            B::Load,
            B::Keys,
            B::Contacts,
            B::Totals,
            B::Stats,
        ],
        groups: Groups::Grid,
    },
    Kernel {
        name: "plan_step",
        source: source!("impasto/plan_step", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Load, B::Stats, B::Groups],
        groups: Groups::One,
    },
    Kernel {
        name: "velocity",
        source: source!("impasto/velocity", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Contacts, B::Faces],
        groups: Groups::Planned(4),
    },
    Kernel {
        name: PUSHES,
        source: source!("impasto/advection", "impasto/common/axes"),
        constants: &[("second", 0.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(2),
    },
    Kernel {
        name: PUSHES,
        source: source!("impasto/advection", "impasto/common/axes"),
        constants: &[("second", 1.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(3),
    },
    Kernel {
        name: "exchange_ask",
        source: source!("impasto/exchange_ask", "impasto/common/axes"),
        constants: &[("SWAP_FILM", SWAP_FILM as f64), ("POOL", POOL as f64)],
        bindings: &[B::Load, B::Asks, B::Contacts, B::Totals, B::Wants],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "exchange_apply",
        source: source!("impasto/exchange_apply", "impasto/common/axes"),
        constants: &[],
        bindings: &[
            B::Planes,
            B::Load,
            B::Asks,
            B::Contacts,
            B::Totals,
            B::Wants,
            B::Stats,
        ],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "bristle_flow",
        source: source!("impasto/bristle_flow", "impasto/common/axes"),
        constants: &[],
        bindings: &[B::Head, B::Load, B::Asks],
        groups: Groups::Planned(1),
    },
    seep(&[("second", 0.0), ("HOLDS", BrushTraits::HOLDS)]),
    seep(&[("second", 1.0), ("HOLDS", BrushTraits::HOLDS)]),
];

const fn seep(constants: &'static [(&'static str, f64)]) -> Kernel {
    Kernel {
        name: "seep",
        source: source!("impasto/seep", "impasto/common/axes"),
        constants,
        bindings: &[B::Head, B::Load],
        groups: Groups::Planned(5),
    }
}

const fn copy(constants: &'static [(&'static str, f64)]) -> Kernel {
    Kernel {
        name: "copy_planes",
        source: source!("impasto/copy_planes", "impasto/common/axes"),
        constants,
        bindings: &[B::Planes, B::Other],
        groups: Groups::Grid,
    }
}

/// What the advection is measured beside, in as many parts.
pub(crate) static COPIES: [Kernel; 2] = [copy(&[("second", 0.0)]), copy(&[("second", 1.0)])];
