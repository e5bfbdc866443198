//! The mark under a head: its middle, and the offset of the handle that puts it at a pen's point.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::{Rigid, rotation};
use maulstick_num::{acos, atan2, sin_cos};

use crate::desk::Obstacle;
use crate::file::BrushFile;
use crate::file::sections::Layout;
use crate::head::{Head, HeadPose, Hold, STATIONS};
use crate::head_solver::{HeadSolver, SolvedHead};
use crate::solver::Settings;
use crate::spine_layout::SpineLayout;

/// Number of strips by which the mark is measured.
const STRIPS: usize = 200;
/// Number of places tested between two stations.
const BETWEEN: usize = 8;
/// Cells per width of the head: touched places in one cell count once.
const CELLS: f64 = 20.0;

/// Film on a brush that has painted a little, µm; a full one reaches farther only at first.
const FILM_UM: f64 = 420.0;

/// Additional depth, beyond the tooth, to which a fully pressed head sinks among its own bristles, mm.
const GIVES_MM: f64 = 0.09;

/// Measures the mark of a head.
#[derive(Clone, Debug)]
pub struct Mark {
    head: Head,
    pose: HeadPose,
    cell_m: f64,
    /// Reach of a film of paint and half a strip, m.
    reach_m: f64,
    lift_m: f64,
    sink_m: f64,
    touched: Vec<DVec2>,
    cells: Vec<bool>,
}

impl Mark {
    /// The mark of a brush that carries paint.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let mut few = file.clone();
        few.strips.count = few.strips.count.min(STRIPS);
        few.surface = None;
        let strips = &file.strips;
        Self {
            head: Head::of(&few),
            pose: HeadPose::default(),
            cell_m: 1e-3 * file.head.width_mm / CELLS,
            reach_m: 1e-6 * file.load.film_um.min(FILM_UM) + 0.5e-3 * strips.thickness_mm,
            lift_m: 1e-3 * strips.lift_mm,
            sink_m: 1e-3 * (strips.sink_mm + GIVES_MM),
            touched: Vec::new(),
            cells: Vec::new(),
        }
    }

    /// Middle of the contact of a head at pose `brush` over the surface z = 0, bent by `angles`, m; `None` if it
    /// touches nothing.
    pub fn middle(&mut self, brush: &Rigid, angles: &[[f32; 2]]) -> Option<DVec2> {
        let hold = Hold {
            brush,
            angles,
            per_m: 1.0,
            wetness: 1.0,
        };
        self.head.pose(&hold, &mut self.pose);
        self.touch();
        let first = *self.touched.first()?;
        let box_of = |(least, most): (DVec2, DVec2), p: &DVec2| (least.min(*p), most.max(*p));
        let (least, most) = self.touched.iter().fold((first, first), box_of);
        let columns = ((most.x - least.x) / self.cell_m) as usize + 1;
        let rows = ((most.y - least.y) / self.cell_m) as usize + 1;
        self.cells.clear();
        self.cells.resize(columns * rows, false);
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        for p in &self.touched {
            let [i, j] = ((*p - least) / self.cell_m).to_array().map(|v| v as usize);
            let cell = &mut self.cells[j * columns + i];
            if !std::mem::replace(cell, true) {
                sum += DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
                count += 1.0;
            }
        }
        Some(least + sum * (self.cell_m / count))
    }

    /// Collects the places of strips that reach the surface.
    fn touch(&mut self) {
        let (pose, count) = (&self.pose, self.head.strips());
        let press = f64::from(pose.press);
        let pressed = self.reach_m + self.sink_m * press;
        let loose = self.lift_m * (1.0 - press);
        self.touched.clear();
        for i in 0..(STATIONS - 1) * count {
            let reach = pressed - loose * f64::from(self.head.lift()[i % count]);
            let (low, high) = (f64::from(pose.z[i + count]), f64::from(pose.z[i]));
            if low.min(high) > reach {
                continue;
            }
            let at = |i: usize| DVec3::from_array([pose.x[i], pose.y[i], pose.z[i]].map(f64::from));
            let (a, b) = (at(i), at(i + count));
            for part in 1..=BETWEEN {
                let p = a.lerp(b, part as f64 / BETWEEN as f64);
                if p.z <= reach {
                    self.touched.push(p.truncate());
                }
            }
        }
    }
}

/// Point where the axis of a handle meets the surface z = 0: the point of a pen, m.
#[must_use]
pub fn point_of(handle: &Rigid) -> DVec2 {
    let axis = handle.vector(DVec3::Z);
    let along = handle.translation.z / axis.z.max(1e-6);
    (handle.translation - axis * along).truncate()
}

