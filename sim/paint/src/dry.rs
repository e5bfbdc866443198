//! What has dried on a tile: layers one over the other, as many as there are.
//!
//! A stack is a list from the newest layer down, and shares what lies below with every older version
//! of the tile: drying a tile adds a link, whatever lies under it.

use std::sync::Arc;

use crate::quantum::{Counts, SLOTS, add};
use crate::tile::{Planes, TILE_CELLS, plane_counts};

/// Paint of a tile that dried at one time.
#[derive(Debug, PartialEq)]
pub struct DryLayer {
    /// Number of the layer in the painting.
    pub number: u32,
    /// Counts by slot, as when they were wet.
    pub planes: Planes,
}

/// A layer and what lies under it.
#[derive(Debug)]
pub struct DryStack {
    layer: DryLayer,
    below: Option<Arc<DryStack>>,
    /// Quanta of this layer and all below, a cell.
    height: Box<[f32]>,
    depth: usize,
    bytes: usize,
}

impl DryStack {
    /// `layer` over what dried before.
    #[must_use]
    pub fn over(below: Option<Arc<Self>>, layer: DryLayer) -> Arc<Self> {
        let mut height: Box<[f32]> = match &below {
            Some(below) => below.height.clone(),
            None => vec![0.0; TILE_CELLS].into(),
        };
        for (_, plane) in &layer.planes {
            height
                .iter_mut()
                .zip(plane.iter())
                .for_each(|(sum, count)| *sum += count);
        }
        let own = (layer.planes.len() + 1) * TILE_CELLS * size_of::<f32>();
        let bytes = own + below.as_ref().map_or(0, |below| below.bytes);
        let depth = 1 + below.as_ref().map_or(0, |below| below.depth);
        Arc::new(Self {
            layer,
            below,
            height,
            depth,
            bytes,
        })
    }

    /// The newest layer.
    #[must_use]
    pub fn layer(&self) -> &DryLayer {
        &self.layer
    }

    /// What lies under it.
    #[must_use]
    pub fn below(&self) -> Option<&Arc<Self>> {
        self.below.as_ref()
    }

    /// Quanta of all layers, a cell.
    #[must_use]
    pub fn height(&self) -> &[f32] {
        &self.height
    }

    /// Number of layers.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Bytes that all layers take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// The layers from the newest down.
    pub fn layers(&self) -> impl Iterator<Item = &DryLayer> {
        let mut next = Some(self);
        std::iter::from_fn(move || {
            let stack = next?;
            next = stack.below.as_deref();
            Some(&stack.layer)
        })
    }

    /// All counts by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = [0; SLOTS];
        for layer in self.layers() {
            add(&mut counts, &plane_counts(&layer.planes));
        }
        counts
    }
}

impl Drop for DryStack {
    /// Layer by layer: thousands of them would overflow the call stack otherwise.
    fn drop(&mut self) {
        let mut next = self.below.take();
        while let Some(stack) = next {
            next = Arc::into_inner(stack).and_then(|mut alone| alone.below.take());
        }
    }
}

impl PartialEq for DryStack {
    fn eq(&self, other: &Self) -> bool {
        self.depth == other.depth && self.layers().eq(other.layers())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(number: u32, count: f32) -> DryLayer {
        let plane: Arc<[f32]> = vec![count; TILE_CELLS].into();
        DryLayer {
            number,
            planes: vec![(1, plane)],
        }
    }

    #[test]
    fn layers_add_up_and_share_what_lies_below() {
        let first = DryStack::over(None, layer(1, 5.0));
        let second = DryStack::over(Some(Arc::clone(&first)), layer(2, 7.0));
        assert_eq!((second.height()[9], second.depth()), (12.0, 2));
        assert_eq!(second.counts()[1], 12 * TILE_CELLS as u64);
        let numbers: Vec<u32> = second.layers().map(|layer| layer.number).collect();
        assert_eq!(numbers, [2, 1]);
        assert!(
            second
                .below()
                .is_some_and(|below| Arc::ptr_eq(below, &first))
        );
        assert!(*second == *DryStack::over(Some(Arc::clone(&first)), layer(2, 7.0)));
        assert!(*second != *DryStack::over(Some(first), layer(2, 8.0)));
    }

    #[test]
    fn a_hundred_thousand_layers_can_be_dropped() {
        let thin = |number: u32| DryLayer {
            number,
            planes: Vec::new(),
        };
        let mut stack = DryStack::over(None, thin(0));
        for number in 1..100_000 {
            let height = Box::default();
            let depth = stack.depth + 1;
            stack = Arc::new(DryStack {
                layer: thin(number),
                below: Some(stack),
                height,
                depth,
                bytes: 0,
            });
        }
        assert_eq!(stack.depth(), 100_000);
        drop(stack);
    }
}
