//! Exports, read back by other readers than wrote them. Each comparison has a fault that it must see.

mod files;
mod glb;
mod mesh;
mod open_exr;
mod open_raster;
mod pictures;
mod programs;
mod stl;
mod support;
