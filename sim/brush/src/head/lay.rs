//! Positions of the strips of a station, all at once.

use maulstick_num::lanes::{Lanes, run};
use maulstick_num::select::smaller;
use maulstick_num::wide;

use super::STATIONS;

/// Strips placed at a time.
const LANES: usize = 8;

/// What the strips of a station have in common.
pub(super) struct Station<'a> {
    /// Offsets of the closed head in the brush frame.
    pub closed: [&'a [f32]; 3],
    /// Offsets in x and y, added by the share `press`.
    pub opening: [&'a [f32]; 2],
    pub press: f32,
    /// Offsets of clumped strips, added by the share `clump`; none without clumps.
    pub clumped: &'a [&'a [f32]],
    pub clump: f32,
    /// For each axis of the surface, what an offset along each of the brush's contributes.
    pub turn: [[f32; 3]; 3],
    /// Places of the spines from `center`, by axis, with the weight that each strip has of them.
    pub spines: &'a [([f32; 3], &'a [f32])],
    pub center: [f32; 3],
}

wide! {
    /// Places the strips of a station, along each axis of the surface.
    pub(super) fn place_strips<L>(planes: [&mut [f32]; 3], station: &Station<'_>) {
        let mut planes = planes;
        let strips = planes[0].len();
        for start in (0..strips).step_by(LANES) {
            // The last few come with others before them.
            let start = start.min(strips.saturating_sub(LANES));
            let places = station.places::<L>(start);
            for (plane, places) in planes.iter_mut().zip(&places) {
                let (plane, values) = (&mut plane[start..], places.values());
                match plane.first_chunk_mut() {
                    Some(run) => *run = values,
                    None => plane.copy_from_slice(&values[..strips]),
                }
            }
        }
    }
}

impl Station<'_> {
    /// Places of eight strips from `start` on, along each axis. Loops, as closures would not be compiled for wide
    /// registers.
    #[inline(always)]
    fn places<L: Lanes>(&self, start: usize) -> [L; 3] {
        let mut off = [L::splat(0.0); 3];
        for (off, plane) in off.iter_mut().zip(&self.closed) {
            *off = run(plane, start);
        }
        for (off, plane) in off.iter_mut().zip(&self.opening) {
            *off = *off + L::splat(self.press) * run(plane, start);
        }
        for (off, plane) in off.iter_mut().zip(self.clumped) {
            *off = *off + L::splat(self.clump) * run(plane, start);
        }
        let mut places = [L::splat(0.0); 3];
        for (place, turn) in places.iter_mut().zip(&self.turn) {
            *place = L::splat(turn[0]) * off[0] + L::splat(turn[1]) * off[1];
            *place = *place + L::splat(turn[2]) * off[2];
        }
        for (from, weights) in self.spines {
            let weights: L = run(weights, start);
            for (place, from) in places.iter_mut().zip(from) {
                *place = *place + weights * L::splat(*from);
            }
        }
        // Places are kept small until the end: far from the origin f32 is coarse.
        for (place, center) in places.iter_mut().zip(&self.center) {
            *place = *place + L::splat(*center);
        }
        places
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
