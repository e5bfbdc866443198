//! Stage 2: velocity of the paint under the brush (Baxter 2004, § 6.4.2).
//!
//! Paint sticks to brush and canvas, so it moves about half as far as the bristle above it, whose motion includes the
//! rotation of the brush. Paint that the bristles press aside flows down the gradient of the penetration: −c·∇p. Both
//! are computed at the faces between cells, so the squish from a cell into the next depends on these two alone.
//!
//! Thinned paint slips under the bristles and gives way sooner.

use maulstick_canvas::window::Area;
use maulstick_num::fork_join::each;
use maulstick_num::wide;

use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::footprint::shares_of;
use maulstick_model::interface::Step;

/// c of the squish: cells of flow in a step of one cell, per cell of penetration by cell.
pub const SQUISH: f32 = 3.0;
/// Bound of the squish, which diffuses paint by c·h in a step with h its height in cells: explicit steps are stable up
/// to about this, so c is smaller in thicker paint.
pub const STABLE: f32 = 0.04;
/// Share of its adhesion that thinner alone lacks.
pub const SLIP: f32 = 0.5;
/// Additional flow of thinner alone, in multiples of the penetration.
pub const EASE: f32 = 4.0;

/// c under a height of wet paint in cells, with a share `thinner`.
#[must_use]
#[inline]
pub fn squish(wet: f32, thinner: f32) -> f32 {
    (SQUISH * (1.0 + EASE * thinner)).min(STABLE / wet.max(1e-6))
}

/// Share of the brush's motion that paint with a share of thinner follows, where `follows` is that of paint.
#[must_use]
#[inline]
pub fn follows(follows: f32, thinner: f32) -> f32 {
    follows * (1.0 - SLIP * thinner)
}

/// Effect of the contacts on the paint: the share of a cell that goes through its faces in one step, on the cells
/// [around](Footprint::around) the footprint.
#[derive(Clone, Debug, Default)]
pub struct Faces {
    /// Share through the right face of each cell, cells; negative to the left.
    pub right: Vec<f32>,
    /// Share through its upper face, cells.
    pub above: Vec<f32>,
    /// Motion of the paint by the bristles, x and y.
    push: [Vec<f32>; 2],
    /// Penetration by cell.
    depth: Vec<f32>,
    /// c of the squish; 0 without contact.
    squish: Vec<f32>,
    /// Outflow of a cell along either axis, at least 1.
    leaves: [Vec<f32>; 2],
}

/// The contacts along one axis.
struct Along<'a> {
    push: &'a [f32],
    depth: &'a [f32],
    squish: &'a [f32],
    /// Columns of cells, and offset between neighbours.
    width: usize,
    next: usize,
}

wide! {
    /// Velocities through the faces across one axis; no cell loses more than it holds.
    fn through_faces(along: &Along<'_>, faces: &mut Vec<f32>, leaves: &mut Vec<f32>) {
        along.through(faces);
        limit(faces, leaves, along.next, along.width);
    }
}

impl Faces {
    /// Computes the velocities in each [part](maulstick_model::brush::traits::BrushTraits::parts) of the step; no cell
    /// loses more than its content along either axis.
    pub fn find(&mut self, footprint: &Footprint, step: &Step<'_>) {
        let [width, height] = footprint.around.size;
        let [push_x, push_y] = &mut self.push;
        for plane in [push_x, push_y, &mut self.depth, &mut self.squish] {
            plane.clear();
            plane.resize(width * height, 0.0);
        }
        for (contact, quanta) in footprint.contacts.iter().zip(&footprint.wet) {
            let place = contact.local as usize;
            let thinner = thinner_of(contact, *quanta, step);
            let wet = if contact.fraction > 0.0 {
                contact.depth / contact.fraction
            } else {
                0.0
            };
            // Paint in gaps below the bristles stays there.
            let follows = follows(step.traits.follows, thinner) * contact.cover * contact.fraction
                / step.traits.parts as f32;
            self.push[0][place] = follows * contact.moved[0];
            self.push[1][place] = follows * contact.moved[1];
            self.depth[place] = contact.depth * contact.cover;
            self.squish[place] = squish(wet, thinner);
        }
        let along = |push, next| Along {
            push,
            depth: &self.depth,
            squish: &self.squish,
            width,
            next,
        };
        let (across, up) = (along(&self.push[0], 1), along(&self.push[1], width));
        let [leaves_x, leaves_y] = &mut self.leaves;
        let mut axes = [
            (across, &mut self.right, leaves_x),
            (up, &mut self.above, leaves_y),
        ];
        let shares = axes.chunks_mut(2 / shares_of(width * height).min(2));
        each(&mut shares.collect::<Vec<_>>(), |axes| {
            for (along, faces, leaves) in &mut **axes {
                through_faces(along, faces, leaves);
            }
        });
    }
}

