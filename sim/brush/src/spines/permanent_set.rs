//! The permanent set of a spine: the bend that the inner friction of its joints holds, as angles.

use maulstick_num::geometry::shortest_arc;

use crate::spine::{SpineShape, angles_in_brush, direction_in_brush};

/// θ and φ (Baxter 2004, eq. 3.10) of each segment's anchor, rad, as seen from the segment before it, whose frame is the
/// spine's own rotated to it by the shortest arc.
pub fn anchors(shape: &SpineShape) -> impl Iterator<Item = [f32; 2]> {
    let (base, frame) = (shape.base(), shape.frame.conjugate());
    let before = [base].into_iter().chain(shape.directions.iter().copied());
    before.zip(&shape.anchors).map(move |(before, anchor)| {
        let local = frame * (shortest_arc(before, base) * *anchor);
        angles_in_brush(local).map(|angle| angle as f32)
    })
}

/// Bends a spine to the `angles` of its joints, with [`anchors`] as given.
pub fn bend(shape: &mut SpineShape, angles: &[[f32; 2]], anchors: &[[f32; 2]]) {
    *shape = SpineShape::from_angles(shape.root, shape.frame, angles);
    let (base, frame) = (shape.base(), shape.frame);
    let above = [base].into_iter().chain(shape.directions.iter().copied());
    for ((anchor, angles), above) in shape.anchors.iter_mut().zip(anchors).zip(above) {
        let local = direction_in_brush(angles.map(f64::from));
        *anchor = (shortest_arc(base, above) * (frame * local)).normalize();
    }
}
