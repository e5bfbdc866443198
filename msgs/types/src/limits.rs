//! Limits of the values that commands, samples and scenes may have.

use std::ops::RangeInclusive;

/// Farthest distance of a sample from the desk's origin along each axis, m: a motion over all of it can still be followed
/// cell by cell.
pub const FARTHEST_M: f64 = 10.0;
/// Most bytes of a path: Linux takes no longer ones.
pub const PATH_MAX: usize = 4096;
/// Most parts of a mixture.
pub const PARTS_MAX: usize = 64;
/// Most bytes of a paint's name.
pub const PAINT_NAME_MAX: usize = 128;
/// Most bytes of a layer's name.
pub const LAYER_NAME_MAX: usize = 128;
/// Most bytes of a version's name.
pub const VERSION_NAME_MAX: usize = 128;
/// Most bytes of a brush file.
pub const BRUSH_FILE_MAX: usize = 1_000_000;
/// Most bytes of a device's name.
pub const DEVICE_NAME_MAX: usize = 128;
/// Most bytes of a device's settings.
pub const DEVICE_MAX: usize = 1 << 16;
/// Most bytes of a spectrum.
pub const SPECTRUM_MAX: usize = 1 << 18;
/// Most cells of a canvas along each side.
pub const CELLS_MAX: u32 = 65_536;
/// Cells of a canvas along each side: half of one is rounded up.
pub const CELLS: RangeInclusive<f64> = 0.5..=CELLS_MAX as f64;
/// Most cells of a new canvas: twice what a large machine shows in comfort.
pub const CELLS_IN_ALL: f64 = 1_073_741_824.0;
/// Most wells of a surface.
pub const WELLS_MAX: usize = 64;
