//! The dissertation's scheme, in the order of Baxter 2004, § 5.3.7: surface velocities to zero, implicit diffusion of each
//! component (eq. 5.4), pressure (eq. 5.5), and u = u* − Δt∇p (eq. 5.6, whose sign is a misprint).
//!
//! A cell is paint or it is not, walls are between cells, and viscosity is the same everywhere.

use crate::domain::{Domain, Part};
use crate::grid::others;
use crate::multigrid::Multigrid;
use crate::stencil::Stencil;

/// Iterations of conjugate gradients for diffusion and for pressure.
const ITERATIONS: [usize; 2] = [8, 12];

/// Faces by the cells on both sides.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Face {
    Air,
    Solid,
    Surface,
    Inside,
}

fn face(domain: &Domain, axis: usize, place: usize) -> Face {
    let beside = [place.saturating_sub(domain.grid.stride(axis)), place];
    match domain.part(axis, place) {
        Part::Solid => Face::Solid,
        Part::Air => Face::Air,
        Part::Paint if beside.iter().all(|cell| domain.wet[*cell] > 0.0) => Face::Inside,
        Part::Paint => Face::Surface,
    }
}

/// One step of τ = νΔt/h², with the velocity added by the body force: velocities with those of solids in place, and the
/// pressure times Δt/h.
pub(crate) fn step(
    domain: &Domain,
    (tau, pull): (f64, [f32; 3]),
    velocity: &mut [Vec<f32>; 3],
    solids: &[Vec<f32>; 3],
    pressure: &mut [f32],
) {
    for axis in 0..3 {
        diffuse(domain, axis, (tau as f32, pull[axis]), &mut velocity[axis]);
    }
    project(domain, velocity, solids, pressure);
}

/// Diffuses a component; surface faces keep 0.
fn diffuse(domain: &Domain, axis: usize, (tau, pull): (f32, f32), u: &mut [f32]) {
    let grid = domain.grid;
    let mut stencil = Stencil::new(&grid);
    let mut faces: Vec<Face> = (0..grid.len())
        .map(|place| face(domain, axis, place))
        .collect();
    grid.wrap(&mut faces);
    for (u, face) in u.iter_mut().zip(&faces) {
        if *face == Face::Surface {
            *u = 0.0;
        }
    }
    grid.wrap(u);
    let scale = 1.0 / (1.0 + 6.0 * tau);
    let mut b = grid.field();
    for place in grid.range() {
        let is_inside = faces[place] == Face::Inside;
        stencil.active[place] = f32::from(is_inside);
        stencil.known[place] = f32::from(faces[place] != Face::Air);
        if is_inside {
            stencil.mass[place] = scale;
            b[place] += scale * (u[place] + pull);
        }
        for along in 0..3 {
            let before = place - grid.stride(along);
            let two = [faces[before], faces[place]];
            if !two.contains(&Face::Inside) || two.contains(&Face::Air) {
                continue;
            }
            // A wall beside a face is half a cell away: a reflected ghost.
            let is_beside = others(axis).contains(&along) && two.contains(&Face::Solid);
            let link = scale * tau * if is_beside { 2.0 } else { 1.0 };
            stencil.links[along][place] = link;
            for (own, other) in [(place, before), (before, place)] {
                if faces[own] == Face::Inside && faces[other] != Face::Inside {
                    b[own] += link * u[other];
                }
            }
        }
    }
    grid.clear(&mut b);
    stencil.finish(&grid);
    let mut x = grid.field();
    for (place, x) in x.iter_mut().enumerate() {
        if faces[place] == Face::Inside {
            *x = u[place];
        }
    }
    Multigrid::new(&grid, stencil, Some(axis)).solve(&b, &mut x, ITERATIONS[0]);
    for (place, u) in u.iter_mut().enumerate() {
        if faces[place] == Face::Inside {
            *u = x[place];
        }
    }
    grid.wrap(u);
}

/// Removes the divergence of the velocity; surface faces follow by continuity.
fn project(
    domain: &Domain,
    velocity: &mut [Vec<f32>; 3],
    solids: &[Vec<f32>; 3],
    pressure: &mut [f32],
) {
    let grid = domain.grid;
    let mut stencil = Stencil::new(&grid);
    stencil.active.clone_from(&domain.wet);
    stencil.known.clone_from(&domain.wet);
    let mut b = grid.field();
    for axis in 0..3 {
        let by = grid.stride(axis);
        for place in grid.range() {
            let part = domain.part(axis, place);
            let u = match part {
                Part::Solid => solids[axis][place],
                Part::Paint | Part::Air => velocity[axis][place],
            };
            b[place] += u;
            b[place - by] -= u;
            if part == Part::Paint {
                stencil.links[axis][place] = 1.0;
                stencil.known[place] = 1.0;
                stencil.known[place - by] = 1.0;
            }
        }
    }
    for (b, wet) in b.iter_mut().zip(&domain.wet) {
        *b *= wet;
    }
    grid.clear(&mut b);
    stencil.finish(&grid);
    Multigrid::new(&grid, stencil, None).solve(&b, pressure, ITERATIONS[1]);
    for (axis, u) in velocity.iter_mut().enumerate() {
        let by = grid.stride(axis);
        for place in grid.range() {
            if domain.part(axis, place) == Part::Paint {
                u[place] -= pressure[place] - pressure[place - by];
            }
        }
        grid.wrap(u);
    }
}
