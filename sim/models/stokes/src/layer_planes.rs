//! Paint in layers of voxels: a separate plane of the model for each paint and layer above the lowest.
//!
//! A layer is a cell high. The counts of a page are all of a paint on a cell; a plane here is its part in one layer
//! above the cell's lowest, and the rest is in the lowest. So films thinner than a cell need no planes, and code that
//! changes counts without layers changes the lowest one, or takes from the highest.

use maulstick_canvas::own_plane::{LAYERS_MOST, OwnShape, ValueType};
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::{QUANTUM_M, SLOTS};
use maulstick_num::exp_f32;

/// Kind of the plane of the first paint in the first layer.
const FIRST: usize = 0x4000;
/// Thickness over which the visibility of paint below falls to 1/e, m.
const SEEN_M: f32 = 150e-6;

/// The plane of a paint in a layer.
#[must_use]
pub const fn shape_of(slot: usize, layer: usize) -> OwnShape {
    OwnShape {
        kind: (FIRST + layer * SLOTS + slot) as u16,
        values: ValueType::F32,
        per_cell: 1,
    }
}

/// Slot and layer of a plane; `None` if it is no layer's.
#[must_use]
pub const fn place_of(shape: OwnShape) -> Option<(usize, usize)> {
    let is_layer = matches!(shape.values, ValueType::F32) && shape.per_cell == 1;
    match (shape.kind as usize).checked_sub(FIRST) {
        Some(kind) if is_layer && kind < LAYERS_MOST * SLOTS => Some((kind % SLOTS, kind / SLOTS)),
        _ => None,
    }
}

/// Quanta of a cell of a plane; 0 where the bytes are not a valid count.
#[must_use]
#[inline]
pub fn value(bytes: &[u8], cell: usize) -> u32 {
    let bytes = bytes[4 * cell..].first_chunk().copied();
    f32::from_le_bytes(bytes.unwrap_or_default()) as u32
}

/// Thickness of each paint seen from above, m, by slot, for planes with layers: the total thickness, with the mixture
/// of its upper layers. `None` for paint in one layer.
#[must_use]
pub fn seen_from_above(planes: &Planes) -> Option<Vec<(usize, Vec<f32>)>> {
    let layers = planes.own().iter().filter_map(|own| {
        let (slot, layer) = place_of(own.shape)?;
        let paint = planes.iter().position(|(known, _)| *known == slot)?;
        Some((paint, layer, &own.bytes[..]))
    });
    let layers: Vec<(usize, usize, &[u8])> = layers.collect();
    if layers.is_empty() {
        return None;
    }
    let mut films: Vec<Vec<f32>> = planes.iter().map(|_| vec![0.0; TILE_CELLS]).collect();
    let mut column = Column::new(planes.len());
    for cell in 0..TILE_CELLS {
        column.read(planes, &layers, cell);
        column.see(films.iter_mut().map(|film| &mut film[cell]));
    }
    Some(planes.iter().map(|(slot, _)| *slot).zip(films).collect())
}

/// The paint over one cell.
#[derive(Debug)]
struct Column {
    /// Quanta of each paint that are not in a layer above.
    lowest: Vec<f32>,
    /// Quanta of each paint by layer, from the second on.
    above: Vec<f32>,
    /// Quanta of each paint, weighted by visibility.
    seen: Vec<f32>,
}

impl Column {
    fn new(paints: usize) -> Self {
        Self {
            lowest: vec![0.0; paints],
            above: Vec::new(),
            seen: vec![0.0; paints],
        }
    }

    fn read(&mut self, planes: &Planes, layers: &[(usize, usize, &[u8])], cell: usize) {
        let paints = self.lowest.len();
        for (lowest, (_, plane)) in self.lowest.iter_mut().zip(planes) {
            *lowest = plane[cell];
        }
        self.above.clear();
        let (mut last, mut rows) = (usize::MAX, 0);
        for (paint, layer, bytes) in layers {
            if *layer != last {
                (last, rows) = (*layer, rows + 1);
                self.above.resize(rows * paints, 0.0);
            }
            let lies = (value(bytes, cell) as f32).min(self.lowest[*paint]);
            self.above[(rows - 1) * paints + paint] = lies;
            self.lowest[*paint] -= lies;
        }
    }

    fn see<'a>(&mut self, films: impl Iterator<Item = &'a mut f32>) {
        let paints = self.lowest.len();
        self.seen.fill(0.0);
        let (mut all, mut through, mut weight) = (0.0, 1.0, 0.0);
        let layers = self
            .above
            .chunks_exact(paints)
            .rev()
            .chain([&self.lowest[..]]);
        for layer in layers {
            let total: f32 = layer.iter().sum();
            if total <= 0.0 {
                continue;
            }
            let left = through * exp_f32(-total * (QUANTUM_M as f32 / SEEN_M));
            let share = (through - left) / total;
            let counts = self.seen.iter_mut().zip(layer);
            counts.for_each(|(seen, count)| *seen += share * count);
            (all, weight, through) = (all + total, weight + through - left, left);
        }
        let thick = if weight > 0.0 {
            all * QUANTUM_M as f32 / weight
        } else {
            0.0
        };
        for (film, seen) in films.zip(&self.seen) {
            *film = thick * seen;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use maulstick_canvas::own_plane::OwnPlane;

    /// Two paints with these quanta on each cell, `above` of the second one's in the second layer.
    fn planes(counts: [f32; 2], above: f32) -> Planes {
        let plane = |count| Arc::from(vec![count; TILE_CELLS]);
        let planes: Planes = [(2, plane(counts[0])), (7, plane(counts[1]))]
            .into_iter()
            .collect();
        let bytes: Vec<u8> = (0..TILE_CELLS).flat_map(|_| above.to_le_bytes()).collect();
        planes.with_own([OwnPlane {
            shape: shape_of(7, 1),
            bytes: bytes.into(),
        }])
    }

    fn seen(planes: &Planes) -> [f32; 2] {
        let films = seen_from_above(planes).expect("layers");
        assert_eq!([films[0].0, films[1].0], [2, 7]);
        [films[0].1[9], films[1].1[9]].map(|film| film / QUANTUM_M as f32)
    }

    #[test]
    fn a_plane_says_its_paint_and_layer() {
        for place in [(0, 1), (63, 0), (5, LAYERS_MOST - 1)] {
            assert_eq!(place_of(shape_of(place.0, place.1)), Some(place));
        }
        let other = OwnShape {
            kind: 5,
            values: ValueType::F32,
            per_cell: 1,
        };
        assert_eq!(place_of(other), None);
    }

    #[test]
    fn what_lies_on_top_is_seen_and_all_stays_as_thick() {
        let thick = 1_000_000.0;
        let [under, over] = seen(&planes([thick, thick], thick));
        assert!((under + over - 2.0 * thick).abs() < 10.0);
        assert!(under < 1e-3 * over, "{under} {over}");
        // A film over it lets it through by exp(−10/150).
        let film = 6710.886;
        let [under, over] = seen(&planes([thick, film], film));
        assert!((over / (under + over) - (1.0 - exp_f32(-10.0 / 150.0))).abs() < 1e-3);
    }

    #[test]
    fn a_mixture_is_seen_as_what_it_is() {
        let [one, other] = seen(&planes([300.0, 100.0], 1.0));
        assert!((one - 300.0).abs() < 0.1 && (other - 100.0).abs() < 0.1);
    }

    #[test]
    fn more_in_a_layer_than_there_is_counts_as_all_there_is() {
        let [one, other] = seen(&planes([300.0, 100.0], 1e9));
        assert!((one + other - 400.0).abs() < 1e-2);
    }
}
