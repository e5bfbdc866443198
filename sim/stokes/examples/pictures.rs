//! Pictures of paint under a knife, in slices: `cargo run --release -p maulstick-stokes --example pictures -- FOLDER`.

use std::error::Error;
use std::path::Path;

use maulstick_stokes::body::Rod;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use maulstick_stokes::surface;

/// Pixels of a cell.
const ZOOM: usize = 8;
const CAPACITY: u32 = 167_772;
const COLOURS: [[f32; 3]; 2] = [[200.0, 60.0, 40.0], [40.0, 80.0, 190.0]];

/// A slice across y: paints by their share, a brush in grey.
fn slice(stokes: &Stokes, brush: &[Rod], y: isize) -> (usize, Vec<u8>) {
    let grid = stokes.volume.grid;
    let [width, _, depth] = grid.cells;
    let mut solids = stokes.base.clone();
    maulstick_stokes::body::voxelise(&grid, &mut solids, brush);
    let mut pixels = vec![255; 3 * ZOOM * ZOOM * width * depth];
    for row in 0..ZOOM * depth {
        for column in 0..ZOOM * width {
            let place = grid.at([
                (column / ZOOM) as isize,
                y,
                (depth - 1 - row / ZOOM) as isize,
            ]);
            let shares = [0, 1].map(|i| stokes.volume.paints[i][place] as f32 / CAPACITY as f32);
            let left = (1.0 - shares[0] - shares[1]).max(0.0);
            for channel in 0..3 {
                let paint = shares[0] * COLOURS[0][channel] + shares[1] * COLOURS[1][channel];
                let air = if solids.distance[place] < 0.0 {
                    120.0
                } else {
                    250.0
                };
                let pixel = 3 * (row * ZOOM * width + column) + channel;
                pixels[pixel] = (paint + left * air).min(255.0) as u8;
            }
        }
    }
    (ZOOM * width, pixels)
}

/// The surface from above, lit from the upper left.
fn relief(stokes: &mut Stokes) -> (usize, Vec<u8>) {
    let grid = stokes.volume.grid;
    let fill = stokes.volume.fill(&vec![1.0; grid.len()]);
    let heights: Vec<f32> = surface::heights(&grid, &fill)
        .into_iter()
        .map(Option::unwrap_or_default)
        .collect();
    let width = grid.cells[0];
    let normals = surface::normals(width, &heights);
    let rows = grid.cells[1];
    let mut pixels = Vec::new();
    for row in 0..ZOOM * rows {
        for column in 0..ZOOM * width {
            let [x, y, z] = normals[(rows - 1 - row / ZOOM) * width + column / ZOOM];
            let light = (0.5 * (y - x) + 0.7 * z).clamp(0.0, 1.0);
            pixels.extend([(255.0 * light) as u8; 3]);
        }
    }
    (ZOOM * width, pixels)
}

fn save(path: &Path, (width, pixels): (usize, Vec<u8>)) -> Result<(), Box<dyn Error>> {
    let height = pixels.len() / 3 / width;
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("which folder?")?;
    let folder = Path::new(&folder);
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
            save(
                &folder.join(format!("knife-{number:03}.png")),
                slice(&stokes, &[knife], 16),
            )?;
            save(
                &folder.join(format!("relief-{number:03}.png")),
                relief(&mut stokes),
            )?;
        }
        x += way;
    }
    Ok(())
}
