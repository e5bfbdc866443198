//! Films on the graphics device for as long as it does its work, on the processor from then on.

use maulstick_optics::backend::{BackendError, CpuFilms, FilmBackend};
use maulstick_optics::{FilmPlanes, Studio};

/// A backend that never gives up.
pub(super) struct SteadyFilms(Box<dyn FilmBackend>);

impl Default for SteadyFilms {
    fn default() -> Self {
        Self(Box::new(CpuFilms::new()))
    }
}

impl SteadyFilms {
    pub(super) fn new(first: Box<dyn FilmBackend>) -> Self {
        Self(first)
    }

    /// Does `work`, again on the processor where the device fails.
    fn steadily<T>(
        &mut self,
        work: impl Fn(&mut dyn FilmBackend) -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        match work(&mut *self.0) {
            Err(BackendError::Device(error)) => {
                tracing::warn!(
                    "{} fails: {error}; colour is computed by the processor now",
                    self.0.name()
                );
                self.0 = Box::new(CpuFilms::new());
                work(&mut *self.0)
            }
            done => done,
        }
    }
}

impl FilmBackend for SteadyFilms {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn shade(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<[Vec<f32>; 3]>, BackendError> {
        self.steadily(|films| films.shade(studio, tiles))
    }

    fn bake(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<Vec<f32>>, BackendError> {
        self.steadily(|films| films.bake(studio, tiles))
    }
}

impl std::fmt::Debug for SteadyFilms {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("SteadyFilms").field(&self.0.name()).finish()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::Under;

    use super::*;

    /// A device that is lost at its second batch.
    struct Frail {
        batches: u32,
    }

    impl FilmBackend for Frail {
        fn name(&self) -> &str {
            "frail"
        }

        fn shade(
            &mut self,
            studio: &Studio,
            tiles: &[FilmPlanes<'_>],
        ) -> Result<Vec<[Vec<f32>; 3]>, BackendError> {
            self.batches += 1;
            match self.batches {
                1 => CpuFilms::new().shade(studio, tiles),
                _ => Err(BackendError::Device("lost".into())),
            }
        }

        fn bake(
            &mut self,
            studio: &Studio,
            tiles: &[FilmPlanes<'_>],
        ) -> Result<Vec<Vec<f32>>, BackendError> {
            CpuFilms::new().bake(studio, tiles)
        }
    }

    #[test]
    fn a_lost_device_is_replaced_and_nothing_is_missing() {
        let studio = Studio::daylight();
        let ground = vec![0.5; studio.wavelengths()];
        let tile = FilmPlanes {
            paints: &[],
            opacity: 1.0,
            under: Under::Even(&ground),
        };
        let mut films = SteadyFilms::new(Box::new(Frail { batches: 0 }));
        let first = films.shade(&studio, &[tile]).expect("the device");
        assert_eq!(films.name(), "frail");
        let second = films.shade(&studio, &[tile]).expect("the processor");
        assert!(films.name() == "cpu" && first == second);
        let wrong = FilmPlanes {
            under: Under::Even(&ground[1..]),
            ..tile
        };
        assert!(
            films.shade(&studio, &[wrong]).is_err(),
            "no device helps a wrong tile"
        );
    }
}