impl Faces {
    /// Faces of an area without flow.
    #[must_use]
    pub fn still(area: &Area) -> Self {
        let still = || vec![0.0; area.cells()];
        Self {
            right: still(),
            above: still(),
            ..Self::default()
        }
    }

    /// Limits the outflow of a cell to its content, along either axis.
    pub fn limit(&mut self, width: usize) {
        let [leaves_x, leaves_y] = &mut self.leaves;
        limit(&mut self.right, leaves_x, 1, width);
        limit(&mut self.above, leaves_y, width, width);
    }
}

impl Along<'_> {
    /// Velocities through the faces between cells that are `next` apart.
    #[inline(always)]
    fn through(&self, faces: &mut Vec<f32>) {
        let (cells, next) = (self.depth.len(), self.next);
        faces.clear();
        faces.resize(cells, 0.0);
        if cells < next {
            return;
        }
        let push = self.push.iter().zip(&self.push[next..]);
        let depth = self.depth.iter().zip(&self.depth[next..]);
        let squish = self.squish.iter().zip(&self.squish[next..]);
        let sides = push.zip(depth).zip(squish);
        for (face, (((b, b_next), (p, p_next)), (c, c_next))) in faces.iter_mut().zip(sides) {
            let (touched, next_touched) = (*c > 0.0, *c_next > 0.0);
            let both = touched & next_touched;
            let push = if both { 0.5 * (b + b_next) } else { b + b_next };
            let c = if both { c.min(*c_next) } else { c.max(*c_next) };
            let v = (push + c * (p - p_next)).clamp(-1.0, 1.0);
            // Paint goes only where something moves it.
            let moved = if v > 0.0 { touched } else { next_touched };
            *face = if moved { v } else { 0.0 };
        }
    }
}

/// Limits the outflow of a cell through both faces of an axis to its content.
#[inline(always)]
fn limit(faces: &mut [f32], leaves: &mut Vec<f32>, next: usize, width: usize) {
    // The last column has its neighbour in the row above: there is no face between them.
    if next == 1 {
        for row in faces.chunks_exact_mut(width.max(1)) {
            if let Some(last) = row.last_mut() {
                *last = 0.0;
            }
        }
    }
    leaves.clear();
    leaves.extend(faces.iter().map(|face| face.max(0.0)));
    let before = leaves.iter_mut().skip(next).zip(&*faces);
    before.for_each(|(leaves, face)| *leaves -= face.min(0.0));
    leaves
        .iter_mut()
        .for_each(|leaves| *leaves = leaves.max(1.0));
    let donors = leaves.iter().zip(&leaves[next.min(leaves.len())..]);
    for (face, (cell, beside)) in faces.iter_mut().zip(donors) {
        *face /= if *face > 0.0 { *cell } else { *beside };
    }
}

/// Share of thinner in the wet paint under a contact.
pub(super) fn thinner_of(contact: &Contact, wet: f32, step: &Step<'_>) -> f32 {
    match step.thinner.and_then(|slot| step.window.plane(slot)) {
        Some(plane) if wet > 0.0 => plane[contact.cell as usize] / wet,
        _ => 0.0,
    }
}
