//! Stokes Paint: viscous paint as a volume.
#![allow(missing_docs)]
pub mod domain;
pub mod flow;
pub mod grid;
pub mod multigrid;
pub mod operator;
pub mod rheology;
mod split;
pub mod stencil;
mod transfer;
pub mod unified;
pub mod vector;
pub mod volume;
