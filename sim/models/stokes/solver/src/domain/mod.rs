//! Domain of the equations: the cells and faces of a window that take part, with their volume fractions.
//!
//! A cell is filled to a fraction; the average over cells beside a face or around an edge is the fraction of paint in
//! the face's or edge's volume (Batty and Bridson 2008; Larionov, Batty and Bridson 2017). An edge with a velocity of
//! air transmits no shear: that is the free surface's natural condition.
//!
//! Solids are given by their distance, so that a wall may be anywhere between two faces: a velocity at distance θ from
//! a wall has (u − u_wall)/θ as its gradient, over a volume of θ. For a wall in the middle that is a reflected ghost.

mod edges;
mod faces;

use faces::{find_cells, find_faces, find_sides};
use maulstick_num::wide;

use crate::grid::Grid;
use crate::runs::share;
use crate::stencil::Span;

/// Fill from which a cell resists pressure.
pub const LEAST_FILL: f32 = 0.1;
/// Smallest mass of a face.
const LEAST_MASS: f32 = 0.05;
/// Smallest distance of a velocity from a wall, in cells.
const LEAST_DISTANCE: f32 = 0.1;
/// Solids in a window.
const FAR_CELLS: f32 = 64.0;
/// Distance at which a face belongs to a solid.
const TOUCHES: f32 = 1e-4;

/// Solids in a window.
#[derive(Clone, Debug)]
pub struct Solids {
    /// Distance of each lower corner from the nearest solid, cells; negative inside. The grid's sides are left out.
    pub distance: Vec<f32>,
    /// Velocity of the solid at each face, by axis, m/s.
    pub velocity: [Vec<f32>; 3],
    /// Resistance of bristles at each face, by axis: h²/K with K their permeability. They move with `velocity`, and
    /// paint flows through them (Brinkman 1949). `None` without bristles.
    pub resistance: Option<[Vec<f32>; 3]>,
}

impl Solids {
    /// Only the grid's own sides, at rest.
    #[must_use]
    pub fn walls(grid: &Grid) -> Self {
        Self {
            distance: vec![FAR_CELLS; grid.len()],
            velocity: std::array::from_fn(|_| grid.field()),
            resistance: None,
        }
    }

    /// Copies others into the same buffers.
    pub fn copy_from(&mut self, others: &Self) {
        self.distance.clone_from(&others.distance);
        for (into, from) in self.velocity.iter_mut().zip(&others.velocity) {
            into.clone_from(from);
        }
        self.resistance.clone_from(&others.resistance);
    }

    /// Adds a solid by its distance from each corner, as a function of the corner's place in cells.
    pub fn add(&mut self, grid: &Grid, distance: impl Fn([f32; 3]) -> f32) {
        for (place, near) in self.distance.iter_mut().enumerate() {
            *near = near.min(distance(grid.cell(place).map(|at| at as f32)));
        }
    }
}

wide! {
    /// Open share of each cell by its corners.
    fn find_open(into: &mut [f32], corners: &[f32], by: [usize; 3]) {
        let [x, y, z] = by;
        let n = into.len();
        let row = |by: usize| &corners[by..by + n];
        let (a, b, c, d) = (row(0), row(x), row(y), row(x + y));
        let (e, f, g, h) = (row(z), row(x + z), row(y + z), row(x + y + z));
        for i in 0..n {
            into[i] = open([a[i], b[i], c[i], d[i], e[i], f[i], g[i], h[i]]);
        }
    }
}

impl Solids {
    /// Open share of each cell.
    #[must_use]
    pub fn open(&self, grid: &Grid) -> Vec<f32> {
        let mut shares = grid.field();
        self.open_into(grid, &mut shares);
        shares
    }

    /// Open share of each cell, written into a field.
    pub fn open_into(&self, grid: &Grid, shares: &mut [f32]) {
        let by = [0, 1, 2].map(|axis| grid.stride(axis));
        let last = grid.len() - by.iter().sum::<usize>();
        if (0..3).any(|axis| grid.is_periodic(axis)) {
            let mut corners = self.distance.clone();
            grid.wrap(&mut corners);
            find_open(&mut shares[..last], &corners, by);
        } else {
            find_open(&mut shares[..last], &self.distance, by);
        }
        grid.clear_beyond(shares);
        grid.wrap(shares);
    }
}

