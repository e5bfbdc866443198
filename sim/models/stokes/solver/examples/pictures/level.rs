//! A thinned pool that levels under its weight: heights in mm over 16 mm at the left, from the first (dark) to the
//! last; at the right the remaining swell over time in seconds (rings) and exp(−σt) (line), with σ = g/(2νk)·(sinh
//! kh·cosh kh − kh)/(cosh² kh + (kh)²) for a viscous layer of depth h (Orchard 1963, with weight in place of surface
//! tension).

use std::f64::consts::PI;
use std::path::Path;

use maulstick_num::{cos, exp};
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;

use crate::image::{BLUE, Image, RED, viridis};
use crate::plot::Axes;
use crate::{CAPACITY, Drawn};

/// Length, depth and height of the swell, cells.
const LENGTH: usize = 128;
const DEPTH: f64 = 16.4;
const SWELL: f64 = 2.4;
const GRAVITY: f64 = 9.81;
const STEPS: usize = 60;

fn wave(x: usize) -> f64 {
    cos(2.0 * PI * (x as f64 + 0.5) / LENGTH as f64)
}

/// Paint of each column, cells.
fn heights(stokes: &Stokes) -> Vec<f64> {
    let mut heights = vec![0.0; LENGTH];
    for place in stokes.volume.grid.places() {
        let x = stokes.volume.grid.cell(place)[0] as usize;
        heights[x] += f64::from(stokes.volume.paints[0][place]) / f64::from(CAPACITY);
    }
    heights
}

/// A pool with the swell on it.
fn swollen_pool() -> Stokes {
    let grid = Grid {
        cells: [LENGTH, 1, 24],
        ends: [
            Ends::Periodic,
            Ends::Periodic,
            Ends::Sides([Side::NoSlip; 2]),
        ],
    };
    let mut stokes = Stokes::new(&grid, CAPACITY, 1);
    for place in grid.places() {
        let [x, _, z] = grid.cell(place);
        let filled = (DEPTH + SWELL * wave(x as usize) - z as f64).clamp(0.0, 1.0);
        stokes.volume.paints[0][place] = (filled * f64::from(CAPACITY)) as u32;
    }
    stokes
}

/// Lets the pool level and draws its surfaces; the remaining share of the swell over time, s.
fn draw_pool(image: &mut Image, conditions: &Conditions) -> Vec<[f64; 2]> {
    let mut stokes = swollen_pool();
    let cell_mm = 1e3 * conditions.cell_m;
    let pool = Axes {
        area: [70.0, 30.0, 560.0, 400.0],
        x: [0.0, LENGTH as f64 * cell_mm],
        y: [1.6, 2.4],
    };
    pool.frame(image, [2.0, 0.2], [0, 1]);
    let mut swells = Vec::new();
    for step in 0..=STEPS {
        let surface = heights(&stokes);
        let parts = surface
            .iter()
            .enumerate()
            .map(|(x, height)| height * wave(x));
        let swell = 2.0 * parts.sum::<f64>() / LENGTH as f64;
        swells.push([step as f64 * conditions.seconds, swell / SWELL]);
        if step.is_multiple_of(6) {
            let point = |(x, height): (usize, &f64)| [(x as f64 + 0.5) * cell_mm, height * cell_mm];
            let curve: Vec<[f64; 2]> = surface.iter().enumerate().map(point).collect();
            let colour = viridis(0.9 * step as f64 / STEPS as f64);
            pool.curve(image, &curve, 1.6, colour);
        }
        stokes.step(&[], conditions);
    }
    swells
}

/// Draws the swell over time beside its exact decay, 1/s.
fn draw_decay(image: &mut Image, swells: &[[f64; 2]], rate: f64) {
    let decay = Axes {
        area: [720.0, 30.0, 420.0, 400.0],
        x: [0.0, 0.6],
        y: [0.0, 1.0],
    };
    decay.frame(image, [0.1, 0.2], [1, 1]);
    let exact: Vec<[f64; 2]> = (0..=120)
        .map(|number| 0.005 * f64::from(number))
        .map(|time| [time, exp(-rate * time)])
        .collect();
    decay.curve(image, &exact, 1.6, RED);
    let computed: Vec<[f64; 2]> = swells.iter().copied().step_by(2).collect();
    decay.marks(image, &computed, BLUE);
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    // .5 Pa·s at 1200 kg/m³.
    let conditions = Conditions {
        cell_m: 1.25e-4,
        seconds: 0.01,
        paint: Paint::newtonian(0.5 / 1200.0),
        pull: [0.0, 0.0, -GRAVITY],
    };
    let mut image = Image::new(1180, 480);
    let swells = draw_pool(&mut image, &conditions);
    let rate = rate(&conditions);
    draw_decay(&mut image, &swells, rate);
    let [time, left] = swells[STEPS / 2];
    println!(
        "level: {left:.4} after {time} s, exact {:.4}",
        exp(-rate * time)
    );
    image.save(&folder.join("level.png"))
}

/// Decay of a low swell without inertia or surface tension, 1/s.
fn rate(conditions: &Conditions) -> f64 {
    let k = 2.0 * PI / (LENGTH as f64 * conditions.cell_m);
    let kh = k * DEPTH * conditions.cell_m;
    let [sinh, cosh] = [-1.0, 1.0].map(|sign| 0.5 * (exp(kh) + sign * exp(-kh)));
    GRAVITY / (2.0 * conditions.paint.viscosity * k) * (sinh * cosh - kh) / (cosh * cosh + kh * kh)
}
