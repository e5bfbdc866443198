//! Seeded scenes: a surface of 2×2 tiles with tooth and wet paint, a head with random strips, and films of several
//! paints.

use maulstick_brush::head::STATIONS;
use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;
use maulstick_impasto::stages::advection::STAIN;
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::interface::{Handling, Step, Sweep};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

pub(crate) const CELL_M: f64 = 2.5e-4;
/// Size of the surface, cells; the last tiles extend over its edge.
pub(crate) const CELLS: [u32; 2] = [100, 90];
/// Number of paints in use.
pub(crate) const PAINTS: usize = 4;

pub(crate) struct Random(Pcg32);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg32::new(seed, 7))
    }

    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4_294_967_296.0
    }

    pub(crate) fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}

/// A window on a whole surface.
pub(crate) fn window(relief: &Relief) -> Window {
    let mut store = TileStore::new(CELLS);
    let all = store
        .around([0; 2], CELLS.map(i64::from))
        .expect("a surface");
    Window::open(&mut store, all, relief).expect("free")
}

/// The library's round brush with this number and width of strips.
pub(crate) fn brush(strips: usize, width_mm: f64) -> BrushFile {
    let mut file = BrushFile::library("round").expect("round");
    (file.strips.count, file.strips.width_mm) = (strips, width_mm);
    file
}

pub(crate) struct Scene {
    pub(crate) window: Window,
    pub(crate) head: Head,
    pub(crate) from: HeadPose,
    pub(crate) to: HeadPose,
    pub(crate) load: BrushLoad,
    pub(crate) traits: BrushTraits,
    pub(crate) bounds: ([i64; 2], [i64; 2]),
    pub(crate) handling: Handling,
    pub(crate) thinner: Option<usize>,
}

impl Scene {
    /// A scene on linen.
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let file = brush(24, random.range(0.1, 1.2));
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, CELL_M, 1.0);
        let tooth = Tooth::new("linen", seed, CELL_M).expect("linen");
        let mut window = window(&Relief::new(tooth, CELL_M));
        // Up to four cells of paint on a part of the surface.
        spill(&mut window, &mut random, 4.0 / traits.cells_per_quantum);
        let (from, to) = poses(&mut random, head.strips());
        let load = load(&mut random, &head, &traits, seed);
        let bounds = ([-3, 5], [96, 120]);
        Self {
            window,
            head,
            from,
            to,
            load,
            traits,
            bounds,
            handling: Handling::default(),
            thinner: None,
        }
    }

    /// The scene with a motion of its brush `times` as long, and slightly up or down.
    pub(crate) fn far(seed: u64, times: f32) -> Self {
        let mut scene = Self::new(seed);
        let mut random = Random::new(seed + 50);
        let (from, to) = (&mut scene.from, &scene.to);
        for i in 0..to.x.len() {
            from.x[i] = to.x[i] + times * (from.x[i] - to.x[i]);
            from.y[i] = to.y[i] + times * (from.y[i] - to.y[i]);
            from.z[i] = (to.z[i] + random.range(-0.2, 0.2) as f32).max(0.0);
        }
        scene.traits.step_cells = times;
        scene
    }

    pub(crate) fn step(&mut self) -> Step<'_> {
        Step {
            window: &mut self.window,
            head: &self.head,
            sweep: Sweep {
                before: None,
                from: &self.from,
                to: &self.to,
            },
            bounds: self.bounds,
            load: &mut self.load,
            traits: self.traits,
            handling: self.handling,
            stain: STAIN,
            lasting: false,
            thinner: self.thinner,
        }
    }

    /// Paint on surface and brush.
    pub(crate) fn counts(&self) -> Counts {
        let mut counts = lying(&self.window);
        maulstick_canvas::quantum::add(&mut counts, &self.load.counts());
        counts
    }
}

/// Patches of paint of up to `most` quanta, some bare cells between them.
pub(crate) fn spill(window: &mut Window, random: &mut Random, most: f32) {
    let [right, top] = window.limit();
    let width = window.width();
    for slot in 0..PAINTS {
        let plane = window.plane_mut(2 * slot);
        for _ in 0..3 {
            let (x0, y0) = (random.below(right), random.below(top));
            let thick = random.unit() * f64::from(most) / PAINTS as f64;
            for y in y0..(y0 + 40).min(top) {
                for x in x0..(x0 + 40).min(right) {
                    let count = thick * random.range(0.5, 1.0);
                    plane[y * width + x] = (count as u32) as f32;
                }
            }
        }
    }
}

/// Strips that bend, hang, lie and stand in and around the surface, and move by about a cell.
fn poses(random: &mut Random, strips: usize) -> (HeadPose, HeadPose) {
    let blank = || HeadPose {
        x: vec![0.0; strips * STATIONS],
        y: vec![0.0; strips * STATIONS],
        z: vec![0.0; strips * STATIONS],
        ..HeadPose::default()
    };
    let (mut from, mut to) = (blank(), blank());
    to.press = random.unit() as f32;
    to.splay = to.press;
    to.bend = [
        random.range(-0.6, 0.6) as f32,
        random.range(-0.6, 0.6) as f32,
    ];
    let together = [random.range(-0.7, 0.7), random.range(-0.7, 0.7)];
    for strip in 0..strips {
        let mut at = [random.range(-8.0, 105.0), random.range(-8.0, 95.0)];
        let mut height = random.range(0.0, 3.0);
        let stride = random.range(0.0, 1.0) * random.range(0.1, 8.0);
        let mut turn = random.range(0.0, 6.3);
        for station in 0..STATIONS {
            let i = station * strips + strip;
            (to.x[i], to.y[i]) = (at[0] as f32, at[1] as f32);
            to.z[i] = height.max(0.0) as f32;
            from.x[i] = (at[0] - together[0] - random.range(-0.3, 0.3)) as f32;
            from.y[i] = (at[1] - together[1] - random.range(-0.3, 0.3)) as f32;
            from.z[i] = to.z[i];
            turn += random.range(-0.5, 0.5);
            let (sine, cosine) = maulstick_num::sin_cos(turn);
            at = [at[0] + stride * cosine, at[1] + stride * sine];
            height += random.range(-0.8, 0.5);
        }
    }
    (from, to)
}

/// Films from none to twice full, and paint inside, in a load with that seed.
fn load(random: &mut Random, head: &Head, traits: &BrushTraits, seed: u64) -> BrushLoad {
    let mut load = BrushLoad::clean(head.strips());
    load.fill(head, traits, &[], None, (Half::Both, seed));
    for texel in 0..head.strips() * TEXELS_PER_STRIP {
        for slot in [0, 2, 5] {
            let share = [0.0, 0.05, 0.3, 0.66][random.below(4)];
            let count = (traits.film_full * share * random.unit()) as u32;
            load.add_film(slot, texel, count);
            let (_, inside) = load.planes_mut(slot).expect("just made");
            inside[texel] = (traits.inside_full * random.unit()) as u32;
        }
    }
    load.count_films();
    load
}

/// Counts on a window; every cell must hold a whole number from 0 to its capacity.
pub(crate) fn lying(window: &Window) -> Counts {
    let mut counts = [0; SLOTS];
    for (slot, plane) in window.planes() {
        for count in plane {
            assert!(*count >= 0.0 && count.fract() == 0.0, "{count} quanta");
            counts[slot] += *count as u64;
        }
    }
    counts
}

/// A copy of a window's planes, by slot.
pub(crate) fn planes(window: &Window) -> Vec<(usize, Vec<f32>)> {
    let copy = |(slot, plane): (usize, &[f32])| (slot, plane.to_vec());
    window.planes().map(copy).collect()
}
