//! A blunt blade is pushed sideways through paint and then drawn out endwise with the paint in its cells: stiff paint
//! at the left keeps the ridge that overhangs, paint without a yield stress at the right sinks. Slices from above
//! downward; the last three show the paint just after the blade, half a second and two seconds later.

use std::path::Path;

use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;

use crate::image::{BLACK, GREY, Image};
use crate::plot::Axes;
use crate::slice::{Corners, paints};
use crate::{CAPACITY, Drawn};

const CELLS: [usize; 3] = [96, 1, 28];
const ZOOM: usize = 5;
const RADIUS: f32 = 3.5;
const LENGTH: f32 = 80.0;
/// Motion of the blade in a step, cells.
const WAY: f32 = 0.5;
/// Steps until the blade stops, until it has been drawn out, and steps that are drawn.
const ALONG: usize = 70;
const GONE: usize = 80;
const STEPS: [usize; 6] = [0, 35, 70, 80, 130, 280];
/// Length of a step with and without the blade, s.
const SECONDS: f64 = 5e-3;
const AFTER_SECONDS: f64 = 1e-2;

/// Middle of the blade's round edge at a step, cells.
fn middle(step: usize) -> [f32; 2] {
    [12.0 + WAY * step.min(ALONG) as f32, 5.5]
}

fn body(step: usize) -> Vec<Rod> {
    let [x, z] = middle(step);
    let speed = (f64::from(WAY) * 2.5e-4 / SECONDS) as f32;
    let rod = Rod {
        ends: [[x, 0.5, z], [x - LENGTH, 0.5, z]],
        radius: RADIUS,
        velocity: if step < ALONG {
            [[speed, 0.0, 0.0]; 2]
        } else {
            [[0.0, speed, 0.0]; 2]
        },
    };
    if step < GONE { vec![rod] } else { Vec::new() }
}

/// Removes the paint in the blade's cells, where transport leaves some of the paint that it overtakes; returns its
/// amount, cells.
fn take_along(stokes: &mut Stokes) -> f64 {
    let grid = stokes.volume.grid;
    let mut solids = stokes.base.clone();
    voxelise(&grid, &mut solids, &body(GONE - 1));
    let above = grid.stride(2);
    let inside = |place: &usize| {
        let corners = [0, 1, above, above + 1].map(|by| solids.distance[place + by]);
        corners.iter().sum::<f32>() < 0.0
    };
    let cells: Vec<usize> = grid.places().filter(inside).collect();
    let paint = &mut stokes.volume.paints[0];
    let taken: u32 = cells
        .iter()
        .map(|place| std::mem::take(&mut paint[*place]))
        .sum();
    f64::from(taken) / f64::from(CAPACITY)
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

/// Draws the contour of half-filled cells.
fn surface(stokes: &Stokes, image: &mut Image) {
    let grid = stokes.volume.grid;
    let [width, _, depth] = CELLS;
    let filled = |x: usize, z: usize| {
        let place = grid.at([x as isize, 0, z as isize]);
        f64::from(stokes.volume.paints[0][place]) / f64::from(CAPACITY)
    };
    // Middles of cells are the corners of this field.
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
    for place in grid.block([18, 0, 0], [80, 1, 9]) {
        stokes.volume.paints[0][place] = CAPACITY;
    }
    let mut conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: SECONDS,
        paint,
        pull: [0.0, 0.0, -9.81],
    };
    let mut images = Vec::new();
    for step in 0..=STEPS[STEPS.len() - 1] {
        if step == GONE {
            let taken = take_along(&mut stokes);
            println!("ridge, {name}: {taken:.1} cells of paint go with the blade");
            conditions.seconds = AFTER_SECONDS;
        }
        if STEPS.contains(&step) {
            let mut image = paints(&stokes, &[], 0, ZOOM);
            surface(&stokes, &mut image);
            if step < GONE {
                let [x, z] = middle(step).map(|at| ZOOM as f64 * f64::from(at));
                let radius = ZOOM as f64 * f64::from(RADIUS);
                let height = image.height as f64 - z;
                image.line([0.0, height], [x, height], 2.0 * radius, GREY);
            }
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