/// Role of a face in the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A face of air without paint beside it.
    Air,
    /// A face that moves with a solid.
    Solid,
    /// A face whose velocity is an unknown.
    Paint,
}

/// Cells, faces and edges of a window in the equations; lengths are in cells.
#[derive(Clone, Debug)]
pub struct Domain {
    /// The grid.
    pub grid: Grid,
    /// 1 for a cell with a pressure, otherwise 0.
    pub wet: Vec<f32>,
    /// 1 for a face that moves with a solid, otherwise 0.
    pub solid: [Vec<f32>; 3],
    /// 1 for a face whose velocity is an unknown, otherwise 0.
    pub free: [Vec<f32>; 3],
    /// Open part of a face whose velocity is an unknown, otherwise 0.
    pub area: [Vec<f32>; 3],
    /// Share of paint in a face's volume; 0 where its velocity is not an unknown.
    pub mass: [Vec<f32>; 3],
    /// Share of paint in a cell; 0 where it has no pressure.
    pub volume: Vec<f32>,
    /// Share of sheared paint in an edge's volume; edge a runs along axis a.
    pub edge: [Vec<f32>; 3],
    /// For each edge, the inverses of the distances between the velocities of the two [other](crate::grid::others)
    /// axes.
    pub slope: [[Vec<f32>; 2]; 3],
    /// Distance of each face from the nearest solid, by axis.
    near: [Vec<f32>; 3],
    /// Fill of each cell and distance of each corner, wrapped, of a grid with periodic sides.
    wrapped: (Vec<f32>, Vec<f32>),
}

impl Domain {
    /// The domain of a window; `fill` is the share of each cell's open volume, and a cell below the least fill is air.
    #[must_use]
    pub fn new(grid: &Grid, fill: &[f32], solids: &Solids, least: f32) -> Self {
        let mut domain = Self::empty(grid);
        domain.renew(grid, fill, solids, least);
        domain
    }

    /// The cells and faces of the window, without edges: enough for transport.
    #[must_use]
    pub fn for_transport(grid: &Grid, fill: &[f32], solids: &Solids, least: f32) -> Self {
        let mut domain = Self::empty(grid);
        domain.find(grid, (fill, least), solids, |_, _| ());
        domain
    }

    fn empty(grid: &Grid) -> Self {
        let three = || std::array::from_fn(|_| Vec::new());
        Self {
            grid: *grid,
            wet: Vec::new(),
            solid: three(),
            free: three(),
            area: three(),
            mass: three(),
            volume: Vec::new(),
            edge: three(),
            slope: std::array::from_fn(|_| std::array::from_fn(|_| Vec::new())),
            near: three(),
            wrapped: (Vec::new(), Vec::new()),
        }
    }

    /// Recomputes the domain in the same buffers. The grid may be the lower layers of that of the fields.
    pub fn renew(&mut self, grid: &Grid, fill: &[f32], solids: &Solids, least: f32) {
        for slope in self.slope.as_flattened_mut() {
            slope.resize(grid.len(), 0.0);
        }
        self.find(grid, (fill, least), solids, Self::find_edges);
    }

    /// Computes cells and faces, then, with the wrapped fill, the other requested fields.
    fn find(
        &mut self,
        grid: &Grid,
        (fill, least): (&[f32], f32),
        solids: &Solids,
        edges: impl FnOnce(&mut Self, &[f32]),
    ) {
        self.grid = *grid;
        let len = grid.len();
        let axes = [
            &mut self.solid,
            &mut self.free,
            &mut self.area,
            &mut self.mass,
        ];
        let shared = [&mut self.edge, &mut self.near];
        let fields = axes.into_iter().chain(shared).flatten();
        for field in fields.chain([&mut self.wet, &mut self.volume]) {
            field.resize(len, 0.0);
        }
        let wrapped = std::mem::take(&mut self.wrapped);
        let mut wrapped = [(fill, wrapped.0), (&solids.distance, wrapped.1)];
        if (0..3).any(|axis| grid.is_periodic(axis)) {
            for (from, into) in &mut wrapped {
                into.clear();
                into.extend_from_slice(&from[..len]);
                grid.wrap(into);
            }
        }
        let [fill, corners] = wrapped
            .each_ref()
            .map(|(from, copy)| if copy.is_empty() { *from } else { copy });
        by_axis(
            [&mut self.near, &mut self.solid, &mut self.area],
            |axis, fields| {
                let [near, solid, area] = fields;
                find_faces(grid, axis, corners, [&mut *near, &mut *solid, &mut *area]);
                find_sides(grid, axis, solid, area);
                for field in [near, solid, area] {
                    grid.wrap(field);
                }
            },
        );
        find_cells(self, (fill, least), corners);
        let cells = [self.wet.as_slice(), self.volume.as_slice()];
        by_axis(
            [
                &mut self.free,
                &mut self.mass,
                &mut self.area,
                &mut self.solid,
            ],
            |axis, [free, mass, area, solid]| {
                find_free(grid, axis, [free, mass, area], solid, cells);
            },
        );
        edges(self, fill);
        let [(_, fill), (_, corners)] = wrapped;
        self.wrapped = (fill, corners);
    }

