//! Squeeze film under a long plate that comes down. Above: speed and stream lines, with heights enlarged four times;
//! below: the pressure on the plate (rings) and Reynolds' 6μV(L² − x²)/h³ (line), relative to its maximum.

use std::path::Path;

use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;

use crate::Drawn;
use crate::image::{BLACK, BLUE, GREY, Image, RED};
use crate::plot::{Axes, colour_bar};
use crate::slice::{speed, stream};

/// Half of the plate and the gap, cells.
const HALF: usize = 256;
const GAP: usize = 16;

/// Flow under the right half of a plate of velocity −1, whose middle is a plane of symmetry.
fn flow() -> Flow {
    let grid = Grid {
        cells: [HALF + 8, 1, GAP],
        ends: [
            Ends::Sides([Side::Slip; 2]),
            Ends::Periodic,
            Ends::Sides([Side::NoSlip; 2]),
        ],
    };
    let mut solids = Solids::walls(&grid);
    let mut fill = grid.field();
    for (place, fill) in fill.iter_mut().enumerate() {
        let [x, _, z] = grid.cell(place);
        if x < HALF as isize {
            *fill = 1.0;
            if z == GAP as isize {
                solids.velocity[2][place] = -1.0;
            }
        }
    }
    let mut flow = Flow::new(&grid);
    flow.effort.steps = 40;
    let conditions = Conditions {
        cell_m: 1.0,
        seconds: 1e8,
        paint: Paint::newtonian(1.0),
        pull: [0.0; 3],
    };
    for _ in 0..3 {
        flow.step(&fill, &solids, &conditions);
    }
    flow
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    let flow = flow();
    let [half, gap] = [HALF, GAP].map(|cells| cells as f64);
    let (stream, speed) = (stream(&flow), speed(&flow, |_| [0.0, -1.0]));
    // Of Reynolds' 6Vx·z(h − z)/h³.
    let fastest = 1.5 * half / gap;
    let mut image = Image::new(1160, 640);
    let film = Axes {
        area: [80.0, 60.0, 960.0, 120.0],
        x: [-half, half],
        y: [0.0, gap],
    };
    let [left, top, width, height] = film.area;
    let beside = |[x, z]: [f64; 2]| [x.abs(), z];
    film.colours(&mut image, |place| Some(speed.at(beside(place))? / fastest));
    for part in 1..8 {
        let level = f64::from(part) / 8.0 * half;
        let magnitude = |place| stream.at(beside(place)).map(f64::abs);
        film.contour(&mut image, magnitude, level, (1.4, [255.0; 3]));
    }
    image.fill([left, top - 14.0, width, 14.0], GREY);
    image.fill([left - 30.0, top + height, width + 60.0, 14.0], GREY);
    for number in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let x = left + number * width;
        image.arrow([x, top - 44.0], [x, top - 18.0], BLACK);
    }
    colour_bar(&mut image, [1080.0, top, 20.0, height], fastest, 8.0, 0);
    let pressure = Axes {
        area: [80.0, 240.0, 960.0, 350.0],
        x: [-1.0, 1.0],
        y: [0.0, 1.1],
    };
    pressure.frame(&mut image, [0.25, 0.2], [2, 1]);
    let exact: Vec<[f64; 2]> = (-200..=200)
        .map(|number| f64::from(number) / 200.0)
        .map(|x| [x, 1.0 - x * x])
        .collect();
    pressure.curve(&mut image, &exact, 1.6, RED);
    let largest = 6.0 * half * half / (gap * gap * gap);
    let under = |x: usize| {
        let place = flow.grid.at([x as isize, 0, GAP as isize - 1]);
        f64::from(flow.pressure[place]) / largest
    };
    println!(
        "squeeze: pressure in the middle {:.4} of Reynolds'",
        under(0)
    );
    let computed: Vec<[f64; 2]> = (4..HALF)
        .step_by(8)
        .flat_map(|x| [-1.0, 1.0].map(|side| [side * (x as f64 + 0.5) / half, under(x)]))
        .collect();
    pressure.marks(&mut image, &computed, BLUE);
    image.save(&folder.join("squeeze.png"))
}
