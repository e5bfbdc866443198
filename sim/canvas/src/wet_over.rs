//! The wet film that stayed over a layer when that dried, for models whose colours depend on it.

use std::sync::Arc;

use crate::dry::{DryLayer, DryStack};
use crate::own_plane::{OwnPlane, OwnShape, ValueType};
use crate::page::Page;
use crate::planes::{Planes, TILE_CELLS};
use crate::tile::Tile;

/// Quanta of a step of the plane.
const STEP: f32 = 16.0;

/// Shape of the plane; its kind is no model's.
const SHAPE: OwnShape = OwnShape {
    kind: u16::MAX,
    values: ValueType::U16,
    per_cell: 1,
};

/// Wet quanta of all paints that stayed over a dried page, a cell; `None` where nothing did.
#[must_use]
pub fn wet_over(dried: &Planes) -> Option<Vec<f32>> {
    let plane = dried.own().iter().find(|plane| plane.shape == SHAPE)?;
    let values = plane.bytes.chunks_exact(2);
    Some(
        values
            .map(|two| f32::from(u16::from_le_bytes([two[0], two[1]])) * STEP)
            .collect(),
    )
}

/// Dried planes with so many wet quanta noted over each cell, in steps of 16.
#[must_use]
pub fn noted(dried: Planes, stays: &[f32]) -> Planes {
    let most = f32::from(u16::MAX);
    let values = stays.iter().map(|quanta| (quanta / STEP).min(most) as u16);
    let note = OwnPlane {
        shape: SHAPE,
        bytes: values.flat_map(u16::to_le_bytes).collect(),
    };
    let others = dried.own().iter().filter(|plane| !is_wet_over(plane));
    let own: Vec<OwnPlane> = others.cloned().chain([note]).collect();
    dried.with_own(own)
}

/// True if a plane holds what stayed over a layer, and says nothing without the layer.
pub(crate) fn is_wet_over(plane: &OwnPlane) -> bool {
    plane.shape == SHAPE
}

impl Tile {
    /// The tile with the amount of its wet paint noted on its newest dry layer.
    #[must_use]
    pub fn with_wet_noted(self) -> Self {
        let Some(newest) = self.dry() else {
            return self;
        };
        let layer = newest.layer();
        let planes = layer.planes.get();
        let mut stays = vec![0.0f32; TILE_CELLS];
        for (_, plane) in &*self.wet() {
            stays
                .iter_mut()
                .zip(plane.iter())
                .for_each(|(sum, count)| *sum += count);
        }
        let planes = noted((*planes).clone(), &stays);
        if planes == *layer.planes.get() {
            return self;
        }
        let layer = DryLayer {
            number: layer.number,
            planes: Page::new(layer.planes.pager(), Arc::new(planes), Some(&layer.planes)),
        };
        let dry = Some(DryStack::over(newest.below().cloned(), layer));
        Self::of_pages(self.wet_page().cloned(), dry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dried(tile: &Tile, share: f32) -> Tile {
        tile.dried(1, share, &[]).expect("wet").with_wet_noted()
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
        let again = half.rewet(0, &[true; TILE_CELLS]).expect("dried").tile;
        assert!(again.dry().is_none(), "a note alone is no layer");
        assert_eq!(again.counts()[2], 1600 * TILE_CELLS as u64);
    }
}
