//! The energies of a spine: value, gradient and Hessian together.
//!
//! | module | energy |
//! | --- | --- |
//! | [`spring`] | of joints, straight or bent at rest |
//! | [`friction`] | with a wall, anisotropic |
//! | [`damping`] | within a joint |
//! | [`crowd`] | of joints pushed into each other's room |

pub mod crowd;
pub mod damping;
pub mod friction;
pub mod spring;
