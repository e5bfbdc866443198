//! Neighbouring strips, between which paint passes.

use std::cmp::Ordering;

use glam::DVec2;

/// The strips in two orders in which neighbours are adjacent: in columns across the thickness, and in rows along the
/// width, to and fro.
#[must_use]
pub(super) fn orders(roots: &[DVec2], half_m: DVec2) -> [Vec<u32>; 2] {
    let places: Vec<DVec2> = roots.iter().map(|root| *root * half_m).collect();
    let area = 4.0 * half_m.x * half_m.y;
    let pitch = (area / roots.len().max(1) as f64).sqrt();
    [0, 1].map(|axis| {
        let bin = |i: &u32| (places[*i as usize][axis] / pitch).floor() as i64;
        let along = |i: &u32| places[*i as usize][1 - axis];
        let mut order: Vec<u32> = (0..roots.len() as u32).collect();
        order.sort_by(|a, b| match bin(a).cmp(&bin(b)) {
            Ordering::Equal if bin(a).rem_euclid(2) == 0 => along(a).total_cmp(&along(b)),
            Ordering::Equal => along(b).total_cmp(&along(a)),
            unequal => unequal,
        });
        order
    })
}

#[cfg(test)]
mod tests {
    use crate::BrushFile;
    use crate::file::library::LIBRARY;
    use crate::head::Head;

    /// In every brush each strip is once in an order, and stands near the one after it.
    #[test]
    fn orders_hold_each_strip_once_beside_its_neighbours() {
        for (kind, _) in LIBRARY {
            let file = BrushFile::library(kind).expect(kind);
            let head = Head::of(&file);
            let half = [file.radius_m(0.0), file.half_thickness_m(0.0)];
            let pitch = (4.0 * half[0] * half[1] / head.strips() as f64).sqrt();
            for order in head.beside() {
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert!(sorted.iter().copied().eq(0..head.strips() as u32), "{kind}");
                let far = order.windows(2).filter(|pair| {
                    let [a, b] = [pair[0], pair[1]].map(|i| head.roots()[i as usize]);
                    let off = [0, 1].map(|i| f64::from(a[i] - b[i]) * half[i]);
                    (off[0] * off[0] + off[1] * off[1]).sqrt() > 5.0 * pitch
                });
                assert!(far.count() * 10 < order.len(), "{kind}");
            }
        }
    }
}
