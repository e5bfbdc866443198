//! Block matrices, quadratic programs and subdivision surfaces.

pub mod blocks;
pub mod qp;
pub mod subdivide;
