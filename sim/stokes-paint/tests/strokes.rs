//! Strokes of Stokes Paint on a small surface.

use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::layered::{place_of, value};
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::{relief::Relief, store::TileStore, window::Window};
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::{scale::Scale, traits::BrushTraits};
use maulstick_model::interface::{Handling, PaintModel as _, Step};
use maulstick_model::path::PathStepper;
use maulstick_stokes_paint::StokesPaint;
use maulstick_types::{Pose, brush::Solve};

const SCALE: Scale = Scale {
    cell_m: 2.5e-4,
    zoom: 1.0,
};
/// Quanta of a film of a cell's height.
const CELL: f32 = 167_772.0;

struct Easel {
    store: TileStore,
    window: Window,
    head: Head,
    file: BrushFile,
    load: BrushLoad,
    handling: Handling,
}

impl Easel {
    /// A surface of so many cells each way, under wet paint of a slot, quanta.
    fn new(cells: u32, ground: Option<(usize, f32)>) -> Self {
        let file = BrushFile::library("round").expect("a brush of the library");
        let head = Head::of(&file);
        let mut store = TileStore::new([cells; 2]);
        let all = store
            .around([0, 0], [i64::from(cells); 2])
            .expect("a surface");
        let mut window =
            Window::open(&mut store, all, &Relief::flat(SCALE.cell_m)).expect("not leased");
        if let Some((slot, quanta)) = ground {
            window.plane_mut(slot).fill(quanta);
        }
        let load = BrushLoad::clean(head.strips());
        Self {
            store,
            window,
            head,
            file,
            load,
            handling: Handling::default(),
        }
    }

    fn load(mut self, slot: usize) -> Self {
        let traits = BrushTraits::of(&self.file, SCALE.cell_m, SCALE.zoom);
        self.load
            .fill(&self.head, &traits, &[(slot, 1.0)], None, (Half::Both, 1));
        self
    }

    /// A stroke along x, from and to so many m, at this height of the handle by the brush's length.
    fn stroke(&mut self, [from, to]: [f64; 2], y_m: f64, height: f64) {
        let traits = BrushTraits::of(&self.file, SCALE.cell_m, SCALE.zoom);
        let at = |x_m: f64| {
            let solve = Solve {
                event_ns: 0,
                stroke: 1,
                surface: 0,
                flags: 0,
                pose: Pose {
                    position_m: [x_m, y_m, height * self.file.length_m()],
                    ..Pose::IDENTITY
                },
                zoom: SCALE.zoom,
                angles_rad: vec![[0.2, 0.3]; self.file.spines.all_joints()],
                contacts: Vec::new(),
            };
            Waypoint::of(&solve, SCALE, 1.0)
        };
        let mut model = StokesPaint::default();
        let mut path = PathStepper::begin(&self.head, at(from), SCALE);
        let cells = [self.window.width(), self.window.height()].map(|cells| cells as i64);
        path.advance(&self.head, (at(to), 0), |sweep, _| {
            model.step(&mut Step {
                window: &mut self.window,
                head: &self.head,
                sweep,
                bounds: ([0, 0], cells),
                load: &mut self.load,
                traits,
                handling: self.handling,
                stain: 0.0,
                lasting: false,
                thinner: None,
            });
        });
    }

    /// Quanta on surface and brush, by slot.
    fn counts(&self) -> Vec<u64> {
        let on_brush = self.load.counts();
        let lying = |slot: usize| {
            let cells = self.window.plane(slot).unwrap_or_default().iter();
            cells.map(|count| *count as u64).sum::<u64>()
        };
        (0..SLOTS)
            .map(|slot| on_brush[slot] + lying(slot))
            .collect()
    }

    /// Quanta of a slot in a layer of a cell above its lowest.
    fn in_layer(&self, slot: usize, layer: usize, cell: usize) -> u32 {
        let mut planes = self.window.own_planes();
        let own = planes.find(|(shape, _)| place_of(*shape) == Some((slot, layer)));
        own.map_or(0, |(_, bytes)| value(bytes, cell))
    }

