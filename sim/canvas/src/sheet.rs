//! The upper sheet of wet paint: what was laid last and lies over the rest of its cell.
//!
//! The counts of a page are all paint on a cell, and the ledger knows only these. A note beside them says how much of
//! each paint is in the upper sheet; the rest is the body under it. A cell without a note is one sheet. Code that
//! changes counts alone may leave less paint than its note says: then all of it is in the upper sheet.

use std::sync::Arc;

use crate::own_plane::{OwnPlane, OwnShape, ValueType};
use crate::planes::{Planes, TILE_CELLS, painted};
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

/// True for planes that may have two sheets.
pub(crate) fn are_noted(planes: &Planes) -> bool {
    planes.own().iter().any(|own| slot_of(own.shape).is_some())
}

/// Own planes of paint that is to be one sheet.
pub fn without_notes(planes: &Planes) -> impl Iterator<Item = OwnPlane> + '_ {
    let own = planes.own().iter().cloned();
    own.filter(|own| slot_of(own.shape).is_none())
}

/// Quanta of a paint in the upper sheet, by cell; `None` without a note on it.
fn noted(planes: &Planes, slot: usize) -> Option<Vec<f32>> {
    let mut notes = planes.own().iter();
    let note = notes.find(|own| slot_of(own.shape) == Some(slot))?;
    Some(quanta(&note.bytes).collect())
}

/// The lower share of paint, in whole quanta, except in the cells of `stays`: first of the body, then of the upper
/// sheet, which is noted.
pub(crate) fn lower_share(planes: &Planes, share: f32, stays: &[usize]) -> Planes {
    let slots: Vec<usize> = planes.iter().map(|(slot, _)| *slot).collect();
    let upper: Vec<Option<Vec<f32>>> = slots.iter().map(|slot| noted(planes, *slot)).collect();
    let sheets = |k: usize, cell: usize| {
        let all = planes[k].1[cell];
        let noted = upper[k].as_ref().map_or(0.0, |upper| upper[cell]);
        [all - noted.min(all), noted.min(all)]
    };
    let mut shares = vec![[share.min(1.0); 2]; TILE_CELLS];
    if share < 1.0 && are_noted(planes) {
        for (cell, shares) in shares.iter_mut().enumerate() {
            let [mut body, mut above] = [0.0; 2];
            for [own_body, own_above] in (0..slots.len()).map(|k| sheets(k, cell)) {
                (body, above) = (body + own_body, above + own_above);
            }
            let dries = share * (body + above);
            let of_above = (dries - body).max(0.0) / above.max(1.0);
            *shares = [(dries / body.max(1.0)).min(1.0), of_above.min(1.0)];
        }
    }
    stays.iter().for_each(|cell| shares[*cell] = [0.0; 2]);
    let part = |k: usize| {
        let cells = shares.iter().enumerate();
        cells.map(move |(cell, shares)| {
            let [body, above] = sheets(k, cell);
            [(body * shares[0]).floor(), (above * shares[1]).floor()]
        })
    };
    let counts = (slots.iter().enumerate())
        .map(|(k, slot)| (*slot, part(k).map(|[body, above]| body + above).collect()));
    let notes = (slots.iter().enumerate())
        .filter(|(k, _)| upper[*k].is_some())
        .map(|(k, slot)| note(*slot, part(k).map(|[_, above]| above)));
    painted(counts).with_own(notes)
}

/// Own planes of a sum of planes: the notes on both, added, and the other planes of the first.
pub(crate) fn sum_of_notes(one: &Planes, other: &Planes) -> Vec<OwnPlane> {
    let mut own: Vec<OwnPlane> = one.own().to_vec();
    for more in other
        .own()
        .iter()
        .filter(|own| slot_of(own.shape).is_some())
    {
        match own.iter_mut().find(|own| own.shape == more.shape) {
            None => own.push(more.clone()),
            Some(own) => {
                let pairs = quanta(&own.bytes).zip(quanta(&more.bytes));
                own.bytes = pairs.flat_map(|(a, b)| f32::to_le_bytes(a + b)).collect();
            }
        }
    }
    own
}

/// Body and upper sheet of planes, thicknesses in m; `None` where all paint is one sheet.
#[must_use]
pub fn sheets(planes: &Planes) -> Option<[SheetFilms; 2]> {
    if !are_noted(planes) {
        return None;
    }
    let notes: Vec<(usize, &Arc<[u8]>)> = (planes.own().iter())
        .filter_map(|own| Some((slot_of(own.shape)?, &own.bytes)))
        .collect();
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
    use crate::page::Page;
    use crate::tile::Tile;

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

    /// Blue under a sheet of white.
    fn layered() -> Tile {
        let plane = |count: f32| -> Arc<[f32]> { vec![count; TILE_CELLS].into() };
        let planes = Planes::from_iter([(2, plane(1000.0)), (5, plane(500.0))]);
        let notes = [
            note(2, [100.0; TILE_CELLS].into_iter()),
            note(5, [300.0; TILE_CELLS].into_iter()),
        ];
        Tile::of_pages(Some(Page::loose(planes.with_own(notes))), None)
    }

    fn of(films: &SheetFilms) -> Vec<(usize, f64)> {
        let quanta = |film: &[f32]| (f64::from(film[7]) / QUANTUM_M).round();
        films
            .iter()
            .map(|(slot, film)| (*slot, quanta(film)))
            .collect()
    }

    #[test]
    fn the_body_dries_before_the_upper_sheet() {
        let half = layered().dried(1, 0.5, &[]).expect("wet");
        let dry = half.dry().expect("dried").layer().planes.get();
        let dried = [dry[0].1[7], dry[1].1[7]];
        assert_eq!(dried, [613.0, 136.0], "half of all, 9/11 of it blue");
        let [body, upper] = sheets(&half.wet()).expect("two");
        assert_eq!(
            of(&upper),
            [(2, 100.0), (5, 300.0)],
            "all of it stays on top"
        );
        assert_eq!(of(&body), [(2, 287.0), (5, 64.0)]);
        // Then the sheet dries on top of it, in the same layer.
        let most = half.dried(1, 0.8, &[]).expect("wet");
        let [body, upper] = sheets(&most.wet()).expect("two");
        assert_eq!(of(&body), [(2, 0.0), (5, 0.0)]);
        assert_eq!(of(&upper), [(2, 38.0), (5, 113.0)]);
        let whole = most.dried(1, 1.0, &[]).expect("wet");
        assert!(whole.wet_page().is_none());
        let stack = whole.dry().expect("dried");
        assert_eq!((stack.depth(), stack.counts()), (1, layered().counts()));
        assert_eq!(
            sheets(&stack.layer().planes.get()),
            sheets(&layered().wet())
        );
    }

    #[test]
    fn a_layer_that_is_wet_again_has_its_sheets() {
        let before = layered();
        let dried = before.dried(1, 1.0, &[]).expect("wet");
        assert!(dried.wet_page().is_none());
        let planes = dried.dry().expect("dried").layer().planes.get();
        assert!(sheets(&planes).is_some());
        let again = dried.rewet(1, &[true; TILE_CELLS], true);
        assert_eq!(*again.expect("dried").tile.wet(), *before.wet());
        let one = dried.rewet(1, &[true; TILE_CELLS], false);
        let one = one.expect("dried").tile.wet();
        assert!(sheets(&one).is_none() && one.to_vec() == before.wet().to_vec());
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
