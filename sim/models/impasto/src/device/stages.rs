//! The stages of impasto in their order.

use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::transfer::{NEAR, POOL, SKIN, SPLITS};

use crate::stages::sheets::{COVERS, LN_ON_TOP, SHEET_MOST};
use crate::stages::sides::TAKES;
use crate::stages::velocity::{EASE, SLIP, SQUISH, STABLE};

use maulstick_gpu::steps::kernels::{Binding as B, Groups, Kernel, RASTERIZER};

/// Shared WGSL of the model's stages.
const COMMON: &str = include_str!("shaders/common/axes.wgsl");

/// Name of the stage that pushes paint along an axis.
pub(crate) const PUSHES: &str = "advection";

/// The stages of a step, in order.
pub(crate) static KERNELS: [Kernel; 14] = [
    Kernel {
        name: "weigh_films",
        source: &[COMMON, include_str!("shaders/weigh_films.wgsl")],
        constants: &[],
        bindings: &[B::Load, B::Asks, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "bound_head",
        source: &[COMMON, include_str!("shaders/bound_head.wgsl")],
        constants: &[],
        bindings: &[B::Poses, B::Head, B::Stats],
        groups: Groups::Segments,
    },
    Kernel {
        name: "weigh_grid",
        source: &[COMMON, include_str!("shaders/weigh_grid.wgsl")],
        constants: &[],
        bindings: &[B::Planes, B::Base, B::Keys, B::Totals, B::Stats],
        groups: Groups::Grid,
    },
    RASTERIZER,
    Kernel {
        name: "footprint",
        source: &[COMMON, include_str!("shaders/footprint.wgsl")],
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
        source: &[COMMON, include_str!("shaders/plan_step.wgsl")],
        constants: &[],
        bindings: &[B::Load, B::Stats, B::Groups],
        groups: Groups::One,
    },
    Kernel {
        name: "velocity",
        source: &[COMMON, include_str!("shaders/velocity.wgsl")],
        constants: &[],
        bindings: &[B::Contacts, B::Faces],
        groups: Groups::Planned(4),
    },
    Kernel {
        name: PUSHES,
        source: &[COMMON, include_str!("shaders/advection.wgsl")],
        constants: &[("second", 0.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(2),
    },
    Kernel {
        name: PUSHES,
        source: &[COMMON, include_str!("shaders/advection.wgsl")],
        constants: &[("second", 1.0)],
        bindings: &[B::Planes, B::Other, B::Faces, B::Totals, B::Stats],
        groups: Groups::Planned(3),
    },
    Kernel {
        name: "exchange_ask",
        source: &[COMMON, include_str!("shaders/exchange_ask.wgsl")],
        constants: &[
            ("SKIN", SKIN as f64),
            ("NEAR", NEAR as f64),
            ("POOL", POOL as f64),
            ("SPLITS", SPLITS as f64),
        ],
        bindings: &[
            B::Planes,
            B::Load,
            B::Asks,
            B::Contacts,
            B::Faces,
            B::Totals,
            B::Wants,
        ],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "exchange_apply",
        source: &[COMMON, include_str!("shaders/exchange_apply.wgsl")],
        constants: &[
            ("SHEET_MOST", SHEET_MOST as f64),
            ("COVERS", COVERS as f64),
            ("LN_ON_TOP", LN_ON_TOP as f64),
            ("TAKES", TAKES as f64),
        ],
        bindings: &[
            B::Planes,
            B::Load,
            B::Asks,
            B::Contacts,
            B::Faces,
            B::Totals,
            B::Wants,
            B::Stats,
        ],
        groups: Groups::Planned(0),
    },
    Kernel {
        name: "bristle_flow",
        source: &[COMMON, include_str!("shaders/bristle_flow.wgsl")],
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
        source: &[COMMON, include_str!("shaders/seep.wgsl")],
        constants,
        bindings: &[B::Head, B::Load],
        groups: Groups::Planned(5),
    }
}

const fn copy(constants: &'static [(&'static str, f64)]) -> Kernel {
    Kernel {
        name: "copy_planes",
        source: &[COMMON, include_str!("shaders/copy_planes.wgsl")],
        constants,
        bindings: &[B::Planes, B::Other],
        groups: Groups::Grid,
    }
}

/// Copies as the reference of the advection's benchmark, in as many parts.
pub(crate) static COPIES: [Kernel; 2] = [copy(&[("second", 0.0)]), copy(&[("second", 1.0)])];
