//! A surface band by band. A band is a row of tiles; the highest is the first, as in a picture.
//!
//! Two threads draw the bands, and the results are returned in order: a surface of any height needs memory for a few of
//! its bands, and the bytes are independent of the threads.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::Range;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_optics::Under;
use maulstick_optics::backend::CpuFilms;
use maulstick_optics::light::HeightField;
use maulstick_optics::light::shadow::REACH;
use maulstick_types::paint::TILE;

use crate::appearance::Appearance;
use crate::bakery::Bakery;
use crate::display::DisplayTile;
use crate::shown_surface::ShownSurface;

/// Number of drawing threads: the stepper and its worker have the other cores.
const THREADS: usize = 2;
/// Number of rows beyond a band on which its shadows, occlusion and slopes depend.
const MARGIN_ROWS: usize = REACH as usize;
/// Number of bands that a [`Shelf`] caches on either side of the requested one: more than the distance between the
/// threads.
const CACHED_BANDS: usize = 6;

/// Does `jobs` jobs on two threads and passes the results to `take`, on this thread and in order, with the number of
/// the job. At most four results wait.
///
/// # Errors
/// The first error of `take`, after which no more jobs begin.
pub fn in_order<T: Send, E>(
    jobs: usize,
    job: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(usize, T) -> Result<(), E>,
) -> Result<(), E> {
    std::thread::scope(|scope| {
        let job = &job;
        let lines = [(); THREADS].map(|()| sync_channel(1));
        let mut made = Vec::new();
        for (first, (to, from)) in lines.into_iter().enumerate() {
            scope.spawn(move || {
                for number in (first..jobs).step_by(THREADS) {
                    if to.send(job(number)).is_err() {
                        break;
                    }
                }
            });
            made.push(from);
        }
        for number in 0..jobs {
            // A thread that panicked ends the scope with its panic.
            let Ok(result) = made[number % THREADS].recv() else {
                break;
            };
            take(number, result)?;
        }
        Ok(())
    })
}

/// Data shared by neighbouring bands: made on the first request, dropped once the work is past it.
#[derive(Debug)]
pub struct Shelf<T>(Mutex<BTreeMap<usize, Arc<OnceLock<Arc<T>>>>>);

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Shelf<T> {
    /// Data of a band.
    pub fn get(&self, band: usize, make: impl FnOnce() -> T) -> Arc<T> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|other, _| other.abs_diff(band) <= CACHED_BANDS);
        let place = Arc::clone(kept.entry(band).or_default());
        drop(kept);
        Arc::clone(place.get_or_init(|| Arc::new(make())))
    }
}

/// Heights of a band and of the neighbouring rows that its light depends on.
#[derive(Clone, Debug)]
pub struct BandHeights {
    heights: Vec<f32>,
    cells: [usize; 2],
    cell_m: f32,
    /// Index of the band's lowest row among these.
    pub first: usize,
}

impl BandHeights {
    /// Height field for the light; row `first` is the band's lowest.
    #[must_use]
    pub fn field(&self) -> HeightField<'_> {
        HeightField {
            heights: &self.heights,
            cells: self.cells,
            cell_m: self.cell_m,
        }
    }
}

/// A surface in bands.
#[derive(Debug)]
pub struct Banded<'a> {
    store: &'a TileStore,
    bare: &'a ShownSurface,
    look: &'a Appearance,
    cell_m: f64,
    heights: Shelf<Vec<f32>>,
}

impl<'a> Banded<'a> {
    /// Tiles on a ground, cells of side `cell_m`.
    #[must_use]
    pub fn new(
        store: &'a TileStore,
        bare: &'a ShownSurface,
        look: &'a Appearance,
        cell_m: f64,
    ) -> Self {
        Self {
            store,
            bare,
            look,
            cell_m,
            heights: Shelf::default(),
        }
    }

