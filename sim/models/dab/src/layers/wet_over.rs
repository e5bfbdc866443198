//! The wet film over a layer at the time of its drying, stored as a note on the layer.

use std::sync::Arc;

use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::own_plane::{OwnPlane, OwnShape, ValueType};
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::tile::Tile;

/// Quanta of a step of the plane.
const STEP: f32 = 16.0;

/// Shape of the note's plane.
const SHAPE: OwnShape = OwnShape {
    kind: u16::MAX,
    values: ValueType::U16,
    per_cell: 1,
};

/// Wet quanta of all paints over a dried page, by cell; `None` where there were none.
pub(crate) fn wet_over(dried: &Planes) -> Option<Vec<f32>> {
    let plane = dried.own().iter().find(|plane| plane.shape == SHAPE)?;
    let values = plane.bytes.chunks_exact(2);
    Some(
        values
            .map(|two| f32::from(u16::from_le_bytes([two[0], two[1]])) * STEP)
            .collect(),
    )
}

/// Dried planes with a note of the wet quanta over each cell, in steps of 16.
pub(crate) fn noted(dried: Planes, stays: &[f32]) -> Planes {
    let most = f32::from(u16::MAX);
    let values = stays.iter().map(|quanta| (quanta / STEP).min(most) as u16);
    let note = OwnPlane {
        shape: SHAPE,
        bytes: values.flat_map(u16::to_le_bytes).collect(),
    };
    let others = dried.own().iter().filter(|plane| plane.shape != SHAPE);
    let own: Vec<OwnPlane> = others.cloned().chain([note]).collect();
    dried.with_own(own)
}

/// The tile with a note of its wet paint on its newest dry layer.
pub(crate) fn with_wet_noted(tile: Tile) -> Tile {
    let Some(newest) = tile.dry() else {
        return tile;
    };
    let layer = newest.layer();
    let planes = layer.planes.get();
    let mut stays = vec![0.0f32; TILE_CELLS];
    for (_, plane) in &*tile.wet() {
        stays
            .iter_mut()
            .zip(plane.iter())
            .for_each(|(sum, count)| *sum += count);
    }
    let planes = noted((*planes).clone(), &stays);
    if planes == *layer.planes.get() {
        return tile;
    }
    let layer = DryLayer {
        number: layer.number,
        planes: Page::new(layer.planes.pager(), Arc::new(planes), Some(&layer.planes)),
    };
    let dry = Some(DryStack::over(newest.below().cloned(), layer));
    Tile::of_pages(tile.wet_page().cloned(), dry)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dried(tile: &Tile, share: f32) -> Tile {
        with_wet_noted(tile.dried(1, share, &[]).expect("wet"))
    }

    fn over(tile: &Tile) -> Option<f32> {
        let layer = tile.dry().expect("dried").layer().planes.get();
        Some(wet_over(&layer)?[9])
    }

    #[test]
    fn what_stays_wet_is_noted_until_it_dries_too() {
        let film: Arc<[f32]> = vec![1600.0; TILE_CELLS].into();
        let wet = Tile::new([(2, film)].into_iter(), None);
        let quarter = dried(&wet, 0.25);
        assert_eq!(over(&quarter), Some(1200.0));
        let half = dried(&quarter, 1.0 / 3.0);
        assert_eq!(
            (over(&half), half.dry().expect("dried").depth()),
            (Some(800.0), 1)
        );
        let whole = dried(&half, 1.0);
        assert_eq!(
            (over(&whole), whole.dry().expect("dried").depth()),
            (None, 1)
        );
        let counts = whole.dry().expect("dried").counts();
        assert_eq!(counts[2], 1600 * TILE_CELLS as u64);
        let again = half
            .rewet(0, &[true; TILE_CELLS], false)
            .expect("dried")
            .tile;
        assert!(again.dry().is_none(), "a note alone is no layer");
        assert_eq!(again.counts()[2], 1600 * TILE_CELLS as u64);
    }
}
