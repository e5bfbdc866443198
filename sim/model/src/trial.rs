//! A brush on a bare surface, to measure or to show what a paint model does in a stroke, without a painting around it.

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
/// Wet paint on the surface lies below this, cells.
const WET: f32 = 8.0;

/// A brush on square cells without tooth.
#[derive(Debug)]
pub struct Trial {
    file: BrushFile,
    head: Head,
    scale: Scale,
    /// Traits of the brush on these cells.
    pub traits: BrushTraits,
    /// The surface.
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

    /// A stroke through these poses, a step from each to the next, with a brush full of the paint of a slot.
    pub fn stroke(
        &mut self,
        model: &mut dyn PaintModel,
        poses: &[HeadPose],
        slot: usize,
    ) -> StepReport {
        let mut load = BrushLoad::clean(self.head.strips());
        let full = &[(slot, 1.0)];
        load.fill(&self.head, &self.traits, full, None, (Half::Both, 7));
        let mut sum = StepReport::default();
        for (place, pair) in poses.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            let Some((low, high)) = low_bounds(&self.head, to, &self.traits, WET) else {
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
                load: &mut load,
                traits: self.traits,
                handling: Handling::default(),
                stain: 0.0,
                lasting: false,
                thinner: None,
            }));
        }
        sum
    }
}
