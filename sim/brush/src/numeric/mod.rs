//! Block matrices, quadratic programmes and subdivision surfaces.

pub mod blocks;
pub mod qp;
pub mod subdivide;
