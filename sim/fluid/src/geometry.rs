//! Solid share of each node, and of each link between two nodes.

use crate::grid::Grid;
use crate::polygon::{Placed, Shape};
use crate::stress::Medium;

/// Place and motion of the probe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProbeState {
    /// Place, m.
    pub place_m: [f64; 2],
    /// Angle, rad.
    pub angle_rad: f64,
    /// Velocity, m/s.
    pub velocity_m_s: [f64; 2],
    /// Angular velocity, rad/s.
    pub spin_rad_s: f64,
}

impl ProbeState {
    /// Velocity of the probe's material at a place, m/s.
    #[must_use]
    pub fn velocity_at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [rx, ry] = [x - self.place_m[0], y - self.place_m[1]];
        let [u, v] = self.velocity_m_s;
        [u - self.spin_rad_s * ry, v + self.spin_rad_s * rx]
    }
}

/// Representation of the probe's outline on the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Each cell is all fluid or all probe (Harlow and Welch 1965; Baxter 2004, § 8.8.4).
    Staircase,
    /// Each node and each link between two nodes is solid by the share of its box that the probe covers.
    Covered,
}

/// Walls of the fluid's vessel.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Vessel {
    /// The grid's own rectangle.
    #[default]
    Box,
    /// A round hole of this radius in its middle, m.
    Round(f64),
}

/// A link whose box is solid all but this share conducts no better, or the system would be stiff without bound.
const LEAST_OPEN: f64 = 0.01;
/// A node with less open than this is within the solid.
const CLOSED: f64 = 1e-9;

/// The solids on a grid.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    /// Solid share of each face's box, by axis.
    pub(crate) solid: [Vec<f64>; 2],
    /// The probe's part of it.
    pub(crate) probe: [Vec<f64>; 2],
    /// Velocity of the solid at each face, by axis, m/s: around the probe, its own; elsewhere 0.
    pub(crate) rigid: [Vec<f64>; 2],
    /// Coupling of each face with the next one along x and y, by axis: 1 in the fluid, the inverse of the open share
    /// where a wall cuts the link, because viscous stress acts on the open part alone.
    pub(crate) links: [[Vec<f64>; 2]; 2],
    /// Content of each cell, by its middle.
    pub(crate) media: Vec<Medium>,
}

/// Solid shares of a box: the probe's, and that of all.
#[derive(Clone, Copy)]
struct Share {
    probe: f64,
    all: f64,
}

struct Solids<'a> {
    probe: &'a Placed,
    hole: Option<Placed>,
    bounds: [[f64; 2]; 2],
    cell_m: f64,
}

impl Solids<'_> {
    fn is_near(&self, place: [f64; 2]) -> bool {
        let [low, high] = self.bounds;
        (0..2).all(|i| (low[i]..=high[i]).contains(&place[i]))
    }

    fn share(&self, place: [f64; 2]) -> Share {
        let probe = if self.is_near(place) {
            self.probe.share(place, self.cell_m)
        } else {
            0.0
        };
        let hole = self
            .hole
            .as_ref()
            .map(|hole| hole.share(place, self.cell_m));
        Share {
            probe,
            all: (probe + 1.0 - hole.unwrap_or(1.0)).min(1.0),
        }
    }

    fn medium(&self, place: [f64; 2]) -> Medium {
        if self.is_near(place) && self.probe.contains(place) {
            Medium::Probe
        } else if self.hole.as_ref().is_some_and(|hole| !hole.contains(place)) {
            Medium::Other
        } else {
            Medium::Fluid
        }
    }
}