    /// Cells across and up.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.store.cells().map(|cells| cells as usize)
    }

    /// Side of a cell, m.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Its tiles.
    #[must_use]
    pub fn store(&self) -> &'a TileStore {
        self.store
    }

    /// The unpainted surface.
    #[must_use]
    pub fn bare(&self) -> &'a ShownSurface {
        self.bare
    }

    /// Number of bands.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.store.grid()[1] as usize
    }

    /// Rows of a band, from its lowest, counted from the surface's lowest.
    #[must_use]
    pub fn rows(&self, band: usize) -> Range<usize> {
        let lowest = (self.bands() - 1 - band) * TILE;
        lowest..(lowest + TILE).min(self.cells()[1])
    }

    /// The tiles of a band from the left, each with its paint.
    pub fn tiles(&self, band: usize) -> impl Iterator<Item = (TileId, Option<&'a Tile>)> + use<'a> {
        let [across, up] = self.store.grid();
        let (store, y) = (self.store, up - 1 - band as u32);
        (0..across).map(move |x| {
            let id = TileId { x, y };
            (id, store.version(id).tile.as_deref())
        })
    }

    /// The part of a tile within the surface: columns and rows.
    #[must_use]
    pub fn within(&self, id: TileId) -> [usize; 2] {
        let [width, height] = self.cells();
        [(width, id.x), (height, id.y)].map(|(cells, at)| TILE.min(cells - at as usize * TILE))
    }

    /// Heights of a band, m, row after row from its lowest.
    #[must_use]
    pub fn heights(&self, band: usize) -> Arc<Vec<f32>> {
        self.heights.get(band, || {
            let width = self.cells()[0];
            let mut heights = vec![0.0f32; self.rows(band).len() * width];
            for (id, tile) in self.tiles(band) {
                let plane = self.bare.height(id, tile);
                self.spread(id, &plane, &mut heights);
            }
            heights
        })
    }

    /// Puts a plane of a tile into its place in a plane of its band.
    pub fn spread(&self, id: TileId, plane: &[f32], band: &mut [f32]) {
        let [across, up] = self.within(id);
        let (width, left) = (self.cells()[0], id.x as usize * TILE);
        for y in 0..up {
            band[y * width + left..][..across].copy_from_slice(&plane[y * TILE..][..across]);
        }
    }

    /// Heights of a band and its neighbouring rows.
    #[must_use]
    pub fn heights_around(&self, band: usize) -> BandHeights {
        let (width, rows) = (self.cells()[0], self.rows(band));
        let own = self.heights(band);
        let mut heights = Vec::with_capacity((rows.len() + 2 * MARGIN_ROWS) * width);
        if band + 1 < self.bands() {
            let below = self.heights(band + 1);
            heights.extend_from_slice(&below[below.len().saturating_sub(MARGIN_ROWS * width)..]);
        }
        let first = heights.len() / width;
        heights.extend_from_slice(&own);
        if band > 0 {
            let above = self.heights(band - 1);
            heights.extend_from_slice(&above[..above.len().min(MARGIN_ROWS * width)]);
        }
        BandHeights {
            cells: [width, heights.len() / width],
            heights,
            cell_m: self.cell_m as f32,
            first,
        }
    }

    /// A tile of the surface before light, with `tile` on it, drawn by this thread alone. Baked layers stay in
    /// `bakery`, for the next tile over the same dry layers.
    #[must_use]
    pub fn shown(&self, id: TileId, tile: Option<&Tile>, bakery: &mut Bakery) -> DisplayTile {
        let ground = self.bare.ground.tile(id);
        let baked = self.bare.baked(tile).map(|stack| {
            let mut alone = CpuFilms::with_threads(NonZero::<usize>::MIN);
            let under = ground.under();
            bakery.planes(
                (self.look, &mut alone),
                self.bare.shown,
                0,
                id,
                (stack, under),
            )
        });
        let under = baked
            .as_deref()
            .map_or_else(|| ground.under(), Under::Planes);
        let films = self.bare.films(tile);
        let unlit = films.shade(&self.look.studio, under);
        self.bare.display(id, tile, (&films, unlit), self.look)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    use super::*;

    #[test]
    fn jobs_come_in_order_and_no_more_begin_after_an_error() {
        let begun = AtomicUsize::new(0);
        let job = |number: usize| {
            begun.fetch_add(1, Relaxed);
            number * number
        };
        let mut got = Vec::new();
        let all: Result<(), ()> = in_order(25, job, |number, square| {
            got.push((number, square));
            Ok(())
        });
        assert_eq!(all, Ok(()));
        assert!(got.iter().copied().eq((0..25).map(|i| (i, i * i))));
        begun.store(0, Relaxed);
        let stopped = in_order(1000, job, |number, _| match number {
            7 => Err("full"),
            _ => Ok(()),
        });
        assert_eq!(stopped, Err("full"));
        assert!(begun.load(Relaxed) < 16, "{begun:?}");
        assert_eq!(in_order(0, job, |_, _| Err("none")), Ok(()));
    }

    #[test]
    fn a_shelf_makes_once_and_forgets() {
        let made = AtomicUsize::new(0);
        let shelf = Shelf::default();
        let get = |band: usize| {
            *shelf.get(band, || {
                made.fetch_add(1, Relaxed);
                band
            })
        };
        for band in 0..50usize {
            for near in band.saturating_sub(1)..band + 2 {
                assert_eq!(get(near), near);
            }
        }
        assert_eq!(made.load(Relaxed), 51);
        assert_eq!(get(0), 0, "and makes it again");
        assert_eq!(made.load(Relaxed), 52);
    }
}
