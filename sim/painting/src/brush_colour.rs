//! Colour of the paint on a brush: films over hair.

use std::sync::Arc;

use half::f16;
use maulstick_brush::file::sections::Hair;
use maulstick_canvas::quantum::SLOTS;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::{FilmPlanes, Studio, Under, Upsampler};
use maulstick_types::brush::BrushLook;

/// Samples along a strip: each the mean of as many texels as divide it.
pub const SAMPLES: usize = 8;
/// Texels of a sample.
const TEXELS: usize = TEXELS_PER_STRIP / SAMPLES;

/// A brush's load, and the properties of the brush that its picture needs. It shares the load.
#[derive(Clone, Debug)]
pub struct Carried {
    /// The paint.
    pub load: Arc<BrushLoad>,
    /// Material of the bristles.
    pub hair: Hair,
    /// Thickness of a texel's film by its count, m.
    pub film_m: f64,
    /// Quanta of a texel's full film.
    pub film_full: f64,
    /// Quanta on and inside a fully loaded brush.
    pub full_load: f64,
}

impl Carried {
    /// True if it is the same as the other, as long as that exists: a changed load is another allocation.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.load, &other.load) && self.hair == other.hair
    }

    /// Its colours in a studio, over hair of the internal reflectances [`hair`].
    #[must_use]
    pub fn look(&self, studio: &Studio, hair: &[f32]) -> BrushLook {
        let count = self.load.texels() / TEXELS;
        let scale = (self.film_m / TEXELS as f64) as f32;
        let mean = |plane: &[u32]| -> Vec<f32> {
            let parts = plane.chunks_exact(TEXELS);
            parts
                .map(|part| part.iter().map(|count| *count as f32).sum::<f32>() * scale)
                .collect()
        };
        let films: Vec<(usize, Vec<f32>)> = (0..SLOTS.min(studio.slots()))
            .filter_map(|slot| Some((slot, mean(self.load.film_of(slot)?))))
            .collect();
        let paints: Vec<(usize, &[f32])> = films
            .iter()
            .map(|(slot, film)| (*slot, film.as_slice()))
            .collect();
        let planes = FilmPlanes {
            paints: &paints,
            opacity: 1.0,
            under: Under::Even(hair),
        };
        let mut rgb = [const { Vec::new() }; 3];
        rgb.iter_mut().for_each(|plane| plane.resize(count, 0.0));
        let [red, green, blue] = &mut rgb;
        studio.shade(&planes, [red, green, blue]);
        let full = (TEXELS as f64 * self.film_full).max(1.0);
        let share = |part: &[u32]| {
            let held: u64 = part.iter().map(|count| u64::from(*count)).sum();
            (held as f64 / full) as f32
        };
        let shares = self.load.films().chunks_exact(TEXELS).map(share);
        let samples = shares
            .enumerate()
            .flat_map(|(i, share)| [rgb[0][i], rgb[1][i], rgb[2][i], share])
            .flat_map(|value| f16::from_f32(value).to_le_bytes());
        BrushLook {
            strips: (self.load.texels() / TEXELS_PER_STRIP) as u32,
            along: SAMPLES as u32,
            samples: samples.collect::<Vec<u8>>().into(),
            load_share: (self.load.total() as f64 / self.full_load.max(1.0)).min(1.0) as f32,
        }
    }
}

/// Internal reflectances of hair in a studio.
#[must_use]
pub fn hair(hair: Hair, studio: &Studio) -> Vec<f32> {
    let upsampler = Upsampler::new(studio);
    let linear = hair
        .srgb()
        .map(|value| srgb_decode(f64::from(value) / 255.0));
    upsampler.even(upsampler.fit(linear))
}

#[cfg(test)]
mod tests {
    use maulstick_brush::{BrushFile, Head};
    use maulstick_model::brush::load::Half;
    use maulstick_model::brush::traits::BrushTraits;
    use maulstick_optics::PaintLibrary;

    use super::*;

    struct Bench {
        studio: Studio,
        head: Head,
        traits: BrushTraits,
        carried: Carried,
    }