    fn cell(&self, x: usize, y: usize) -> usize {
        y * self.window.width() + x
    }
}

#[test]
fn no_quantum_is_made_or_lost() {
    let mut easel = Easel::new(128, Some((3, 4.25 * CELL))).load(0);
    let before = easel.counts();
    easel.stroke([0.010, 0.020], 0.016, 0.6);
    easel.stroke([0.020, 0.012], 0.017, 0.5);
    assert_eq!(easel.counts(), before);
    let left: f32 = easel.window.plane(0).expect("laid").iter().sum();
    assert!(left > 0.0);
}

#[test]
fn a_brush_ploughs_a_furrow_between_ridges() {
    let ground = 3.0 * CELL;
    let mut easel = Easel::new(128, Some((3, ground)));
    easel.handling.transfer = maulstick_model::interface::Transfer::Marker { flow: 0.0 };
    easel.stroke([0.008, 0.022], 0.016, 0.55);
    let across: Vec<f32> = (20..110)
        .map(|y| easel.window.total(easel.cell(64, y)) / ground)
        .collect();
    let least = across
        .iter()
        .fold(f32::MAX, |least, height| least.min(*height));
    let most = across.iter().fold(0.0f32, |most, height| most.max(*height));
    assert!(least < 0.8 && most > 1.05, "{least} {most} {across:?}");
}

#[test]
fn a_light_stroke_leaves_what_lies_deep() {
    let mut easel = Easel::new(128, Some((3, 6.0 * CELL))).load(0);
    easel.stroke([0.010, 0.020], 0.016, 0.75);
    let blue: f32 = easel.window.plane(0).expect("laid").iter().sum();
    assert!(blue > 0.0);
    let cells = easel.window.width() * easel.window.height();
    let lowest: f64 = (0..cells)
        .map(|cell| {
            let above: u32 = (1..12).map(|layer| easel.in_layer(0, layer, cell)).sum();
            f64::from(easel.window.plane(0).expect("laid")[cell]) - f64::from(above)
        })
        .sum();
    assert!(lowest < 0.02 * f64::from(blue), "{lowest} of {blue}");
}

#[test]
fn a_step_depends_on_the_cells_around_the_brush_alone() {
    let paint = |cells| {
        let mut easel = Easel::new(cells, Some((3, 2.5 * CELL))).load(0);
        easel.stroke([0.010, 0.016], 0.016, 0.6);
        let planes = easel.window.planes();
        let rows = planes.flat_map(|(_, plane)| {
            let width = easel.window.width();
            (0..128).flat_map(move |y| plane[y * width..y * width + 128].to_vec())
        });
        rows.collect::<Vec<f32>>()
    };
    assert!(paint(128) == paint(192));
}

#[test]
fn what_is_committed_is_read_again() {
    let mut easel = Easel::new(128, Some((3, 3.5 * CELL))).load(0);
    easel.stroke([0.010, 0.016], 0.016, 0.6);
    let before = easel.counts();
    let own: Vec<Vec<u8>> = easel
        .window
        .own_planes()
        .map(|(_, bytes)| bytes.to_vec())
        .collect();
    assert!(!own.is_empty());
    let [width, height] = [easel.window.width(), easel.window.height()];
    easel.window.touch(([0, 0], [width, height]));
    let mut next = 0;
    let rect = easel.window.rect();
    easel.window.commit(&mut easel.store, &mut next, |_, _| ());
    easel.window.close(&mut easel.store);
    easel.window =
        Window::open(&mut easel.store, rect, &Relief::flat(SCALE.cell_m)).expect("free again");
    let again = easel.window.own_planes().map(|(_, bytes)| bytes.to_vec());
    let is_some = |bytes: &Vec<u8>| bytes.iter().any(|byte| *byte != 0);
    assert!(again.eq(own.into_iter().filter(is_some)));
    assert_eq!(easel.counts(), before);
}