impl Geometry {
    pub(crate) fn new(
        grid: &Grid,
        vessel: &Vessel,
        shape: &Shape,
        state: &ProbeState,
        boundary: Boundary,
    ) -> Self {
        let placed = shape.placed(state.place_m, state.angle_rad);
        let [low, high] = placed.bounds();
        let hole = match vessel {
            Vessel::Box => None,
            Vessel::Round(radius_m) => {
                let middle = grid.cells.map(|count| 0.5 * count as f64 * grid.cell_m);
                Some(Shape::disc(*radius_m).placed(middle, 0.0))
            }
        };
        let reach = 2.0 * grid.cell_m;
        let solids = Solids {
            probe: &placed,
            hole,
            bounds: [low.map(|at| at - reach), high.map(|at| at + reach)],
            cell_m: grid.cell_m,
        };
        let media = (0..grid.count()).map(|at| {
            let [i, j] = [at % grid.cells[0], at / grid.cells[0]];
            solids.medium([
                (i as f64 + 0.5) * grid.cell_m,
                (j as f64 + 0.5) * grid.cell_m,
            ])
        });
        let none = || [0, 1].map(|axis| vec![0.0; grid.faces(axis).iter().product()]);
        let mut geometry = Self {
            solid: none(),
            probe: none(),
            rigid: none(),
            links: [0, 1].map(|axis| {
                let ones = vec![1.0; grid.faces(axis).iter().product()];
                [ones.clone(), ones]
            }),
            media: media.collect(),
        };
        for axis in 0..2 {
            let [width, height] = grid.faces(axis);
            for at in 0..width * height {
                let index = [at % width, at / width];
                let place = grid.face_m(axis, index);
                if solids.is_near(place) {
                    geometry.rigid[axis][at] = state.velocity_at(place)[axis];
                }
                match boundary {
                    Boundary::Staircase => geometry.step(grid, axis, index),
                    Boundary::Covered => geometry.cover(&solids, axis, at, place),
                }
                if index[axis] == 0 || index[axis] == grid.cells[axis] {
                    (geometry.solid[axis][at], geometry.rigid[axis][at]) = (1.0, 0.0);
                }
            }
        }
        geometry
    }

    /// A face and the links from it, by the shares of their boxes.
    fn cover(&mut self, solids: &Solids, axis: usize, at: usize, place: [f64; 2]) {
        let own = solids.share(place);
        (self.solid[axis][at], self.probe[axis][at]) = (own.all, own.probe);
        for along in 0..2 {
            let mut middle = place;
            middle[along] += 0.5 * solids.cell_m;
            let open = 1.0 - solids.share(middle).all;
            self.links[axis][along][at] = 1.0 / open.max(LEAST_OPEN);
        }
    }

    /// A face of a solid cell is solid; from one between two of them the wall is half a cell away.
    fn step(&mut self, grid: &Grid, axis: usize, index: [usize; 2]) {
        let [width, height] = grid.faces(axis);
        let at = index[1] * width + index[0];
        let beside = |[i, j]: [usize; 2]| {
            let cell = |k: Option<usize>| {
                let mut cell = [i, j];
                cell[axis] = k?;
                let inside = cell[0] < grid.cells[0] && cell[1] < grid.cells[1];
                inside.then(|| self.media[cell[1] * grid.cells[0] + cell[0]])
            };
            let k = [i, j][axis];
            [cell(k.checked_sub(1)), cell(Some(k))]
        };
        let counts = |index: [usize; 2], is: fn(Medium) -> bool| {
            beside(index)
                .into_iter()
                .flatten()
                .filter(|it| is(*it))
                .count()
        };
        let solid = |it: Medium| it != Medium::Fluid;
        let own = counts(index, solid);
        let mut links = [1.0; 2];
        for (along, link) in links.iter_mut().enumerate() {
            let mut next = index;
            next[along] += 1;
            if next[0] < width && next[1] < height {
                let other = counts(next, solid);
                if (own == 2) != (other == 2) && along != axis {
                    *link = 2.0;
                }
            }
        }
        let of_probe = counts(index, |it| it == Medium::Probe) > 0;
        self.solid[axis][at] = if own > 0 { 1.0 } else { 0.0 };
        self.probe[axis][at] = if of_probe { 1.0 } else { 0.0 };
        for (along, link) in links.into_iter().enumerate() {
            self.links[axis][along][at] = link;
        }
    }

    /// True where a face is within a solid.
    pub(crate) fn is_fixed(&self, axis: usize, at: usize) -> bool {
        self.solid[axis][at] >= 1.0 - CLOSED
    }
}
