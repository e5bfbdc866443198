//! Dried paint of a tile: any number of stacked layers.
//!
//! A stack is a list from the newest layer down, and shares its lower layers with every older version of the tile:
//! drying a tile adds a link, whatever is below it.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use crate::page::{Evict, Page, Pager};
use crate::planes::{Planes, TILE_CELLS, plane_counts};
use crate::quantum::{Counts, SLOTS, add};

/// Greatest number of dry layers of a tile; beyond it paint stays wet, because reading a tile visits all of them.
pub const DRY_LAYERS_MOST: usize = 4096;

/// Paint of a tile that dried at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct DryLayer {
    /// Number of the layer in the painting.
    pub number: u32,
    /// Counts by slot, as when they were wet.
    pub planes: Page<Planes>,
}

/// A layer and those under it.
#[derive(Debug)]
pub struct DryStack {
    id: u64,
    layer: DryLayer,
    below: Option<Arc<DryStack>>,
    height: Arc<Height>,
    depth: usize,
    stored: AtomicBool,
}

/// Quanta of a layer and all below it, by cell, summed on demand.
#[derive(Debug)]
struct Height {
    pager: Arc<Pager>,
    cells: Mutex<Option<Arc<[f32]>>>,
    used: AtomicBool,
}

const HEIGHT_BYTES: usize = TILE_CELLS * size_of::<f32>();

impl Height {
    fn kept(&self) -> Option<Arc<[f32]>> {
        self.used.store(true, Relaxed);
        let cells = self.cells.lock().unwrap_or_else(PoisonError::into_inner);
        cells.clone()
    }
}

impl Evict for Height {
    fn evict(&self) -> Option<usize> {
        if self.used.swap(false, Relaxed) {
            return None;
        }
        let taken = self.cells.try_lock().ok()?.take();
        Some(taken.map_or(0, |_| HEIGHT_BYTES))
    }
}

impl Drop for Height {
    fn drop(&mut self) {
        let cells = self.cells.get_mut().unwrap_or_else(PoisonError::into_inner);
        if cells.is_some() {
            self.pager.left(HEIGHT_BYTES);
        }
    }
}

impl DryStack {
    /// `layer` over the earlier stack.
    #[must_use]
    pub fn over(below: Option<Arc<Self>>, layer: DryLayer) -> Arc<Self> {
        let id = layer.planes.pager().number();
        Self::known(id, below, layer)
    }

    /// `layer` over the earlier stack, with its number in the document.
    #[must_use]
    pub fn known(id: u64, below: Option<Arc<Self>>, layer: DryLayer) -> Arc<Self> {
        let height = Height {
            pager: Arc::clone(layer.planes.pager()),
            cells: Mutex::default(),
            used: AtomicBool::new(false),
        };
        Arc::new(Self {
            id,
            depth: 1 + below.as_ref().map_or(0, |below| below.depth),
            layer,
            below,
            height: Arc::new(height),
            stored: AtomicBool::new(false),
        })
    }

    /// Number among the pages of the painting.
    #[must_use]
    pub fn id(&self) -> u64 {
        self.id
    }

    /// True if it is stored in the document.
    #[must_use]
    pub fn is_stored(&self) -> bool {
        self.stored.load(Relaxed)
    }

    /// Marks it as stored in the document.
    pub fn note_stored(&self) {
        self.stored.store(true, Relaxed);
    }

    /// The newest layer.
    #[must_use]
    pub fn layer(&self) -> &DryLayer {
        &self.layer
    }

    /// The layers under it.
    #[must_use]
    pub fn below(&self) -> Option<&Arc<Self>> {
        self.below.as_ref()
    }

    /// Quanta of all layers, by cell.
    #[must_use]
    pub fn height(&self) -> Arc<[f32]> {
        if let Some(kept) = self.height.kept() {
            return kept;
        }
        let mut above = vec![self];
        let mut under = None;
        let mut next = self.below.as_deref();
        while let Some(stack) = next {
            under = stack.height.kept();
            if under.is_some() {
                break;
            }
            above.push(stack);
            next = stack.below.as_deref();
        }
        let mut sum: Vec<f32> = under.map_or_else(|| vec![0.0; TILE_CELLS], |under| under.to_vec());
        for stack in above.iter().rev() {
            for (_, plane) in &*stack.layer.planes.get() {
                let cells = sum.iter_mut().zip(plane.iter());
                cells.for_each(|(sum, count)| *sum += count);
            }
        }
        let sum: Arc<[f32]> = sum.into();
        let mut cells = self
            .height
            .cells
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let first = cells.replace(Arc::clone(&sum)).is_none();
        drop(cells);
        if first {
            let weak: Weak<Height> = Arc::downgrade(&self.height);
            self.height.pager.enter(HEIGHT_BYTES, weak);
        }
        sum
    }

    /// Number of layers.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
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
            add(&mut counts, &plane_counts(&layer.planes.get()));
        }
        counts
    }
}

impl Drop for DryStack {
    /// Drops layer by layer: thousands of them would overflow the call stack otherwise.
    fn drop(&mut self) {
        if *self.stored.get_mut() {
            self.height.pager.bury(self.id);
        }
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
            planes: Page::loose(Planes::from_iter([(1, plane)])),
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
        let planes = Page::loose(Planes::new());
        let thin = |number: u32| DryLayer {
            number,
            planes: planes.clone(),
        };
        let mut stack = DryStack::over(None, thin(0));
        for number in 1..100_000 {
            stack = DryStack::over(Some(stack), thin(number));
        }
        assert_eq!(stack.depth(), 100_000);
        drop(stack);
    }
}
