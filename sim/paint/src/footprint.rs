//! The cells under the head (Baxter 2004, fig. 6.3, stage 1): how deep it reaches into each, and how
//! far it went along there.

use crate::path::Sweep;
use crate::window::Window;

/// One value a covered cell in each list.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    /// Place of the cell in the window's planes.
    pub cells: Vec<u32>,
    /// How far the head reaches below the surface, cells.
    pub penetration: Vec<f32>,
    /// How far the head went along the surface there, cells.
    pub travel: Vec<f32>,
    /// Lowest column and row of the window that is covered.
    pub from: [usize; 2],
    /// One past the highest.
    pub to: [usize; 2],
}

impl Footprint {
    /// Finds the cells that the head covers after a step. `cells` is the size of the surface: what
    /// lies beyond it is not covered.
    pub fn find(&mut self, sweep: Sweep<'_>, window: &Window, cells: [u32; 2]) {
        self.cells.clear();
        self.penetration.clear();
        self.travel.clear();
        let origin = window.origin();
        let (low, high) = sweep.to.bounds();
        let inside = |value: i64, i: usize, size: usize| {
            let last = i64::from(cells[i]) - origin[i];
            (value - origin[i]).clamp(0, last.min(size as i64).max(0)) as usize
        };
        let size = [window.width(), window.height()];
        self.from = [0, 1].map(|i| inside(low[i], i, size[i]));
        self.to = [0, 1].map(|i| inside(high[i], i, size[i]));
        let balls = &sweep.to.balls;
        for y in self.from[1]..self.to[1] {
            let cy = (origin[1] + y as i64) as f32 + 0.5;
            for x in self.from[0]..self.to[0] {
                let cx = (origin[0] + x as i64) as f32 + 0.5;
                let mut deepest = 0.0f32;
                let mut travel = 0.0f32;
                for (k, pair) in balls.windows(2).enumerate() {
                    let (a, b) = (&pair[0], &pair[1]);
                    let along = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
                    let square = along[0] * along[0] + along[1] * along[1];
                    let to_cell = [cx - a.at[0], cy - a.at[1]];
                    let t = if square > 1e-6 {
                        ((to_cell[0] * along[0] + to_cell[1] * along[1]) / square).clamp(0.0, 1.0)
                    } else {
                        1.0
                    };
                    let off = [to_cell[0] - t * along[0], to_cell[1] - t * along[1]];
                    let radius = a.radius + t * (b.radius - a.radius);
                    let inside = radius * radius - off[0] * off[0] - off[1] * off[1];
                    if inside <= 0.0 {
                        continue;
                    }
                    let depth = inside.sqrt() - (a.at[2] + t * (b.at[2] - a.at[2]));
                    if depth > deepest {
                        deepest = depth;
                        travel = travel_at(sweep, k, t);
                    }
                }
                if deepest > 0.0 {
                    self.cells.push((y * size[0] + x) as u32);
                    self.penetration.push(deepest);
                    self.travel.push(travel);
                }
            }
        }
    }
}

/// How far the point at `t` of segment `k` went along the surface, cells.
fn travel_at(sweep: Sweep<'_>, k: usize, t: f32) -> f32 {
    let moved = |i: usize| {
        let (from, to) = (&sweep.from.balls[i], &sweep.to.balls[i]);
        [to.at[0] - from.at[0], to.at[1] - from.at[1]]
    };
    let (a, b) = (moved(k), moved(k + 1));
    let d = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    (d[0] * d[0] + d[1] * d[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::head::{Ball, HeadPose};
    use crate::store::{TileRect, TileStore};

    fn head(x: f32, z: f32) -> HeadPose {
        let ball = |x: f32, z: f32| Ball {
            at: [x, 32.0, z],
            radius: 6.0,
        };
        HeadPose {
            balls: vec![ball(x, z), ball(x + 10.0, z)],
        }
    }

    fn footprint(z: f32) -> Footprint {
        let mut store = TileStore::new([64, 64]);
        let rect = TileRect {
            from: [0, 0],
            to: [1, 1],
        };
        let window = Window::open(&mut store, rect).expect("free");
        let mut footprint = Footprint::default();
        let (from, to) = (head(20.0, z), head(21.0, z));
        footprint.find(
            Sweep {
                from: &from,
                to: &to,
            },
            &window,
            [64, 64],
        );
        footprint
    }

    #[test]
    fn a_lying_capsule_covers_its_outline() {
        let found = footprint(0.0);
        let area = 12.0 * 10.0 + std::f32::consts::PI * 36.0;
        assert!(
            (found.cells.len() as f32 - area).abs() < 0.03 * area,
            "{}",
            found.cells.len()
        );
        let deepest = found.penetration.iter().copied().fold(0.0, f32::max);
        assert!((deepest - 6.0).abs() < 0.1);
        assert!(found.travel.iter().all(|cells| (cells - 1.0).abs() < 1e-5));
    }

    #[test]
    fn a_lifted_one_covers_less_and_then_nothing() {
        assert!(footprint(5.0).cells.len() < footprint(1.0).cells.len());
        assert!(footprint(6.1).cells.is_empty());
    }
}
