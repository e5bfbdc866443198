//! Stage 2: where the paint under the brush goes (Baxter 2004, § 6.4.2).
//!
//! Paint sticks to brush and canvas, so on the whole it goes half as far as the bristle above it,
//! whose motion holds the turning of the brush. What the bristles press aside flows down the
//! gradient of the penetration: −c·∇p.

use super::footprint::Footprint;

/// Share of the brush's motion that paint follows.
pub const FOLLOWS: f32 = 0.5;
/// c of the squish: cells of flow in a step of one cell, per cell of penetration by cell.
pub const SQUISH: f32 = 1.5;
/// The squish diffuses paint by c·h in a step, h its height in cells; explicit steps are stable up to
/// about this, so c is smaller in thicker paint.
pub const STABLE: f32 = 0.2;

/// c under a height of wet paint in cells.
#[must_use]
pub fn squish(wet: f32) -> f32 {
    SQUISH.min(STABLE / wet.max(1e-6))
}

/// Sets the velocity of each contact; no component exceeds one cell a step.
pub fn velocity(footprint: &mut Footprint) {
    let [width, height] = footprint.size;
    let depth = &mut footprint.depth;
    depth.clear();
    depth.resize(width * height, 0.0);
    for contact in &footprint.contacts {
        depth[contact.local as usize] = contact.depth * contact.cover;
    }
    for contact in &mut footprint.contacts {
        let local = contact.local as usize;
        let (x, y) = (local % width, local / width);
        let at = |inside: bool, place: usize| if inside { depth[place] } else { 0.0 };
        let slope = [
            at(x + 1 < width, local + 1) - at(x > 0, local.wrapping_sub(1)),
            at(y + 1 < height, local + width) - at(y > 0, local.wrapping_sub(width)),
        ];
        let wet = if contact.fraction > 0.0 {
            contact.depth / contact.fraction
        } else {
            0.0
        };
        let squish = squish(wet);
        contact.velocity = [0, 1].map(|i| {
            let follows = FOLLOWS * contact.cover * contact.moved[i];
            (follows - 0.5 * squish * slope[i]).clamp(-1.0, 1.0)
        });
    }
}
