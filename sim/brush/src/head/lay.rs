//! Positions of the strips of a station, all at once.

use maulstick_num::select::smaller;
use maulstick_num::wide;

use super::STATIONS;

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

/// Draws strips back along themselves, their points by `stations` each: a short bristle lies as its neighbours do and
/// ends before them, a long one, by a negative number, after them.
pub(super) fn draw_back(plane: &mut [f32], stations: &[f32]) {
    if stations.is_empty() {
        return;
    }
    for station in (1..STATIONS).rev() {
        let (before, own) = plane.split_at_mut(station * stations.len());
        let before = &before[(station - 1) * stations.len()..];
        move_toward(
            own,
            before,
            stations,
            station as f32 / (STATIONS - 1) as f32,
        );
    }
}

wide! {
    fn move_toward(own: &mut [f32], before: &[f32], stations: &[f32], share: f32) {
        for ((own, before), stations) in own.iter_mut().zip(before).zip(stations) {
            *own += smaller(share * stations, 1.0) * (before - *own);
        }
    }
}
