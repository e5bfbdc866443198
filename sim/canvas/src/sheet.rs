//! The upper sheet of wet paint: what was laid last and lies over the rest of its cell.
//!
//! The counts of a page are all paint on a cell, and the ledger knows only these. A note beside them says how much of
//! each paint is in the upper sheet; the rest is the body under it. A cell without a note is one sheet. Code that
//! changes counts alone may leave less paint than its note says: then all of it is in the upper sheet.

use std::sync::Arc;

use crate::own_plane::{OwnPlane, OwnShape, ValueType};
use crate::planes::Planes;
use crate::quantum::{QUANTUM_M, SLOTS};

/// Kind of the note of the first paint.
const FIRST: u16 = 0xFF40;

/// Thickness of each paint of a sheet, m, by slot.
pub type SheetFilms = Vec<(usize, Vec<f32>)>;

/// Shape of the note on a paint.
#[must_use]
pub const fn shape_of(slot: usize) -> OwnShape {
    OwnShape {
        kind: FIRST + slot as u16,
        values: ValueType::F32,
        per_cell: 1,
    }
}

/// Slot of the paint that a plane is the note on.
#[must_use]
pub fn slot_of(shape: OwnShape) -> Option<usize> {
    let slot = usize::from(shape.kind.checked_sub(FIRST)?);
    (slot < SLOTS && shape == shape_of(slot)).then_some(slot)
}

/// The note on a paint with these quanta in the upper sheet.
#[must_use]
pub fn note(slot: usize, upper: impl Iterator<Item = f32>) -> OwnPlane {
    OwnPlane {
        shape: shape_of(slot),
        bytes: upper.flat_map(f32::to_le_bytes).collect(),
    }
}

/// Quanta of the upper sheet in a note; 0 where the bytes are not a valid count.
pub fn quanta(bytes: &[u8]) -> impl Iterator<Item = f32> + '_ {
    let values = bytes.as_chunks().0.iter();
    values.map(|bytes| f32::from_le_bytes(*bytes).max(0.0))
}

/// Body and upper sheet of planes, thicknesses in m; `None` where all paint is one sheet.
#[must_use]
pub fn sheets(planes: &Planes) -> Option<[SheetFilms; 2]> {
    let notes: Vec<(usize, &Arc<[u8]>)> = (planes.own().iter())
        .filter_map(|own| Some((slot_of(own.shape)?, &own.bytes)))
        .collect();
    if notes.is_empty() {
        return None;
    }
    let metres = |quanta: f32| quanta * QUANTUM_M as f32;
    let (mut body, mut upper) = (SheetFilms::new(), SheetFilms::new());
    for (slot, plane) in planes {
        let Some((_, bytes)) = notes.iter().find(|(of, _)| of == slot) else {
            body.push((*slot, plane.iter().copied().map(metres).collect()));
            continue;
        };
        let above: Vec<f32> = (plane.iter().zip(quanta(bytes)))
            .map(|(count, upper)| upper.min(*count))
            .collect();
        let below = plane.iter().zip(&above).map(|(all, above)| all - above);
        body.push((*slot, below.map(metres).collect()));
        upper.push((*slot, above.into_iter().map(metres).collect()));
    }
    Some([body, upper])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::TILE_CELLS;

    #[test]
    fn sheets_are_all_paint_between_them() {
        let plane = |count: f32| -> Arc<[f32]> { vec![count; TILE_CELLS].into() };
        let planes = Planes::from_iter([(2, plane(1000.0)), (5, plane(300.0))]);
        assert_eq!(sheets(&planes), None);
        // A note of more than there is counts as all.
        for (noted, lies) in [(100.0, 100.0), (400.0, 300.0), (f32::NAN, 0.0), (-5.0, 0.0)] {
            let noted = planes
                .clone()
                .with_own([note(5, [noted; TILE_CELLS].into_iter())]);
            let [body, upper] = sheets(&noted).expect("a note");
            assert_eq!((body.len(), upper.len(), upper[0].0), (2, 1, 5));
            let quanta = |film: &[f32]| (f64::from(film[7]) / QUANTUM_M).round();
            assert_eq!(quanta(&body[0].1), 1000.0);
            assert_eq!(
                [&body[1].1, &upper[0].1].map(|film| quanta(film)),
                [300.0 - lies, lies]
            );
        }
    }

    #[test]
    fn notes_are_told_from_other_planes() {
        for slot in [0, 7, SLOTS - 1] {
            assert_eq!(slot_of(shape_of(slot)), Some(slot));
            assert!(shape_of(slot).is_note());
        }
        let wide = OwnShape {
            per_cell: 2,
            ..shape_of(3)
        };
        let beyond = OwnShape {
            kind: FIRST + SLOTS as u16,
            ..shape_of(0)
        };
        assert_eq!([slot_of(wide), slot_of(beyond)], [None; 2]);
    }
}
