//! A rod is drawn through paint and lifted out: stiff paint at the left keeps the ridge that overhangs, paint without a
//! yield stress at the right sinks. Slices from above downward; the last are a second and three seconds after the stroke.

use std::path::Path;

use maulstick_stokes::body::Rod;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;

use crate::image::{BLACK, GREY, Image};
use crate::plot::Axes;
use crate::slice::{Corners, paints};
use crate::{CAPACITY, Drawn};

const CELLS: [usize; 3] = [96, 1, 36];
const ZOOM: usize = 5;
const RADIUS: f32 = 4.0;
/// Steps of the rod along the canvas, with its lift, and all.
const ALONG: usize = 70;
const LIFTED: usize = 130;
const STEPS: [usize; 6] = [0, 35, 70, 95, 330, 730];
const SECONDS: f64 = 5e-3;

/// Middle of the rod at a step and its way to the next, cells.
fn rod(step: usize) -> [[f32; 2]; 2] {
    let along = step.min(ALONG) as f32;
    let lifted = (step - step.min(ALONG)) as f32;
    let way = if step < ALONG {
        [0.5, 0.0]
    } else {
        [0.15, 0.6]
    };
    let at = [14.0 + 0.5 * along + 0.15 * lifted, 5.5 + 0.6 * lifted];
    [at, way]
}

fn body(step: usize) -> Vec<Rod> {
    let [[x, z], way] = rod(step);
    let metres = |cells: f32| (f64::from(cells) * 2.5e-4 / SECONDS) as f32;
    let rod = Rod {
        ends: [[x, -20.0, z], [x, 20.0, z]],
        radius: RADIUS,
        velocity: [[metres(way[0]), 0.0, metres(way[1])]; 2],
    };
    if step < LIFTED { vec![rod] } else { Vec::new() }
}

/// Columns in which paint lies above air.
fn overhangs(stokes: &Stokes) -> usize {
    let grid = stokes.volume.grid;
    let column = |x: &usize| {
        let full = |z: &usize| {
            let place = grid.at([*x as isize, 0, *z as isize]);
            stokes.volume.paints[0][place] > CAPACITY / 2
        };
        let top = (0..CELLS[2]).rev().find(full);
        top.is_some_and(|top| (0..top).any(|z| !full(&z)))
    };
    (0..CELLS[0]).filter(column).count()
}

/// Draws where half of a cell is filled.
fn surface(stokes: &Stokes, image: &mut Image) {
    let grid = stokes.volume.grid;
    let [width, _, depth] = CELLS;
    let filled = |x: usize, z: usize| {
        let place = grid.at([x as isize, 0, z as isize]);
        f64::from(stokes.volume.paints[0][place]) / f64::from(CAPACITY)
    };
    // Middles of cells are the corners of this.
    let fill = Corners::new([width - 1, depth - 1], |[x, z]| filled(x, z));
    let axes = Axes {
        area: [0.0, 0.0, (ZOOM * width) as f64, (ZOOM * depth) as f64],
        x: [-0.5, width as f64 - 0.5],
        y: [-0.5, depth as f64 - 0.5],
    };
    axes.contour(image, |place| fill.at(place), 0.5, (1.4, BLACK));
}

/// Slices of one paint.
fn series(paint: Paint, name: &str) -> Vec<Image> {
    let walls = Ends::Sides([Side::NoSlip; 2]);
    let grid = Grid {
        cells: CELLS,
        ends: [walls, Ends::Periodic, walls],
    };
    let mut stokes = Stokes::new(&grid, CAPACITY, 1);
    for place in grid.block([10, 0, 0], [80, 1, 9]) {
        let [x, _, z] = grid.cell(place).map(|at| at as f32 + 0.5);
        let [[rod_x, rod_z], _] = rod(0);
        let apart = (x - rod_x) * (x - rod_x) + (z - rod_z) * (z - rod_z);
        if apart > RADIUS * RADIUS {
            stokes.volume.paints[0][place] = CAPACITY;
        }
    }
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: SECONDS,
        paint,
        pull: [0.0, 0.0, -9.81],
    };
    let mut images = Vec::new();
    for step in 0..=STEPS[STEPS.len() - 1] {
        if STEPS.contains(&step) {
            let mut image = paints(&stokes, &body(step), 0, ZOOM);
            surface(&stokes, &mut image);
            println!(
                "ridge, {name}, step {step}: {} columns overhang",
                overhangs(&stokes)
            );
            images.push(image);
        }
        stokes.step(&body(step), &conditions);
    }
    images
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    // 20 Pa·s and a yield stress of 150 Pa at 1800 kg/m³.
    let thin = Paint::newtonian(20.0 / 1800.0);
    let stiff = Paint {
        yields: 150.0 / 1800.0,
        ..thin
    };
    let [width, height] = [ZOOM * CELLS[0], ZOOM * CELLS[2]];
    let mut image = Image::new(2 * width + 30, STEPS.len() * (height + 12) + 10);
    for (column, (paint, name)) in [(stiff, "stiff"), (thin, "thin")].into_iter().enumerate() {
        for (row, slice) in series(paint, name).iter().enumerate() {
            let [left, top] = [10 + column * (width + 10), 4 + row * (height + 12)];
            image.paste(slice, left, top);
            let canvas = [left, top + height, width, 4];
            image.fill(canvas.map(|side| side as f64), GREY);
        }
    }
    image.save(&folder.join("ridge.png"))
}