    /// Role of a face.
    #[must_use]
    pub fn part(&self, axis: usize, face: usize) -> Part {
        if self.free[axis][face] > 0.0 {
            Part::Paint
        } else if self.solid[axis][face] > 0.0 {
            Part::Solid
        } else {
            Part::Air
        }
    }
}

/// Calls for each axis with its parts of fields, on all cores.
fn by_axis<const N: usize>(
    mut fields: [&mut [Vec<f32>; 3]; N],
    work: impl Fn(usize, [&mut Vec<f32>; N]) + Sync,
) {
    let mut axes: [(usize, [Vec<f32>; N]); 3] = std::array::from_fn(|axis| {
        let own = fields
            .each_mut()
            .map(|field| std::mem::take(&mut field[axis]));
        (axis, own)
    });
    let places = axes[0].1.iter().map(Vec::len).max().unwrap_or_default();
    share(places, &mut axes, |(axis, own)| work(*axis, own.each_mut()));
    for (axis, own) in axes {
        for (field, own) in fields.iter_mut().zip(own) {
            field[axis] = own;
        }
    }
}

/// Faces whose velocities are unknowns.
fn find_free(
    grid: &Grid,
    axis: usize,
    fields: [&mut Vec<f32>; 3],
    solid: &[f32],
    cells: [&[f32]; 2],
) {
    let by = grid.stride(axis);
    let span = Span::of(grid, by..grid.len());
    let mut slices = fields.map(Vec::as_mut_slice);
    for field in &mut slices {
        field[..by].fill(0.0);
    }
    free_flat(
        slices.each_mut().map(|field| &mut **field),
        solid,
        cells,
        by,
        span,
    );
    for field in slices {
        grid.wrap(field);
    }
}

wide! {
    fn free_flat(fields: [&mut [f32]; 3], solid: &[f32], cells: [&[f32]; 2], by: usize, span: Span) {
        let (wet_low, wet) = (span.before(cells[0], by), span.here(cells[0]));
        let (low, high) = (span.before(cells[1], by), span.here(cells[1]));
        let solid = span.here(solid);
        let [free, mass, area] = fields;
        let (free, mass, area) = (span.here_mut(free), span.here_mut(mass), span.here_mut(area));
        for i in 0..free.len() {
            let is_free = (wet_low[i] + wet[i] > 0.0) & (solid[i] == 0.0);
            let share = 0.5 * (low[i] + high[i]);
            let share = if share > LEAST_MASS { share } else { LEAST_MASS };
            free[i] = if is_free { 1.0 } else { 0.0 };
            mass[i] = if is_free { share } else { 0.0 };
            area[i] = if is_free { area[i] } else { 0.0 };
        }
    }
}

/// Open share of a face or a cell by the distances of its corners; exact for a plane along the grid.
#[inline(always)]
fn open<const N: usize>(corners: [f32; N]) -> f32 {
    let (mut all, mut positive) = (0.0, 0.0);
    for distance in corners {
        all += distance.abs();
        positive += if distance > 0.0 { distance } else { 0.0 };
    }
    let share = if all > 0.0 { positive / all } else { 0.0 };
    // No solid is near.
    if corners[0] > 2.0 { 1.0 } else { share }
}
