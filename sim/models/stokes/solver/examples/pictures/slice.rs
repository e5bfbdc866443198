//! Slices across y of a flow in one plane, and of paints.

use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::flow::Flow;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::step::Stokes;

use crate::CAPACITY;
use crate::image::{Colour, Image};

const COLOURS: [Colour; 2] = [[200.0, 60.0, 40.0], [40.0, 80.0, 190.0]];
const BODY: f32 = 120.0;
const AIR: f32 = 250.0;

/// Values at the corners of the cells of a plane, x fastest; linear between them.
pub(crate) struct Corners {
    cells: [usize; 2],
    pub values: Vec<f64>,
}

impl Corners {
    pub(crate) fn new(cells: [usize; 2], value: impl Fn([usize; 2]) -> f64) -> Self {
        let all = (0..=cells[1]).flat_map(|z| (0..=cells[0]).map(move |x| [x, z]));
        Self {
            cells,
            values: all.map(value).collect(),
        }
    }

    /// Value at a place in cells; none outside.
    pub(crate) fn at(&self, place: [f64; 2]) -> Option<f64> {
        let [across, up] = [0, 1].map(|axis| {
            let cells = self.cells[axis];
            (0.0..=cells as f64)
                .contains(&place[axis])
                .then(|| (place[axis] as usize).min(cells - 1))
        });
        let (x, z) = (across?, up?);
        let [right, above] = [place[0] - x as f64, place[1] - z as f64];
        let value = |x: usize, z: usize| self.values[x + z * (self.cells[0] + 1)];
        let low = value(x, z) + right * (value(x + 1, z) - value(x, z));
        let high = value(x, z + 1) + right * (value(x + 1, z + 1) - value(x, z + 1));
        Some(low + above * (high - low))
    }
}

/// Stream function ψ, u = ∂ψ/∂z, of the plane y = 0: the flow through the faces below each corner.
pub(crate) fn stream(flow: &Flow) -> Corners {
    let [width, _, depth] = flow.grid.cells;
    let mut below = vec![0.0; width + 1];
    let mut values = below.clone();
    for z in 0..depth {
        for (x, below) in below.iter_mut().enumerate() {
            *below += f64::from(flow.velocity[0][flow.grid.at([x as isize, 0, z as isize])]);
        }
        values.extend(&below);
    }
    Corners {
        cells: [width, depth],
        values,
    }
}

/// Speed in the plane y = 0 between a still floor and a moving lid, to both of which paint sticks.
pub(crate) fn speed(flow: &Flow, lid: impl Fn(usize) -> [f64; 2]) -> Corners {
    let grid = &flow.grid;
    let [width, _, depth] = grid.cells;
    let at = |axis: usize, x: usize, z: usize| {
        f64::from(flow.velocity[axis][grid.at([x as isize, 0, z as isize])])
    };
    Corners::new([width, depth], |[x, z]| {
        let [u, w] = if z == 0 {
            [0.0; 2]
        } else if z == depth {
            lid(x)
        } else {
            let u = 0.5 * (at(0, x, z - 1) + at(0, x, z));
            let [before, after] = [x.max(1) - 1, x.min(width - 1)];
            [u, 0.5 * (at(2, before, z) + at(2, after, z))]
        };
        (u * u + w * w).sqrt()
    })
}

/// Share of each cell of the plane y filled by bodies and paints.
pub(crate) fn paints(stokes: &Stokes, brush: &[Rod], y: isize, zoom: usize) -> Image {
    let grid: Grid = stokes.volume.grid;
    let [width, _, depth] = grid.cells;
    let mut solids = stokes.base.clone();
    voxelise(&grid, &mut solids, brush);
    let mut image = Image::new(zoom * width, zoom * depth);
    for z in 0..depth {
        for x in 0..width {
            let place = grid.at([x as isize, y, z as isize]);
            let share = |paint: &Vec<u32>| paint[place] as f32 / CAPACITY as f32;
            let shares: Vec<f32> = stokes.volume.paints.iter().map(share).collect();
            let left = (1.0 - shares.iter().sum::<f32>()).max(0.0);
            let corners = [0, 1, grid.stride(2), 1 + grid.stride(2)];
            let distance: f32 = corners.map(|by| solids.distance[place + by]).iter().sum();
            let air = if distance < 0.0 { BODY } else { AIR };
            let colour = [0, 1, 2].map(|channel| {
                let paints = shares.iter().zip(COLOURS);
                let paint: f32 = paints.map(|(share, of)| share * of[channel]).sum();
                (paint + left * air).min(255.0)
            });
            let area = [zoom * x, zoom * (depth - 1 - z), zoom, zoom];
            image.fill(area.map(|side| side as f64), colour);
        }
    }
    image
}
