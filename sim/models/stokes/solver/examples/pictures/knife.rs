//! A knife through two wet colours: slices, and the relief from above.

use std::path::Path;

use maulstick_stokes::body::Rod;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use maulstick_stokes::surface;

use crate::image::Image;
use crate::slice::paints;
use crate::{CAPACITY, Drawn};

/// Pixels of a cell.
const ZOOM: usize = 8;

/// The surface from above, lit from the upper left.
fn relief(stokes: &mut Stokes) -> Image {
    let grid = stokes.volume.grid;
    let fill = stokes.volume.fill(&vec![1.0; grid.len()]);
    let heights: Vec<f32> = surface::heights(&grid, &fill)
        .into_iter()
        .map(Option::unwrap_or_default)
        .collect();
    let width = grid.cells[0];
    let normals = surface::normals(width, &heights);
    let rows = grid.cells[1];
    let mut image = Image::new(ZOOM * width, ZOOM * rows);
    for row in 0..rows {
        for column in 0..width {
            let [x, y, z] = normals[(rows - 1 - row) * width + column];
            let light = (0.5 * (y - x) + 0.7 * z).clamp(0.0, 1.0);
            let area = [ZOOM * column, ZOOM * row, ZOOM, ZOOM];
            image.fill(area.map(|side| side as f64), [255.0 * light; 3]);
        }
    }
    image
}

pub(crate) fn draw(folder: &Path) -> Drawn {
    let grid = Grid::walled([64, 32, 24]);
    let mut stokes = Stokes::new(&grid, CAPACITY, 2);
    for place in grid.block([8, 2, 0], [56, 30, 5]) {
        stokes.volume.paints[usize::from(grid.cell(place)[2] > 2)][place] = CAPACITY;
    }
    for place in grid.block([26, 2, 5], [36, 30, 10]) {
        stokes.volume.paints[0][place] = CAPACITY;
    }
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 5e-3,
        paint: Paint {
            yields: 12.0 / 1800.0,
            ..Paint::newtonian(20.0 / 1800.0)
        },
        pull: [0.0, 0.0, -9.81],
    };
    let mut x = 4.0;
    for number in 0..=100 {
        let way = 0.5;
        let speed = (f64::from(way) * conditions.cell_m / conditions.seconds) as f32;
        let knife = Rod {
            ends: [[x, 10.0, 4.5], [x, 22.0, 4.5]],
            radius: 1.5,
            velocity: [[speed, 0.0, 0.0]; 2],
        };
        let blade = Rod {
            ends: [[x, 10.0, 4.5], [x - 8.0, 10.0, 20.0]],
            ..knife
        };
        stokes.step(&[knife, blade], &conditions);
        if number % 25 == 0 {
            let slice = paints(&stokes, &[knife], 16, ZOOM);
            slice.save(&folder.join(format!("knife-{number:03}.png")))?;
            relief(&mut stokes).save(&folder.join(format!("relief-{number:03}.png")))?;
        }
        x += way;
    }
    Ok(())
}
