//! A brush on a bare surface, for measuring or showing strokes of a paint model without a painting; and the paths along
//! which the speed of strokes is measured.

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_types::Pose;
use maulstick_types::brush::Solve;

use crate::brush::head::{Waypoint, low_bounds, motion};
use crate::brush::load::{BrushLoad, Half};
use crate::brush::scale::Scale;
use crate::brush::traits::BrushTraits;
use crate::interface::{Handling, PaintModel, Step, StepReport, Sweep};

/// Height of the brush over the surface, and how its joints are bent, of its length and rad.
const PRESSED: (f64, f32) = (0.45, 0.3);
/// Upper bound of wet paint on the surface, cells.
const TOP: f32 = 8.0;
/// Paint of a surface that is wet all over, quanta.
const FILM: f32 = 40_000.0;
/// The slot of that paint, and that of the brush's.
const SLOTS: [usize; 2] = [0, 1];

/// A path on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// Its name.
    pub name: &'static str,
    /// Cells from one head to the next.
    way: f64,
    /// Its rotation along the path, rad.
    turn: f64,
    /// Its initial direction, rad.
    aim: f64,
}

/// Two fast straight paths, along the cells and across them, and a slow curved one.
pub const PATHS: [Path; 3] = [
    Path {
        name: "straight",
        way: 20.0,
        turn: 0.0,
        aim: 0.0,
    },
    Path {
        name: "oblique",
        way: 20.0,
        turn: 0.0,
        aim: 0.39,
    },
    Path {
        name: "curved",
        way: 3.0,
        turn: 0.03,
        aim: 0.0,
    },
];

/// A brush on square cells without tooth.
#[derive(Debug)]
pub struct Trial {
    file: BrushFile,
    head: Head,
    scale: Scale,
    /// Traits of the brush on these cells.
    pub traits: BrushTraits,
    /// The surface; the brush's paint has slot 1.
    pub window: Window,
}

impl Trial {
    /// A brush on `side` cells of `cell_m` either way; none if a surface cannot be so large.
    #[must_use]
    pub fn new(file: BrushFile, side: u32, cell_m: f64) -> Option<Self> {
        let mut store = TileStore::new([side; 2]);
        let all = store.around([0; 2], [i64::from(side); 2])?;
        let window = Window::open(&mut store, all, &Relief::flat(cell_m))?;
        Some(Self {
            head: Head::of(&file),
            scale: Scale { cell_m, zoom: 1.0 },
            traits: BrushTraits::of(&file, cell_m, 1.0),
            window,
            file,
        })
    }

    /// The pressed head at a place, cells, turned about its axis, rad.
    #[must_use]
    pub fn pose(&self, [x, y]: [f64; 2], turn: f64) -> HeadPose {
        let cell = self.scale.cell_m;
        let (sine, cosine) = maulstick_num::sin_cos(0.5 * turn);
        let (height, bend) = PRESSED;
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x * cell, y * cell, height * self.file.length_m()],
                orientation: [0.0, 0.0, sine, cosine],
            },
            zoom: 1.0,
            angles_rad: vec![[bend; 2]; self.file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let mut pose = HeadPose::default();
        Waypoint::of(&solve, self.scale, 1.0).pose(&self.head, self.scale, &mut pose);
        pose
    }

    /// The heads along a path, on surfaces of 1024 cells either way: up to the border, and at most 200.
    #[must_use]
    pub fn heads(&self, path: Path) -> Vec<HeadPose> {
        let (mut at, mut direction) = ([150.0, 300.0], path.aim);
        let last = [self.window.width(), self.window.height()].map(|cells| cells as f64 - 120.0);
        let mut poses = Vec::new();
        while poses.len() < 200 && [0, 1].iter().all(|i| at[*i] > 60.0 && at[*i] < last[*i]) {
            poses.push(self.pose(at, 0.0));
            let (sine, cosine) = maulstick_num::sin_cos(direction);
            at = [at[0] + path.way * cosine, at[1] + path.way * sine];
            direction += path.turn;
        }
        poses
    }

    /// Covers the surface with a film of the first paint alone.
    pub fn wet(&mut self) {
        let [film, own] = SLOTS;
        self.window.plane_mut(film).fill(FILM);
        self.window.plane_mut(own).fill(0.0);
    }

    /// A brush full of the second paint.
    #[must_use]
    pub fn full(&self) -> BrushLoad {
        let mut load = BrushLoad::clean(self.head.strips());
        let full = &[(SLOTS[1], 1.0)];
        load.fill(&self.head, &self.traits, full, None, (Half::Both, 7));
        load
    }

    /// Steps from each of these poses to the next.
    pub fn steps(
        &mut self,
        model: &mut dyn PaintModel,
        load: &mut BrushLoad,
        poses: &[HeadPose],
    ) -> StepReport {
        let mut sum = StepReport::default();
        for (place, pair) in poses.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            let Some((low, high)) = low_bounds(&self.head, to, &self.traits, TOP) else {
                continue;
            };
            let margin = motion(from, to).ceil() as i64;
            sum.add(&model.step(&mut Step {
                window: &mut self.window,
                head: &self.head,
                sweep: Sweep {
                    before: place.checked_sub(1).map(|before| &poses[before]),
                    from,
                    to,
                },
                bounds: (low.map(|at| at - margin), high.map(|at| at + margin)),
                load,
                traits: self.traits,
                handling: Handling::default(),
                stain: 0.0,
                lasting: false,
                thinner: None,
            }));
        }
        sum
    }

    /// A stroke through these poses with a full brush.
    pub fn stroke(&mut self, model: &mut dyn PaintModel, poses: &[HeadPose]) -> StepReport {
        let mut load = self.full();
        let mut sum = self.steps(model, &mut load, poses);
        sum.add(&model.settle(&mut self.window, &mut load));
        sum
    }
}