/// Leans of the table, degrees from upright.
const LEANS: [f64; 7] = [0.0, 12.0, 24.0, 36.0, 48.0, 64.0, 85.0];
/// Depths of the table: lowering of the handle along its axis, by the length of the head.
const DEPTHS: [f64; 8] = [0.0, 0.02, 0.06, 0.12, 0.2, 0.3, 0.45, 0.9];
/// Number of turns about the handle's axis, for a head that is no ring.
const TURNS: usize = 12;
/// Lean, rad, below which the bend of the head also decides to which side a handle leans.
const UPRIGHT: f64 = 0.05;

/// Offset of the middle of a head's mark from the point of its handle when it is set down, as a solved table.
#[derive(Clone, Debug)]
pub struct Beside {
    turns: usize,
    /// Offsets for a handle that leans to the right, ordered by lean, then turn, then depth, m.
    table: Vec<DVec2>,
}

impl Beside {
    /// Solves the table of a head of `length_m`.
    #[must_use]
    pub fn of(
        mark: &mut Mark,
        layout: Layout,
        tuft: &SpineLayout,
        settings: &Settings,
        length_m: f64,
    ) -> Self {
        let turns = if layout == Layout::Ring { 1 } else { TURNS };
        // An upright head gives way to the left, as one does whose handle leans to the right.
        let settings = Settings {
            yields: DVec2::NEG_X,
            ..*settings
        };
        let (ground, mut room) = ([Obstacle::ground()], HeadSolver::default());
        let mut table = Vec::new();
        for lean in LEANS {
            for turn in 0..turns {
                let turn = std::f64::consts::TAU * turn as f64 / turns as f64;
                let held = rotation(DVec3::Y, lean.to_radians()) * rotation(DVec3::Z, turn);
                let axis = held * DVec3::Z;
                for depth in DEPTHS {
                    let mut brush = Rigid {
                        rotation: held,
                        translation: axis * (length_m * (1.0 - depth)),
                    };
                    tuft.raise(&mut brush, length_m);
                    let mut head = SolvedHead::at_rest(tuft, &brush);
                    head.solve(&mut room, tuft, &brush, &ground, &settings);
                    table.push(mark.middle(&brush, &head.angles()).unwrap_or(DVec2::ZERO));
                }
            }
        }
        Self { turns, table }
    }

    /// Offset of the mark's middle from the point of `handle`, over the surface z = 0 with a head of `length_m` that
    /// is `bent` to one side, all in m. The handle counts as lowered onto the surface.
    #[must_use]
    pub fn at(&self, handle: &Rigid, bent: DVec2, length_m: f64) -> DVec2 {
        let axis = handle.vector(DVec3::Z);
        let depth = 1.0 - handle.translation.z / (length_m * axis.z.max(1e-3));
        let toward = axis.truncate() - bent.normalize_or_zero() * UPRIGHT;
        let azimuth = atan2(toward.y, toward.x);
        let lean = acos(axis.z.clamp(-1.0, 1.0));
        // R = R_z(azimuth)·R_y(lean)·R_z(turn).
        let upright = rotation(DVec3::Y, -lean) * rotation(DVec3::Z, -azimuth) * handle.rotation;
        let right = upright * DVec3::X;
        let turn = atan2(right.y, right.x) / std::f64::consts::TAU;
        let (i, s) = place(&LEANS, lean.to_degrees());
        let (k, t) = place(&DEPTHS, depth);
        let around = turn.rem_euclid(1.0) * self.turns as f64;
        let (j, r) = (around as usize, around.fract());
        let entry = |i: usize, j: usize, k: usize| {
            self.table[(i * self.turns + j % self.turns) * DEPTHS.len() + k]
        };
        let over_depth = |i, j| entry(i, j, k).lerp(entry(i, j, k + 1), t);
        let over_turn = |i| over_depth(i, j).lerp(over_depth(i, j + 1), r);
        let beside = over_turn(i).lerp(over_turn(i + 1), s);
        let (sine, cosine) = sin_cos(azimuth);
        DVec2::new(cosine, sine).rotate(beside)
    }
}

/// Index of the interval of ascending places that holds `value`, and the fraction within it.
fn place(places: &[f64], value: f64) -> (usize, f64) {
    let last = places.len() - 2;
    let i = places
        .iter()
        .skip(1)
        .take(last)
        .filter(|p| **p <= value)
        .count();
    let share = (value - places[i]) / (places[i + 1] - places[i]);
    (i, share.clamp(0.0, 1.0))
}
