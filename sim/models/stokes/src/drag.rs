//! Paint dragged along by a brush: its bristles are a porous body with a resistance to paint (Baxter 2004, § 5.4.2,
//! permeability; Brinkman 1949), and the solver computes the flow around them.
//!
//! Paint has no memory from one step to the next: its inertia is a thousandth of its viscous forces, so the result of a
//! step follows from the paint and the step alone. For the same reason only the path of a brush counts, not its
//! duration: steps are solved at one speed. Under a brush the shear rate is about 100/s, so the yield stress does not
//! matter there.

use maulstick_impasto::stages::levelling::Body;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::interface::Step;
use maulstick_stokes::domain::{Domain, LEAST_FILL};
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::rheology::Paint;

use crate::coarse::Coarse;
use crate::flow_backend::BrushFlow;
use crate::voxels::Voxels;

/// Assumed speed of a brush, m/s.
const SPEED_M_S: f64 = 0.1;
/// Number of steps of a brush for each step of the flow: less than a cell of its grid.
pub const STEPS: u32 = 2;
/// Density of oil paint, kg/m³.
pub(crate) const DENSITY_KG_M3: f64 = 1500.0;
/// Acceleration of gravity, m/s².
const GRAVITY_M_S2: f64 = 9.81;
/// Permeability of bristles, m².
const BRISTLES_M2: f64 = 6e-8;
/// Permeability of a blade, m²: practically closed.
const BLADE_M2: f64 = 2e-10;

/// Moves the paint of an area, dragged in a step by the brush's contacts, whose bristles have these heights.
pub fn drag(
    flow: &mut BrushFlow,
    voxels: &mut Voxels,
    (footprint, bottoms): (&Footprint, &[f32]),
    step: &Step<'_>,
    cell_m: f64,
) {
    let way = |moved: [f32; 2]| (moved[0] * moved[0] + moved[1] * moved[1]).sqrt();
    let ways = footprint.contacts.iter().map(|contact| way(contact.moved));
    let farthest = ways.fold(0.0, f32::max);
    if farthest <= 0.0 {
        return;
    }
    let seconds = f64::from(farthest) * f64::from(STEPS) * cell_m / SPEED_M_S;
    let fine = voxels.volume.grid;
    voxels.sink();
    let solids = voxels.solids();
    let open = solids.open(&fine);
    let totals = voxels.totals();
    let scene = |side: usize| {
        let mut coarse = Coarse::of(voxels, (&open, &totals), side);
        let conditions = Conditions {
            cell_m: cell_m * side as f64,
            seconds,
            paint: Paint::newtonian(Body::TUBE.viscosity_pa_s / DENSITY_KG_M3),
            pull: [0.0, 0.0, -GRAVITY_M_S2],
        };
        let contacts = footprint.contacts.iter().zip(bottoms);
        hold(voxels, &mut coarse, (contacts, &totals), step, &conditions);
        (coarse, conditions)
    };
    let velocity = flow.find(&fine, voxels.side(), scene);
    let fill = voxels.volume.fill(&open);
    let domain = Domain::for_transport(&fine, &fill, &solids, LEAST_FILL);
    voxels
        .volume
        .advect(&domain, &open, &velocity, seconds, cell_m);
    voxels.lift();
    voxels.pack();
    voxels.drop_loose();
}

/// Updates the contacts after a drag: each bristle keeps its height, and gets its depth in the moved paint, or its gap
/// above it.
pub fn follow(voxels: &Voxels, footprint: &mut Footprint, bottoms: &[f32], width: usize) {
    for (contact, bottom) in footprint.contacts.iter_mut().zip(bottoms) {
        let column = voxels.column_of(contact.cell as usize, width);
        let surface = voxels.surface(column);
        let wet = surface - voxels.floor_of(column);
        contact.depth = (surface - bottom).clamp(0.0, wet);
        contact.gap = (bottom - surface).max(0.0);
    }
}

/// Height of the bristle of each contact, cells of the grid.
#[must_use]
pub fn bottoms(voxels: &Voxels, footprint: &Footprint, width: usize) -> Vec<f32> {
    let height = |contact: &Contact| {
        let surface = voxels.surface(voxels.column_of(contact.cell as usize, width));
        surface - contact.depth + contact.gap
    };
    footprint.contacts.iter().map(height).collect()
}

/// Adds the bristles of the contacts to the paint, upward from their height.
fn hold<'a>(
    voxels: &Voxels,
    coarse: &mut Coarse,
    (contacts, totals): (impl Iterator<Item = (&'a Contact, &'a f32)>, &[u32]),
    step: &Step<'_>,
    conditions: &Conditions,
) {
    let grid = voxels.volume.grid;
    let permeability = if step.traits.floats {
        BLADE_M2
    } else {
        BRISTLES_M2
    };
    let whole = (conditions.cell_m * conditions.cell_m / permeability) as f32;
    let way_m = f64::from(STEPS) * conditions.cell_m / coarse.side as f64;
    let to_m_s = (way_m / conditions.seconds) as f32;
    for (contact, bottom) in contacts {
        let column = voxels.column_of(contact.cell as usize, step.window.width());
        let floor = voxels.floor_of(column);
        for voxel in voxels.open_column(column) {
            let cell = grid.cell(voxel);
            if totals[voxel] == 0 {
                continue;
            }
            let height = floor.max(cell[2] as f32);
            let fill = totals[voxel] as f32 / voxels.volume.capacity as f32;
            let held = (height + fill - bottom.max(height)).max(0.0);
            let velocity = contact.moved.map(|moved| moved * to_m_s);
            coarse.resist(cell, (held, whole * contact.cover), velocity);
        }
    }
    coarse.hold();
}
