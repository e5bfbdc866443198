//! Contact patch of a head: the cells of its strips within the reach of a film of paint.

use glam::DVec2;
use maulstick_brush::{BrushFile, BrushModel, Head, HeadPose, Hold};
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::Solve;
use maulstick_types::stylus::{StylusPose, StylusSample};

/// Side of the cells that count as touched, m.
pub(crate) const CELL_M: f64 = 2.5e-4;
/// Number of places tested between two stations of a strip.
const BETWEEN: u32 = 16;

/// A brush over a canvas whose lower left corner is the desk's origin.
pub(crate) struct Bench {
    pub(crate) file: BrushFile,
    pub(crate) model: BrushModel,
    head: Head,
    pose: HeadPose,
    ns: u64,
}

impl Bench {
    pub(crate) fn new(kind: &str) -> Self {
        Self::of(BrushFile::library(kind).expect(kind))
    }

    pub(crate) fn of(file: BrushFile) -> Self {
        let mut scene = super::desk::scene();
        scene.surfaces[0].pose.position_m = [0.0; 3];
        let mut model = BrushModel::new(file.clone(), 0.5);
        model.set_scene(&scene);
        Self {
            head: Head::of(&file),
            file,
            model,
            pose: HeadPose::default(),
            ns: 1_000_000_000,
        }
    }

    /// Follows a pen for 8 ms; the last solve.
    pub(crate) fn pen(&mut self, at: DVec2, tilt_rad: [f64; 2], pressure: f64) -> Solve {
        let solves = self.pen_turned(at, (tilt_rad, 0.0), pressure);
        solves.last().expect("a solve").clone()
    }

    /// Follows a pen with a tilt and a turn for 8 ms; all solves.
    pub(crate) fn pen_turned(
        &mut self,
        at: DVec2,
        (tilt_rad, twist_rad): ([f64; 2], f64),
        pressure: f64,
    ) -> Vec<Solve> {
        self.ns += 8_000_000;
        let sample = StylusSample {
            pose: StylusPose::Contact {
                point_m: [at.x, at.y, 0.0],
                tilt_rad,
                twist_rad,
                pressure,
            },
            in_range: true,
            ..StylusSample::away()
        };
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        self.model.follow(origin, self.ns, &sample)
    }

    /// Middles of the cells that a solve touches, m.
    pub(crate) fn patch(&mut self, solve: &Solve) -> Vec<DVec2> {
        let brush = Rigid::from(&solve.pose);
        let hold = Hold {
            brush: &brush,
            angles: &solve.angles_rad,
            per_m: 1.0,
            wetness: 1.0,
        };
        self.head.pose(&hold, &mut self.pose);
        let (strips, pose, count) = (&self.file.strips, &self.pose, self.head.strips());
        let press = f64::from(pose.press);
        // A brush that has painted a little.
        let film = 1e-6 * self.file.load.film_um.min(420.0);
        let pressed = film + 0.5e-3 * strips.thickness_mm + 1e-3 * (strips.sink_mm + 0.09) * press;
        let mut cells = std::collections::BTreeSet::new();
        for i in count..pose.x.len() {
            let unruly = f64::from(self.head.lift()[i % count]);
            let reach = pressed - 1e-3 * strips.lift_mm * (1.0 - press) * unruly;
            let at = |i: usize| [pose.x[i], pose.y[i], pose.z[i]].map(f64::from);
            let (a, b) = (at(i - count), at(i));
            for step in 0..=BETWEEN {
                let t = f64::from(step) / f64::from(BETWEEN);
                let [x, y, z] = [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * t);
                if z <= reach {
                    cells.insert([x, y].map(|v| (v / CELL_M).floor() as i64));
                }
            }
        }
        let middle = |[i, j]: [i64; 2]| DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * CELL_M;
        cells.into_iter().map(middle).collect()
    }
}

/// Width of a patch along a unit vector, m.
#[allow(dead_code, reason = "one test of several measures it")]
pub(crate) fn width(patch: &[DVec2], along: DVec2) -> f64 {
    let places = patch.iter().map(|p| p.dot(along));
    let range = places.fold((f64::MAX, f64::MIN), |(least, most), p| {
        (least.min(p), most.max(p))
    });
    (range.1 - range.0 + CELL_M).max(0.0)
}

/// The middle of a patch.
pub(crate) fn middle(patch: &[DVec2]) -> DVec2 {
    patch.iter().sum::<DVec2>() / patch.len().max(1) as f64
}
