//! The paths along which speed is measured, over wet paint.

use maulstick_brush::HeadPose;

use crate::scene::Bench;

/// Cells either way.
pub(crate) const SIDE: u32 = 1024;
/// Wet paint on the canvas, quanta.
const FILM: f32 = 40_000.0;

/// A path: cells from one head to the next, by how much it turns on that way, and where it begins to go, rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    pub(crate) name: &'static str,
    pub(crate) way: f64,
    turn: f64,
    aim: f64,
}

const fn path(name: &'static str, way: f64, turn: f64, aim: f64) -> Path {
    Path {
        name,
        way,
        turn,
        aim,
    }
}

/// Two fast straight ones, and a slow curved one.
pub(crate) const PATHS: [Path; 3] = [
    path("straight", 20.0, 0.0, 0.0),
    path("oblique", 20.0, 0.0, 0.39),
    path("curved", 3.0, 0.03, 0.0),
];

impl Path {
    /// One with a head each so many cells, as in a rig.
    pub(crate) fn slow(way: f64) -> Self {
        path("slow", way, 0.01, 0.0)
    }

    /// The heads along it.
    pub(crate) fn heads(&self, bench: &Bench) -> Vec<HeadPose> {
        let (mut at, mut direction) = ([150.0, 300.0], self.aim);
        let mut poses = Vec::new();
        while poses.len() < 200 && at[0] > 60.0 && at[0] < f64::from(SIDE) - 120.0 {
            poses.push(bench.pose(at, 0.0));
            let (sine, cosine) = maulstick_num::sin_cos(direction);
            at = [at[0] + self.way * cosine, at[1] + self.way * sine];
            direction += self.turn;
        }
        poses
    }

    /// The longest way between two heads, cells.
    pub(crate) fn margin(&self) -> i64 {
        self.way.ceil() as i64
    }
}

/// A surface that is wet all over, with nothing else on it.
pub(crate) fn wet(bench: &mut Bench) {
    bench.window.plane_mut(0).fill(FILM);
    bench.window.plane_mut(1).fill(0.0);
}
