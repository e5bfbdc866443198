//! Results of stages on the device, on seeded scenes.

use std::collections::BTreeMap;

use maulstick_canvas::quantum::{QUANTA_PER_UNIT, SLOTS};
use maulstick_impasto::device::probe::{Probe, Prober};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::footprint::contact::Contact;

use crate::scene::{PAINTS, Random, Scene};

/// Tolerance of velocities: a few operations on numbers of at most some cells.
pub(crate) const VELOCITY_TOLERANCE: f64 = 4e-6;

/// A scene after `steps` steps of its brush; some are nearly full, and some have all their strips on few texels.
pub(crate) fn scene(seed: u64, steps: u64) -> Scene {
    let mut scene = Scene::new(seed);
    if seed % 4 == 3 {
        let cells = scene.window.width() * scene.window.height();
        let mut random = Random::new(seed);
        for slot in 0..PAINTS {
            let plane = scene.window.plane_mut(2 * slot);
            for count in plane.iter_mut().take(cells) {
                *count = (random.range(0.2, 0.25) * QUANTA_PER_UNIT).floor() as f32;
            }
        }
        // The area beside the surface is bare.
        let [right, top] = scene.window.limit();
        let width = scene.window.width();
        for (_, plane) in scene.window.planes_mut() {
            for (cell, count) in plane.iter_mut().enumerate() {
                if cell % width >= right || cell / width >= top {
                    *count = 0.0;
                }
            }
        }
    }
    if seed % 2 == 1 {
        scene.traits.film_most *= 0.05;
    }
    scene.load = stepped(&scene.load, steps);
    scene
}

pub(crate) fn stepped(load: &BrushLoad, steps: u64) -> BrushLoad {
    let planes = (0..SLOTS).filter_map(|slot| {
        let parts = [load.film_of(slot)?, load.inside(slot)?];
        Some((slot, parts.map(<[u32]>::to_vec)))
    });
    BrushLoad::of_planes(steps, load.films().to_vec(), planes.collect()).expect("they fit")
}

pub(crate) fn run(prober: &mut Prober, scene: &mut Scene, last: &str) -> Probe {
    let probe = prober.run(&mut scene.step(), last).expect("done");
    probe.expect("on the surface")
}

/// The grid of a probe over the scene's window.
pub(crate) struct Grid<'a> {
    probe: &'a Probe,
    pub(crate) touched: BTreeMap<[i64; 2], Contact>,
    pub(crate) limit: [i64; 2],
    /// The contacts and one cell more to each side, half-open.
    around: [[i64; 2]; 2],
    row: i64,
}

impl<'a> Grid<'a> {
    pub(crate) fn new(probe: &'a Probe, scene: &Scene) -> Self {
        let row = scene.window.width() as i64;
        let touched = probe.contacts.iter();
        let touched = touched.map(|c| ([i64::from(c.cell) % row, i64::from(c.cell) / row], *c));
        let touched: BTreeMap<[i64; 2], Contact> = touched.collect();
        let limit = scene.window.limit().map(|cells| cells as i64);
        let least = [0, 1].map(|i| touched.keys().map(|at| at[i]).min().expect("a contact"));
        let most = [0, 1].map(|i| touched.keys().map(|at| at[i]).max().expect("a contact"));
        Self {
            probe,
            touched,
            limit,
            around: [
                least.map(|cell| (cell - 1).max(0)),
                [0, 1].map(|i| (most[i] + 2).min(limit[i])),
            ],
            row,
        }
    }

    pub(crate) fn is_around(&self, at: [i64; 2]) -> bool {
        let [from, to] = self.around;
        (0..2).all(|i| (from[i]..to[i]).contains(&at[i]))
    }

    pub(crate) fn is_on_surface(&self, at: [i64; 2]) -> bool {
        (0..2).all(|i| (0..self.limit[i]).contains(&at[i]))
    }

    /// The device's velocity through the face ahead of a cell of the window.
    pub(crate) fn face(&self, at: [i64; 2], axis: usize) -> f64 {
        let local = [0, 1].map(|i| at[i] - self.probe.from[i] as i64);
        let inside = (0..2).all(|i| (0..self.probe.size[i] as i64).contains(&local[i]));
        if !inside {
            return 0.0;
        }
        let place = local[1] * self.probe.size[0] as i64 + local[0];
        f64::from(self.probe.faces[place as usize][axis])
    }

    pub(crate) fn cell(&self, at: [i64; 2]) -> usize {
        (at[1] * self.row + at[0]) as usize
    }
}

pub(crate) fn ahead(at: [i64; 2], axis: usize, by: i64) -> [i64; 2] {
    let mut at = at;
    at[axis] += by;
    at
}
