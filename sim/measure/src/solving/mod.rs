//! K and S at a wavelength: the equations, their quadratic programs, and their determinacy.

pub mod determined;
pub mod influence;
pub mod layer;
pub mod links;
pub mod normal;
pub mod prior;
pub mod program;
pub mod residuals;
pub mod wavelength;
