//! Strokes of Stokes Paint on a small surface.

use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::quantum::{BySlot, SLOTS};
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::window::{Area, Window};
use maulstick_canvas::{relief::Relief, store::TileStore};
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::{scale::Scale, traits::BrushTraits};
use maulstick_model::interface::{Handling, PaintModel as _, Rest, Step, Transfer};
use maulstick_model::path::PathStepper;
use maulstick_stokes_paint::StokesPaint;
use maulstick_stokes_paint::layer_planes::{place_of, shape_of, value};
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
    scale: Scale,
    head: Head,
    file: BrushFile,
    load: BrushLoad,
    handling: Handling,
    /// Bend of each joint, rad.
    bend: [f32; 2],
}

impl Easel {
    /// A surface of `cells` cells each way: a level one under wet paint of a slot, quanta, or bare linen.
    fn new(cells: u32, ground: Option<(usize, f32)>) -> Self {
        Self::with("round", cells, ground)
    }

    fn with(brush: &str, cells: u32, ground: Option<(usize, f32)>) -> Self {
        Self::on(SCALE, brush, (cells, ground))
    }

    fn on(scale: Scale, brush: &str, (cells, ground): (u32, Option<(usize, f32)>)) -> Self {
        let file = BrushFile::library(brush).expect("a brush of the library");
        let head = Head::of(&file);
        let mut store = TileStore::new([cells; 2]);
        let all = store
            .around([0, 0], [i64::from(cells); 2])
            .expect("a surface");
        let tooth = Tooth::new("linen", 1, scale.cell_m).expect("a tooth");
        let relief = match ground {
            Some(_) => Relief::flat(scale.cell_m),
            None => Relief::new(tooth, scale.cell_m),
        };
        let mut window = Window::open(&mut store, all, &relief).expect("not leased");
        if let Some((slot, quanta)) = ground {
            window.plane_mut(slot).fill(quanta);
        }
        let load = BrushLoad::clean(head.strips());
        Self {
            store,
            window,
            scale,
            head,
            file,
            load,
            handling: Handling::default(),
            bend: [0.2, 0.3],
        }
    }

    fn load(mut self, slot: usize) -> Self {
        let traits = BrushTraits::of(&self.file, self.scale.cell_m, self.scale.zoom);
        self.load
            .fill(&self.head, &traits, &[(slot, 1.0)], None, (Half::Both, 1));
        self
    }

    /// A stroke along x, from and to in m, at this height of the handle by the brush's length.
    fn stroke(&mut self, [from, to]: [f64; 2], y_m: f64, height: f64) {
        self.stroke_between([[from, y_m], [to, y_m]], height);
    }

