//! A loaded round brush on a surface without tooth.

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::quantum::{Counts, add};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_model::brush::head::{Waypoint, low_bounds, motion};
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};
use maulstick_types::Pose;
use maulstick_types::brush::Solve;

pub(crate) const SIDE: u32 = 200;
const SCALE: Scale = Scale {
    cell_m: 2.5e-4,
    zoom: 1.0,
};

pub(crate) struct Bench {
    store: TileStore,
    relief: Relief,
    file: BrushFile,
    pub(crate) head: Head,
    pub(crate) load: BrushLoad,
    pub(crate) traits: BrushTraits,
    pub(crate) handling: Handling,
    pub(crate) lasting: bool,
    model: Dab,
    versions: u64,
    pub(crate) reports: StepReport,
}

impl Bench {
    pub(crate) fn new(stroker: Stroker) -> Self {
        let mut file = BrushFile::library("round").expect("round");
        file.strips.count = 64;
        let file = file.scaled_to(6.0).expect("a size");
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, SCALE.cell_m, 1.0);
        let mut load = BrushLoad::clean(head.strips());
        load.fill(&head, &traits, &[(0, 0.7), (3, 0.3)], None, (Half::Both, 5));
        Self {
            store: TileStore::new([SIDE; 2]),
            relief: Relief::flat(SCALE.cell_m),
            file,
            head,
            load,
            traits,
            handling: Handling::default(),
            lasting: false,
            model: Dab::stroking(stroker),
            versions: 0,
            reports: StepReport::default(),
        }
    }

    /// An even film of a paint.
    pub(crate) fn fill(&mut self, slot: usize, quanta: f32) {
        self.window([0; 2], [i64::from(SIDE); 2], |_, window| {
            window.plane_mut(slot).fill(quanta);
            window.touch(([0; 2], [window.width(), window.height()]));
        });
    }

    fn window<T>(
        &mut self,
        from: [i64; 2],
        to: [i64; 2],
        change: impl FnOnce(&mut Self, &mut Window) -> T,
    ) -> T {
        let rect = self.store.around(from, to).expect("on the surface");
        let mut window = Window::open(&mut self.store, rect, &self.relief).expect("free");
        let result = change(self, &mut window);
        window.commit(&mut self.store, &mut self.versions, |_, _| {});
        window.close(&mut self.store);
        result
    }

    /// The head at a place, cells, upright and pressed.
    pub(crate) fn pose(&self, [x, y]: [f64; 2]) -> HeadPose {
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [
                    x * SCALE.cell_m,
                    y * SCALE.cell_m,
                    0.55 * self.file.length_m(),
                ],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.1, 0.3]; self.file.spines.all_joints()],
            contacts: Vec::new(),
        };
        let mut pose = HeadPose::default();
        Waypoint::of(&solve, SCALE, 1.0).pose(&self.head, SCALE, &mut pose);
        pose
    }

    /// Steps through these poses, in a window on the whole surface or on the surrounding tiles alone.
    pub(crate) fn stroke(&mut self, way: &[HeadPose], narrow: bool) {
        for place in 1..way.len() {
            let (from, to) = (&way[place - 1], &way[place]);
            let bounds = low_bounds(&self.head, to, &self.traits, 6.0).expect("down");
            // Steps may be longer than those of a rig.
            let longer = motion(from, to).ceil() as i64;
            let bounds = (
                bounds.0.map(|at| at - longer),
                bounds.1.map(|at| at + longer),
            );
            let area = if narrow {
                (bounds.0.map(|i| i - 8), bounds.1.map(|i| i + 8))
            } else {
                ([0; 2], [i64::from(SIDE); 2])
            };
            let sweep = Sweep {
                before: place.checked_sub(2).map(|before| &way[before]),
                from,
                to,
            };
            let report = self.window(area.0, area.1, |own, window| {
                own.model.step(&mut Step {
                    window,
                    head: &own.head,
                    sweep,
                    bounds,
                    load: &mut own.load,
                    traits: own.traits,
                    handling: own.handling,
                    stain: 0.0,
                    lasting: own.lasting,
                    thinner: None,
                })
            });
            self.reports.add(&report);
        }
    }

    /// Calls `look` with a step from a head to another, in a window on the whole surface.
    pub(crate) fn with_step(&mut self, poses: &[HeadPose; 2], look: impl FnOnce(&mut Step<'_>)) {
        let sweep = Sweep {
            before: None,
            from: &poses[0],
            to: &poses[1],
        };
        self.window([0; 2], [i64::from(SIDE); 2], |own, window| {
            look(&mut Step {
                window,
                head: &own.head,
                sweep,
                bounds: ([0; 2], [i64::from(SIDE); 2]),
                load: &mut own.load,
                traits: own.traits,
                handling: own.handling,
                stain: 0.0,
                lasting: own.lasting,
                thinner: None,
            });
        });
    }

    pub(crate) fn lying(&self) -> Counts {
        self.store.counts()
    }

    pub(crate) fn counts(&self) -> Counts {
        let mut counts = self.lying();
        add(&mut counts, &self.load.counts());
        counts
    }

    /// All paint by cell of the surface, row after row.
    pub(crate) fn films(&mut self) -> Vec<f32> {
        self.window([0; 2], [i64::from(SIDE); 2], |_, window| {
            let width = window.width();
            let row = |y: usize| (0..SIDE as usize).map(move |x| y * width + x);
            let cells: Vec<usize> = (0..SIDE as usize).flat_map(row).collect();
            cells.into_iter().map(|cell| window.total(cell)).collect()
        })
    }
}
