//! Lid-driven cavity without inertia: speed as colour, stream lines at equal steps of the stream function.

use std::path::Path;

use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

use crate::Drawn;
use crate::image::{BLACK, GREY, Image};
use crate::plot::{Axes, colour_bar};
use crate::slice::{speed, stream};

const CELLS: usize = 64;
const WALL: f64 = 14.0;

/// Steady flow under a lid of velocity 1.
fn flow() -> Flow {
    let walls = Ends::Sides([Side::NoSlip; 2]);
    let grid = Grid {
        cells: [CELLS, 1, CELLS],
        ends: [walls, Ends::Periodic, walls],
    };
    let mut solids = Solids::walls(&grid);
    for place in 0..grid.len() {
        let [x, _, z] = grid.cell(place);
        if z >= CELLS as isize && (1..CELLS as isize).contains(&x) {
            solids.velocity[0][place] = 1.0;
        }
    }
    let mut flow = Flow::new(&grid);
    flow.effort.steps = 40;
    let conditions = Conditions {
        cell_m: 1.0,
        seconds: 1e6,
        paint: Paint::newtonian(1.0),
        pull: [0.0; 3],
    };
    for _ in 0..3 {
        flow.step(&vec![1.0; grid.len()], &solids, &conditions);
    }
    flow
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    let flow = flow();
    let side = CELLS as f64;
    let (stream, speed) = (stream(&flow), speed(&flow, |_| [1.0, 0.0]));
    let most = stream
        .values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    println!("cavity: stream function {:.4} at most", most / side);
    let mut image = Image::new(760, 660);
    let axes = Axes {
        area: [50.0, 50.0, 560.0, 560.0],
        x: [0.0, side],
        y: [0.0, side],
    };
    let [left, top, width, height] = axes.area;
    image.fill([left - WALL, top, width + 2.0 * WALL, height + WALL], GREY);
    axes.colours(&mut image, |place| speed.at(place));
    for level in [
        0.001, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.098,
    ] {
        let magnitude = |place| stream.at(place).map(f64::abs);
        axes.contour(&mut image, magnitude, level * side, (1.4, [255.0; 3]));
    }
    image.fill([left, top - WALL, width, WALL - 2.0], BLACK);
    image.arrow(
        [left + 180.0, top - 28.0],
        [left + width - 180.0, top - 28.0],
        BLACK,
    );
    colour_bar(&mut image, [660.0, top, 24.0, height], 1.0, 0.2, 1);
    image.save(&folder.join("cavity.png"))
}
