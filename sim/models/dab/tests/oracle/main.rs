//! Each stage of dAb's step against a plain oracle in f64, and whole strokes against their invariants. Each comparison
//! has a seeded fault that it must find.

mod raster;
mod reservoir;
mod scene;
mod stroke;
mod touching;
mod transfer;