    fn bench() -> Bench {
        let file = BrushFile::library("flat").expect("flat");
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::daylight();
        for name in ["Ultramarine Blue", "Hansa Yellow Opaque"] {
            studio.add(library.find(name).expect("known"));
        }
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, 2.5e-4, 1.0);
        let carried = Carried {
            load: Arc::new(BrushLoad::clean(head.strips())),
            hair: file.head.hair,
            film_m: f64::from(traits.film_cells_per_quantum) * 2.5e-4,
            film_full: traits.film_full,
            full_load: traits.full_load(head.strips()),
        };
        Bench {
            studio,
            head,
            traits,
            carried,
        }
    }

    /// Red, green, blue and film of a strip's first sample.
    fn sample(look: &BrushLook, strip: usize) -> [f32; 4] {
        let from = strip * SAMPLES * 8;
        [0, 1, 2, 3].map(|i| {
            let bytes = &look.samples[from + 2 * i..][..2];
            f16::from_le_bytes([bytes[0], bytes[1]]).to_f32()
        })
    }

    #[test]
    fn a_clean_brush_shows_its_hair() {
        let bench = bench();
        let under = hair(bench.carried.hair, &bench.studio);
        let own = bench
            .carried
            .hair
            .srgb()
            .map(|v| srgb_decode(f64::from(v) / 255.0) as f32);
        let clean = bench.carried.look(&bench.studio, &under);
        assert_eq!(clean.strips as usize, bench.head.strips());
        assert_eq!(clean.load_share, 0.0);
        for strip in 0..bench.head.strips() {
            let [red, green, blue, film] = sample(&clean, strip);
            assert_eq!(film, 0.0);
            for (seen, own) in [red, green, blue].into_iter().zip(own) {
                assert!(
                    (seen - own).abs() < 0.04,
                    "{seen} {own}: less the surface's gloss"
                );
            }
        }
    }

    #[test]
    fn a_brush_loaded_beside_shows_both_paints() {
        let mut bench = bench();
        let under = hair(bench.carried.hair, &bench.studio);
        let load = Arc::make_mut(&mut bench.carried.load);
        for (slot, half) in [(0, Half::Left), (1, Half::Right)] {
            let slots = [(slot, 1.0)];
            load.fill(&bench.head, &bench.traits, &slots, None, (half, 0));
        }
        let loaded = bench.carried.look(&bench.studio, &under);
        assert!(
            (0.8..=1.0).contains(&loaded.load_share),
            "{}",
            loaded.load_share
        );
        let side = |right: bool| {
            let roots = bench.head.roots().iter().enumerate();
            let far = roots.filter(|(_, root)| if right { root[0] > 0.5 } else { root[0] < -0.5 });
            far.map(|(strip, _)| sample(&loaded, strip))
                .collect::<Vec<_>>()
        };
        let (left, right) = (side(false), side(true));
        assert!(!left.is_empty() && !right.is_empty());
        // A load is uneven, but no bristle goes without.
        assert!(
            left.iter().all(|[r, _, b, film]| b > r && *film > 0.07),
            "{left:?}"
        );
        assert!(
            right.iter().all(|[r, _, b, film]| r > b && *film > 0.07),
            "{right:?}"
        );
        for side in [&left, &right] {
            let films = side.iter().map(|[_, _, _, film]| film);
            let mean = films.sum::<f32>() / side.len() as f32;
            assert!((0.6..1.5).contains(&mean), "{mean}");
        }
        assert!(
            !right.iter().any(|[r, _, b, _]| b > r),
            "a fault would pass"
        );
    }

    #[test]
    fn a_thin_film_is_between_hair_and_paint() {
        let mut bench = bench();
        let under = hair(bench.carried.hair, &bench.studio);
        let full = bench.traits.film_full;
        let thin = 8e-6 / (full * bench.carried.film_m);
        let mut red = |count: u32| {
            let mut load = BrushLoad::clean(bench.head.strips());
            (0..load.texels()).for_each(|texel| load.add_film(0, texel, count));
            load.count_films();
            bench.carried.load = Arc::new(load);
            sample(&bench.carried.look(&bench.studio, &under), 0)
        };
        let [bare, film, thick] = [0.0, thin, 1.0].map(|share| red((share * full) as u32));
        assert!(
            bare[0] > film[0] + 0.02 && film[0] > thick[0] + 0.02,
            "{bare:?} {film:?} {thick:?}"
        );
        assert!((thick[3] - 1.0).abs() < 0.01 && (f64::from(film[3]) - thin).abs() < 0.001);
    }

    #[test]
    fn a_changed_load_is_another() {
        let mut bench = bench();
        let before = bench.carried.clone();
        assert!(bench.carried.is(&before));
        Arc::make_mut(&mut bench.carried.load).add_film(0, 0, 1);
        assert!(!bench.carried.is(&before));
    }
}