    fn stroke_between(&mut self, [from, to]: [[f64; 2]; 2], height: f64) {
        let traits = BrushTraits::of(&self.file, self.scale.cell_m, self.scale.zoom);
        let at = |[x_m, y_m]: [f64; 2]| {
            let solve = Solve {
                event_ns: 0,
                stroke: 1,
                surface: 0,
                flags: 0,
                pose: Pose {
                    position_m: [x_m, y_m, height * self.file.length_m()],
                    ..Pose::IDENTITY
                },
                zoom: self.scale.zoom,
                angles_rad: vec![self.bend; self.file.spines.all_joints()],
                contacts: Vec::new(),
            };
            Waypoint::of(&solve, self.scale, 1.0)
        };
        let mut model = StokesPaint::default();
        let mut path = PathStepper::begin(&self.head, at(from), self.scale);
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

    /// The brush is lifted.
    fn rest(&mut self) {
        let size = [self.window.width(), self.window.height()];
        StokesPaint::default().rest(&mut Rest {
            window: &mut self.window,
            area: Area { from: [0; 2], size },
            cell_m: self.scale.cell_m,
            stain: 0.0,
            thinner: None,
            settings: BySlot::default(),
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

    /// Quanta of the brush's paint on the surface.
    fn laid(&self) -> f64 {
        let plane = self.window.plane(0).expect("laid");
        plane.iter().map(|count| f64::from(*count)).sum()
    }

    /// Quanta in voxels that are not connected, by half-full voxels, to the level surface.
    fn loose(&self) -> f64 {
        let (width, cells) = (
            self.window.width(),
            self.window.width() * self.window.height(),
        );
        let mut voxels: Vec<Vec<f32>> = vec![vec![0.0; cells]];
        for (_, plane) in self.window.planes() {
            let sums = voxels[0].iter_mut().zip(plane);
            sums.for_each(|(sum, count)| *sum += count);
        }
        for (shape, bytes) in self.window.own_planes() {
            let (_, layer) = place_of(shape).expect("a layer");
            voxels.resize(voxels.len().max(layer + 1), vec![0.0; cells]);
            for cell in 0..cells {
                let count = value(bytes, cell) as f32;
                voxels[layer][cell] += count;
                voxels[0][cell] -= count;
            }
        }
        let mut held = vec![vec![false; cells]; voxels.len()];
        held[0].fill(true);
        let mut next: Vec<[usize; 2]> = (0..cells).map(|cell| [0, cell]).collect();
        while let Some([layer, cell]) = next.pop() {
            // Thin paint hangs on others, and supports none.
            if layer > 0 && voxels[layer][cell] < 0.5 * CELL {
                continue;
            }
            let beside = [
                cell.wrapping_sub(1),
                cell + 1,
                cell.wrapping_sub(width),
                cell + width,
            ];
            let levels = [layer.wrapping_sub(1), layer + 1].map(|layer| [layer, cell]);
            for [layer, cell] in beside.map(|cell| [layer, cell]).into_iter().chain(levels) {
                let is_there = layer < voxels.len() && cell < cells && voxels[layer][cell] > 0.0;
                if is_there && !std::mem::replace(&mut held[layer][cell], true) {
                    next.push([layer, cell]);
                }
            }
        }
        let loose = voxels.iter().zip(&held).flat_map(|(counts, held)| {
            let cells = counts.iter().zip(held);
            cells.map(|(count, is_held)| if *is_held { 0.0 } else { f64::from(*count) })
        });
        loose.sum()
    }

    /// Quanta of a slot in a layer of a cell above its lowest.
    fn in_layer(&self, slot: usize, layer: usize, cell: usize) -> u32 {
        let mut planes = self.window.own_planes();
        let own = planes.find(|(shape, _)| place_of(*shape) == Some((slot, layer)));
        own.map_or(0, |(_, bytes)| value(bytes, cell))
    }
}

#[test]
fn no_quantum_is_made_or_lost() {
    let mut easel = Easel::new(192, Some((3, 4.25 * CELL))).load(0);
    let before = easel.counts();
    easel.stroke([0.010, 0.013], 0.016, 0.65);
    easel.stroke([0.013, 0.011], 0.017, 0.7);
    assert_eq!(easel.counts(), before);
    assert!(easel.laid() > 0.0);
}

#[test]
fn no_quantum_is_lost_in_the_tooth() {
    let mut easel = Easel::new(192, None).load(0);
    let before = easel.counts();
    easel.stroke([0.004, 0.009], 0.016, 0.65);
    easel.stroke([0.009, 0.006], 0.017, 0.6);
    assert_eq!(easel.counts(), before);
    assert!(easel.laid() > 0.0);
}

/// On fine cells a step is several cells long, and thin films leave no voxel.
#[test]
fn no_quantum_is_lost_on_fine_cells() {
    let scale = Scale {
        cell_m: 0.5 * SCALE.cell_m,
        ..SCALE
    };
    let mut easel = Easel::on(scale, "round", (256, None)).load(0);
    let before = easel.counts();
    easel.stroke([0.004, 0.012], 0.016, 0.65);
    assert_eq!(easel.counts(), before);
    assert!(easel.laid() > 0.0);
}

/// Heights after a stroke of a brush that exchanges no paint, relative to the ground's.
fn furrow(height: f64) -> Vec<f32> {
    let ground = 2.0 * CELL;
    let mut easel = Easel::new(192, Some((3, ground)));
    easel.handling.transfer = Transfer::Marker { flow: 0.0 };
    easel.stroke([0.010, 0.018], 0.016, height);
    let cells = 0..easel.window.width() * easel.window.height();
    cells
        .map(|cell| easel.window.total(cell) / ground)
        .collect()
}

#[test]
fn a_brush_ploughs_a_furrow_between_ridges() {
    let across = furrow(0.65);
    let least = across
        .iter()
        .fold(f32::MAX, |least, height| least.min(*height));
    let most = across.iter().fold(0.0f32, |most, height| most.max(*height));
    assert!(least < 0.7 && most > 1.3, "{least} {most}");
    // A brush above the paint leaves it unchanged.
    assert!(furrow(1.5).iter().all(|height| *height == 1.0));
}

#[test]
fn thin_paint_is_not_pushed_beside_a_lump_that_is() {
    let (middle, thin) = (64 * 192 + 60, (0.39 * CELL).floor());
    let pushed = |ground: f32| {
        let mut easel = Easel::new(192, Some((3, ground)));
        easel.handling.transfer = Transfer::Marker { flow: 0.0 };
        easel.window.plane_mut(3)[middle] = 4.0 * CELL;
        easel.stroke([0.012, 0.016], 0.016, 0.55);
        let lies = easel.window.plane(3).expect("there");
        let changed = (0..lies.len()).filter(|cell| lies[*cell] != ground);
        let far = |cell: &usize| (cell % 192).abs_diff(60).max((cell / 192).abs_diff(64)) > 6;
        (changed.clone().count(), changed.filter(far).count())
    };
    let (near, far) = pushed(thin);
    assert!(near > 1 && far == 0, "{near} {far}");
    assert!(pushed(2.0 * thin).1 > 0);
}

/// Roughness of paint behind a stroke along y in its direction, cells: the mean difference of heights from those two
/// cells before and behind; `ripple` is added to each fourth row.
fn roughness(window: &Window, ripple: f32) -> f32 {
    let width = window.width();
    let height = |cell: usize| {
        let is_fourth = (cell / width).is_multiple_of(4);
        let adds = if is_fourth { ripple } else { 0.0 };
        window.total(cell) / CELL + window.base()[cell] + adds
    };
    let bend = |cell: usize| {
        let [behind, before] = [cell - 2 * width, cell + 2 * width].map(height);
        (height(cell) - 0.5 * (behind + before)).abs()
    };
    let cells = (50..110).flat_map(|y| (86..106).map(move |x| y * width + x));
    let painted = cells.filter(|cell| window.total(*cell) > 0.5 * CELL);
    let bends: Vec<f32> = painted.map(bend).collect();
    bends.iter().sum::<f32>() / bends.len() as f32
}

#[test]
fn a_stroke_is_smooth_along_itself() {
    let mut easel = Easel::with("flat", 192, None);
    easel.bend = [0.0, -0.3];
    for strokes in 1..=3 {
        easel = easel.load(0);
        easel.stroke_between([[0.024, 0.008], [0.024, 0.040]], 0.7);
        let (rough, pimples) = (roughness(&easel.window, 0.0), roughness(&easel.window, 0.3));
        if strokes > 1 {
            assert!(
                rough < 0.12 && pimples > 0.12,
                "{strokes}: {rough} {pimples}"
            );
        }
    }
}

/// Share of the brush's paint that a stroke deposits in the lowest layer of a thick ground.
fn deep(height: f64) -> f64 {
    let mut easel = Easel::new(192, Some((3, 6.0 * CELL))).load(0);
    easel.stroke([0.010, 0.014], 0.016, height);
    let laid = easel.laid();
    assert!(laid > 0.0);
    let cells = easel.window.width() * easel.window.height();
    let above = (0..cells).map(|cell| {
        let layers = (1..20).map(|layer| easel.in_layer(0, layer, cell));
        layers.map(f64::from).sum::<f64>()
    });
    1.0 - above.sum::<f64>() / laid
}

#[test]
fn a_light_stroke_leaves_what_lies_deep() {
    let (light, heavy) = (deep(0.76), deep(0.6));
    assert!(light < 0.02 && heavy > 2.0 * light, "{light} {heavy}");
}

#[test]
fn a_step_depends_on_the_cells_around_the_brush_alone() {
    let paint = |cells| {
        let mut easel = Easel::new(cells, Some((3, 2.5 * CELL))).load(0);
        easel.stroke([0.010, 0.012], 0.016, 0.65);
        let width = easel.window.width();
        let planes = easel.window.planes();
        let rows = planes.flat_map(|(_, plane)| {
            (0..192).flat_map(move |y| plane[y * width..y * width + 192].to_vec())
        });
        rows.collect::<Vec<f32>>()
    };
    assert!(paint(192) == paint(256));
}

#[test]
fn paint_far_from_the_brush_neither_matters_nor_moves() {
    const FAR: usize = 9;
    let paint = |far: usize| {
        let mut easel = Easel::new(192, Some((3, 2.5 * CELL))).load(0);
        easel.window.plane_mut(FAR)[far] = 1_000.0;
        easel.stroke([0.010, 0.012], 0.016, 0.65);
        let lies = |slot| easel.window.plane(slot).expect("there").to_vec();
        ([0, 3].map(lies), lies(FAR))
    };
    let (near, low) = paint(5);
    let (same, _) = paint(191 * 192);
    assert!(near == same);
    assert!(low[5] == 1_000.0 && low.iter().sum::<f32>() == 1_000.0);
    // Where the brush is, it does.
    let (under, moved) = paint(64 * 192 + 44);
    assert!(under != near && moved != low);
}

#[test]
fn no_paint_hangs_in_the_air() {
    for ground in [0.0, 0.8 * CELL] {
        for height in [0.5, 0.6, 0.7] {
            let mut easel = Easel::new(192, Some((3, ground))).load(0);
            easel.stroke([0.010, 0.030], 0.016, height);
            let counts = easel.counts();
            easel.rest();
            assert_eq!(easel.counts(), counts);
            let loose = easel.loose() / easel.laid();
            assert!(loose == 0.0, "{ground} {height}: {loose} of what was laid");
            // A fault would be found.
            let cell = 60 * 192 + 60;
            easel.window.plane_mut(3)[cell] += CELL;
            let speck = easel.window.own_mut(shape_of(3, 9));
            speck[4 * cell..4 * cell + 4].copy_from_slice(&CELL.to_le_bytes());
            assert!(easel.loose() > 0.9 * f64::from(CELL));
        }
    }
}

#[test]
fn what_is_committed_is_read_again() {
    let mut easel = Easel::new(192, Some((3, 3.5 * CELL))).load(0);
    easel.stroke([0.010, 0.012], 0.016, 0.65);
    let before = easel.counts();
    let planes = easel.window.own_planes();
    let own: Vec<Vec<u8>> = planes.map(|(_, bytes)| bytes.to_vec()).collect();
    assert!(!own.is_empty());
    let [width, height] = [easel.window.width(), easel.window.height()];
    easel.window.touch(([0, 0], [width, height]));
    let (mut next, rect) = (0, easel.window.rect());
    easel.window.commit(&mut easel.store, &mut next, |_, _| ());
    easel.window.close(&mut easel.store);
    let relief = Relief::flat(SCALE.cell_m);
    easel.window = Window::open(&mut easel.store, rect, &relief).expect("free again");
    let again = easel.window.own_planes().map(|(_, bytes)| bytes.to_vec());
    let holds = |bytes: &Vec<u8>| bytes.iter().any(|byte| *byte != 0);
    assert!(again.eq(own.into_iter().filter(holds)));
    assert_eq!(easel.counts(), before);
}
