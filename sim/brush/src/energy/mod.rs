//! The energies of a spine: value, gradient and Hessian together.
//!
//! | module | energy |
//! | --- | --- |
//! | [`spring`] | of joints, straight or bent at rest |
//! | [`friction`] | with a half space, anisotropic |
//! | [`damping`] | within a joint |
//! | [`neighbour_repulsion`] | of joints pushed into each other's room |
//! | [`bond`] | of segments bound to the core of the head |

use glam::{DMat3, DVec3};

pub mod bond;
pub mod damping;
pub mod friction;
pub mod neighbour_repulsion;
pub mod spring;

/// a·bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
