//! Channels between two walls: rings are the computed velocities, lines the exact ones. A Newtonian fluid at the left, a
//! Bingham fluid at the right, with its plug in grey.

use std::path::Path;

use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

use crate::Drawn;
use crate::image::{BLUE, GREY, Image, PALE, RED};
use crate::plot::Axes;

/// Velocities along x at the middles of cells, pulled by an acceleration of 1, from the lower wall on.
fn channel(cells: usize, paint: Paint, steps: usize) -> Vec<f64> {
    let grid = Grid {
        cells: [4, cells, 4],
        ends: [
            Ends::Periodic,
            Ends::Sides([Side::NoSlip; 2]),
            Ends::Periodic,
        ],
    };
    let mut flow = Flow::new(&grid);
    let conditions = Conditions {
        cell_m: 1.0,
        seconds: 1e6,
        paint,
        pull: [1.0, 0.0, 0.0],
    };
    for _ in 0..steps {
        flow.step(&vec![1.0; grid.len()], &Solids::walls(&grid), &conditions);
    }
    let at = |y| f64::from(flow.velocity[0][grid.at([1, y, 1])]);
    (0..cells as isize).map(at).collect()
}

/// Velocity of a Bingham fluid of viscosity 1 at a distance from the middle, by half widths of channel and plug.
fn exact(half: f64, plug: f64, from_middle: f64) -> f64 {
    let [whole, here] = [half, from_middle.abs().max(plug)].map(|at| (at - plug) * (at - plug));
    0.5 * (whole - here)
}

/// One channel: velocity, relative to the fastest, across; height upward.
fn panel(image: &mut Image, left: f64, computed: &[f64], plug: f64) {
    let cells = computed.len() as f64;
    let half = 0.5 * cells;
    let fastest = exact(half, plug, 0.0);
    let axes = Axes {
        area: [left, 40.0, 400.0, 480.0],
        x: [0.0, 1.1],
        y: [0.0, 1.0],
    };
    let [left, top, width, height] = axes.area;
    if plug > 0.0 {
        let high = height * plug / half;
        image.fill([left, top + 0.5 * (height - high), width, high], PALE);
    }
    axes.frame(image, [0.2, 0.25], [1, 2]);
    image.fill([left, top - 8.0, width, 8.0], GREY);
    image.fill([left, top + height + 1.0, width, 8.0], GREY);
    let curve: Vec<[f64; 2]> = (0..=480)
        .map(|number| {
            let up = f64::from(number) / 480.0;
            [exact(half, plug, cells * up - half) / fastest, up]
        })
        .collect();
    axes.curve(image, &curve, 1.6, RED);
    let marks: Vec<[f64; 2]> = (computed.iter().enumerate())
        .map(|(node, u)| [u / fastest, (node as f64 + 0.5) / cells])
        .step_by(computed.len().div_ceil(32))
        .collect();
    axes.marks(image, &marks, BLUE);
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    let mut image = Image::new(1000, 580);
    let plug = 16.0;
    let bingham = Paint {
        yields: plug,
        ..Paint::newtonian(1.0)
    };
    panel(
        &mut image,
        70.0,
        &channel(16, Paint::newtonian(1.0), 3),
        0.0,
    );
    panel(&mut image, 560.0, &channel(64, bingham, 60), plug);
    image.save(&folder.join("channel.png"))
}
