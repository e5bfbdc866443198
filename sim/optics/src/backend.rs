//! Films of many tiles at once, on any backend.

use std::num::NonZero;
use std::panic::resume_unwind;
use std::thread::{Builder, available_parallelism, scope};

use maulstick_types::paint::TILE;

use crate::studio::{FilmPlanes, Studio, Under};

/// Cells of a tile, row after row.
pub const TILE_CELLS: usize = TILE * TILE;
/// Most paints of a film: as many as a painting has.
pub const MOST_PAINTS: usize = 64;
/// Most threads that [`CpuFilms::new`] takes: painting itself needs the others.
const MOST_THREADS: usize = 2;

/// Computes films of tiles; each plane of a tile has [`TILE_CELLS`] values.
pub trait FilmBackend: Send {
    /// Name of the backend: `cpu`, or the name of a graphics adapter.
    fn name(&self) -> &str;

    /// Linear sRGB, without gloss, of each tile: [`Studio::shade`].
    ///
    /// # Errors
    /// A [`BackendError`]; after [`BackendError::Device`] [`CpuFilms`] can still compute the tiles.
    fn shade(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<[Vec<f32>; 3]>, BackendError>;

    /// Internal reflectance of each tile, a plane a wavelength: [`Studio::bake`].
    ///
    /// # Errors
    /// As [`shade`](Self::shade).
    fn bake(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<Vec<f32>>, BackendError>;
}

/// Errors of computing films.
#[derive(Debug, thiserror::Error)]
pub enum BackendError {
    /// They do not fit the studio or a tile, on any backend.
    #[error("tile {tile} of the batch cannot be shaded: {what}")]
    Films {
        /// Index of the tile in the batch.
        tile: usize,
        /// The defect.
        what: String,
    },
    /// The device failed, and will not do better next time.
    #[error("the graphics device fails: {0}; use the cpu")]
    Device(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// Checks that tiles fit a studio.
///
/// # Errors
/// [`BackendError::Films`].
pub fn check(studio: &Studio, tiles: &[FilmPlanes<'_>]) -> Result<(), BackendError> {
    for (tile, films) in tiles.iter().enumerate() {
        let wrong = |what: String| Err(BackendError::Films { tile, what });
        if films.paints.len() > MOST_PAINTS {
            let paints = films.paints.len();
            return wrong(format!("{paints} paints are more than {MOST_PAINTS}"));
        }
        for (slot, plane) in films.paints {
            if *slot >= studio.slots() {
                return wrong(format!("no paint has slot {slot}"));
            }
            if plane.len() != TILE_CELLS {
                let cells = plane.len();
                return wrong(format!("a paint has {cells} cells, not {TILE_CELLS}"));
            }
        }
        let samples = studio.wavelengths();
        let (values, want) = match films.under {
            Under::Even(values) => (values.len(), samples),
            Under::Planes(values) => (values.len(), samples * TILE_CELLS),
        };
        if values != want {
            return wrong(format!("under it lie {values} reflectances, not {want}"));
        }
    }
    Ok(())
}

/// Films on the processor: the same values on every machine, with any number of threads.
#[derive(Clone, Copy, Debug)]
pub struct CpuFilms {
    threads: NonZero<usize>,
}

impl Default for CpuFilms {
    fn default() -> Self {
        Self::new()
    }
}

impl CpuFilms {
    /// One thread a core, at most two.
    #[must_use]
    pub fn new() -> Self {
        let cores = available_parallelism().map_or(1, NonZero::get);
        Self::with_threads(NonZero::new(cores.min(MOST_THREADS)).unwrap_or(NonZero::<usize>::MIN))
    }

    /// A number of threads, the caller's included.
    #[must_use]
    pub fn with_threads(threads: NonZero<usize>) -> Self {
        Self { threads }
    }

    /// The work of each tile, in order; without other threads the caller's does it all.
    fn each<'a, T: Send>(
        self,
        tiles: &[FilmPlanes<'a>],
        work: impl Fn(&FilmPlanes<'a>) -> T + Sync,
    ) -> Vec<T> {
        let share = tiles.len().div_ceil(self.threads.get());
        let (own, others) = tiles.split_at(share);
        let run = |tiles: &[FilmPlanes<'a>]| tiles.iter().map(&work).collect::<Vec<T>>();
        scope(|scope| {
            let helpers: Vec<_> = others
                .chunks(share.max(1))
                .map(|tiles| {
                    let helper = Builder::new().spawn_scoped(scope, move || run(tiles));
                    (tiles, helper)
                })
                .collect();
            let mut all = run(own);
            for (tiles, helper) in helpers {
                match helper.map(std::thread::ScopedJoinHandle::join) {
                    Ok(Ok(theirs)) => all.extend(theirs),
                    Ok(Err(panic)) => resume_unwind(panic),
                    Err(_) => all.extend(run(tiles)),
                }
            }
            all
        })
    }
}

impl FilmBackend for CpuFilms {
    fn name(&self) -> &str {
        "cpu"
    }

    fn shade(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<[Vec<f32>; 3]>, BackendError> {
        check(studio, tiles)?;
        Ok(self.each(tiles, |films| {
            let mut rgb = std::array::from_fn(|_| vec![0.0; TILE_CELLS]);
            studio.shade(films, rgb.each_mut().map(Vec::as_mut_slice));
            rgb
        }))
    }

    fn bake(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<Vec<f32>>, BackendError> {
        check(studio, tiles)?;
        Ok(self.each(tiles, |films| studio.bake(films, TILE_CELLS)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paints::PaintLibrary;

    #[test]
    fn any_number_of_threads_gives_the_same() {
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::daylight();
        studio.add(&library.paints()[3]);
        let ground = vec![0.7f32; studio.wavelengths()];
        let planes: Vec<Vec<f32>> = (0..7)
            .map(|tile| (0..TILE_CELLS).map(|i| 1e-8 * (tile * i) as f32).collect())
            .collect();
        let paints: Vec<[(usize, &[f32]); 1]> = planes.iter().map(|p| [(0, &p[..])]).collect();
        let tiles: Vec<FilmPlanes<'_>> = paints
            .iter()
            .map(|paints| FilmPlanes {
                paints,
                opacity: 1.0,
                under: Under::Even(&ground),
            })
            .collect();
        let with = |threads: usize| {
            let mut films = CpuFilms::with_threads(NonZero::new(threads).expect("some"));
            let shaded = films.shade(&studio, &tiles).expect("shaded");
            (shaded, films.bake(&studio, &tiles).expect("baked"))
        };
        let one = with(1);
        assert_eq!((one.0.len(), one.1.len()), (7, 7));
        assert!([2, 3, 7, 50].iter().all(|threads| with(*threads) == one));
        assert!(
            CpuFilms::new()
                .shade(&studio, &[])
                .expect("none")
                .is_empty()
        );
    }

    #[test]
    fn what_fits_no_tile_is_an_error() {
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::daylight();
        studio.add(&library.paints()[0]);
        let (ground, plane) = (vec![0.5f32; 8], vec![0.0f32; TILE_CELLS]);
        let says = |slot: usize, plane: &[f32], count: usize, ground: &[f32]| {
            let paints = vec![(slot, plane); count];
            let films = FilmPlanes {
                paints: &paints,
                opacity: 1.0,
                under: Under::Even(ground),
            };
            check(&studio, &[films]).map_err(|error| error.to_string())
        };
        assert_eq!(says(0, &plane, 64, &ground), Ok(()));
        for (got, part) in [
            (says(1, &plane, 1, &ground), "no paint has slot 1"),
            (says(0, &plane[1..], 1, &ground), "4095 cells"),
            (says(0, &plane, 65, &ground), "65 paints"),
            (says(0, &plane, 1, &ground[1..]), "7 reflectances"),
        ] {
            assert!(got.expect_err("wrong").contains(part), "{part}");
        }
    }
}
