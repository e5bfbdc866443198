//! The paint of one film in a column of voxels: on the film below it, or over air.
//!
//! Voxels at least half full are paint, as at an isosurface of fill ½. The paint of less full ones thickens the paint that
//! they touch, so a thin film keeps its thickness and a column all of its paint.

/// Least fill of a voxel of paint: the isovalue.
const ISOVALUE: f32 = 0.5;
/// Greatest fill of a voxel of air.
const MAX_AIR_FILL: f32 = 0.02;
/// Thickness below which paint over air is merged with the piece below it, cells.
const MIN_FLOATING: f32 = 0.1;

/// The paint of a film in a column; heights in cells above the floor of the film.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Film {
    /// Thickness of the paint on the floor.
    pub(crate) lying: f32,
    /// Bottom and top of each piece over air, from the lowest up.
    pub(crate) floating: Vec<[f32; 2]>,
}

/// The film with these fills of voxels from the lowest up. Of the lowest voxel the share `room` is open, the others are
/// open entirely.
pub(crate) fn film(fills: &[f32], room: f32) -> Film {
    let mut film = Film::default();
    let is_paint = |k: usize| fills[k] >= ISOVALUE * if k == 0 { room } else { 1.0 };
    // Below the lowest voxel is the floor.
    let mut touches = true;
    let mut k = 0;
    while k < fills.len() {
        let first = k;
        let has_less = |k: usize| fills[k] > MAX_AIR_FILL && !is_paint(k);
        k = (first..fills.len())
            .find(|k| !has_less(*k))
            .unwrap_or(fills.len());
        let less = &fills[first..k];
        let sum: f32 = less.iter().sum();
        let above = k;
        k = (above..fills.len())
            .find(|k| !is_paint(*k))
            .unwrap_or(fills.len());
        if above == k {
            // Air above.
            if touches || sum < MIN_FLOATING {
                film.thicken(sum);
            } else {
                film.floating.push(extent(less, first, room));
            }
        } else if touches && above == first {
            film.thicken(fills[above..k].iter().sum());
        } else {
            let below = if touches { 0.5 * sum } else { 0.0 };
            film.thicken(below);
            let [bottom, top] = extent(&fills[above..k], above, room);
            film.add([bottom - (sum - below), top]);
        }
        touches = k > above;
        if k < fills.len() && fills[k] <= MAX_AIR_FILL {
            film.thicken(fills[k]);
            touches = false;
            k += 1;
        }
    }
    film.without_overlap()
}

/// Bottom and top of the paint in voxels from `first` on, with its thickness, around its centre of mass; the lowest
/// piece touches the voxel above, the highest the one below.
fn extent(fills: &[f32], first: usize, room: f32) -> [f32; 2] {
    let last = fills.len() - 1;
    let (mut sum, mut moment) = (0.0, 0.0);
    for (k, fill) in fills.iter().enumerate() {
        let middle = match k {
            _ if last == 0 => 0.5,
            0 => 1.0 - 0.5 * fill.min(1.0),
            _ if k == last => 0.5 * fill.min(1.0),
            _ => 0.5,
        };
        sum += fill;
        moment += fill * ((first + k) as f32 - 1.0 + room + middle);
    }
    let middle = moment / sum;
    [middle - 0.5 * sum, middle + 0.5 * sum]
}

impl Film {
    /// A film of this thickness without paint over air.
    pub(crate) fn lying(cells: f32) -> Self {
        Self {
            lying: cells,
            floating: Vec::new(),
        }
    }

    /// Thickens the highest piece so far.
    fn thicken(&mut self, cells: f32) {
        match self.floating.last_mut() {
            Some([_, top]) => *top += cells,
            None => self.lying += cells,
        }
    }

    fn add(&mut self, interval: [f32; 2]) {
        self.floating.push(interval);
    }

    /// The film with overlapping pieces stacked on each other.
    fn without_overlap(self) -> Self {
        let mut film = Self {
            lying: self.lying,
            floating: Vec::new(),
        };
        for [bottom, top] in self.floating {
            let below = film.floating.last().map_or(film.lying, |[_, top]| *top);
            if bottom <= below {
                film.thicken(top - bottom);
            } else {
                film.add([bottom, top]);
            }
        }
        film
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(film: &Film, lying: f32, floating: &[[f32; 2]]) -> bool {
        let near = |a: f32, b: f32| (a - b).abs() < 1e-5;
        let pairs = film
            .floating
            .iter()
            .flatten()
            .zip(floating.iter().flatten());
        near(film.lying, lying)
            && film.floating.len() == floating.len()
            && pairs.into_iter().all(|(a, b)| near(*a, *b))
    }

    #[test]
    fn paint_lies_where_its_voxels_are_full() {
        type Case<'a> = (&'a [f32], f32, f32, &'a [[f32; 2]]);
        let cases: [Case<'_>; 12] = [
            (&[0.37], 1.0, 0.37, &[]),
            (&[3.7], 1.0, 3.7, &[]),
            (&[0.6, 1.0, 0.2], 0.6, 1.8, &[]),
            (&[1.0, 1.0, 0.3, 0.3], 1.0, 2.6, &[]),
            (&[0.0, 0.0, 0.37], 1.0, 0.0, &[[2.315, 2.685]]),
            (&[0.0, 0.4, 1.0, 0.3], 0.7, 0.0, &[[1.3, 3.0]]),
            (&[0.5, 0.0, 0.7, 0.6], 1.0, 0.5, &[[2.3, 3.6]]),
            (&[0.4, 0.0, 0.3, 0.3, 0.0], 1.0, 0.4, &[[2.7, 3.3]]),
            // A gap that is less than half full.
            (&[1.0, 0.2, 1.0], 1.0, 1.1, &[[1.9, 3.0]]),
            (&[0.5, 0.0, 0.01, 0.0, 0.05], 1.0, 0.56, &[]),
            // An overfull voxel needs room.
            (&[2.5, 0.0, 1.0, 0.0, 1.0], 1.0, 3.5, &[[4.0, 5.0]]),
            (&[], 1.0, 0.0, &[]),
        ];
        for (fills, room, lying, floating) in cases {
            let film = film(fills, room);
            assert!(close(&film, lying, floating), "{fills:?}: {film:?}");
        }
    }

    #[test]
    fn no_paint_is_lost() {
        let mut state = 1u32;
        for _ in 0..2000 {
            let mut next = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 8) as f32 / 16_777_216.0
            };
            let room = 0.31 + 0.9 * next();
            let fills: Vec<f32> = (0..12)
                .map(|_| (2.4 * next() - 1.0).clamp(0.0, 1.25))
                .collect();
            let film = film(&fills, room);
            let all = film.lying + film.floating.iter().map(|[a, b]| b - a).sum::<f32>();
            assert!((all - fills.iter().sum::<f32>()).abs() < 1e-4);
            let mut below = film.lying;
            for [bottom, top] in film.floating {
                assert!(below < bottom && bottom < top);
                below = top;
            }
        }
    }
}
