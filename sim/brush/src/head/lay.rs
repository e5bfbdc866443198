//! Positions of the strips of a station, all at once.

use maulstick_num::wide;

wide! {
    /// Offsets in the brush frame along one axis of the surface.
    pub(super) fn turn_offsets(plane: &mut [f32], off: &[Vec<f32>; 3], turn: [f32; 3]) {
        let [x, y, z] = off;
        for (((p, x), y), z) in plane.iter_mut().zip(x).zip(y).zip(z) {
            *p = turn[0] * x + turn[1] * y + turn[2] * z;
        }
    }
}

wide! {
    /// Adds a place along an axis by the weight that each strip has of it.
    pub(super) fn add_weighted(plane: &mut [f32], weights: &[f32], place: f32) {
        for (p, w) in plane.iter_mut().zip(weights) {
            *p += w * place;
        }
    }
}
