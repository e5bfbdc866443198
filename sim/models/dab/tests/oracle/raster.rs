//! § 4.5.1, 4.5.3: films are distributed over the cells of their texels, and return to their texels.

use std::collections::BTreeMap;

use maulstick_dab::dither::Dither;
use maulstick_dab::raster::Raster;
use maulstick_dab::stroke::{Stroker, Way};
use maulstick_model::footprint::drawn::Drawn;

use crate::scene::Bench;

/// Quanta of a paint on each texel, from its cells.
fn back(texels: &[u32], plane: &[f32]) -> BTreeMap<u32, i64> {
    let mut sums = BTreeMap::new();
    for (texel, quanta) in texels.iter().zip(plane) {
        if *texel != Drawn::ABSENT {
            *sums.entry(*texel).or_default() += *quanta as i64;
        }
    }
    sums
}

#[test]
fn films_are_parted_among_the_cells_that_they_cover() {
    let mut bench = Bench::new(Stroker::Better);
    let poses = [[99.0, 100.0], [100.0, 100.0]].map(|place| bench.pose(place));
    let mut raster = Raster::default();
    bench.with_step(&poses, |step| {
        raster.drawn.draw(step, [60, 60], [80, 80], 4.0);
        raster.lend(step.load, &step.traits, &[0, 3, 7], Way::OfStrips);
        let drawn = &raster.drawn;
        let large = 1.0 / (16_777_216.0 * f64::from(step.traits.film_units_per_quantum));
        let cells = back(&drawn.texel, &vec![1.0; drawn.texel.len()]);
        let many = cells
            .values()
            .filter(|cells| **cells as f64 > large)
            .count();
        assert!(many > 10 && cells.len() > 100, "{many} {}", cells.len());
        for slot in [0, 3, 7] {
            let plane = raster.film(slot).expect("lent");
            let film = step.load.film_of(slot);
            // Number of cells with the expected share under this measure.
            let as_by = |measure: fn(f64, f64) -> f64| {
                let held = |texel: u32| film.map_or(0.0, |film| f64::from(film[texel as usize]));
                let own = drawn.texel.iter().zip(plane).filter(|(texel, quanta)| {
                    let want = match cells.get(texel) {
                        Some(cells) => (held(**texel) / measure(large, *cells as f64)).floor(),
                        None => 0.0,
                    };
                    f64::from(**quanta) == want
                });
                own.count() == plane.len()
            };
            assert!(as_by(f64::max));
            if slot != 7 {
                assert!(!as_by(|large, _| large), "more than there is passes");
                assert!(!as_by(|_, cells| cells), "thicker films pass");
            }
        }
        let before = step.load.clone();
        assert_eq!(raster.give_back(step.load), [0; 64]);
        assert!(*step.load == before);
    });
}

#[test]
fn what_cells_got_goes_to_the_texels_over_them() {
    let mut bench = Bench::new(Stroker::Better);
    bench.fill(7, 60_000.0);
    let poses = [[99.0, 100.0], [100.0, 100.0]].map(|place| bench.pose(place));
    let mut raster = Raster::default();
    bench.with_step(&poses, |step| {
        raster.drawn.draw(step, [60, 60], [80, 80], 4.0);
        raster.lend(step.load, &step.traits, &[0, 3, 7], Way::OfStrips);
        let before = step.load.clone();
        let lent = [0, 3, 7].map(|slot| raster.film(slot).expect("lent").to_vec());
        for shift in [[-3, 2], [0, 0]] {
            let met = raster.blend(step, shift, Dither::new(4, 9));
            assert!(met.cells > 100 && met.wet > 0);
        }
        let texels = raster.drawn.texel.clone();
        let now = [0, 3, 7].map(|slot| raster.film(slot).expect("lent").to_vec());
        raster.give_back(step.load);
        let mut moved = texels.clone();
        moved.rotate_left(1);
        for (i, slot) in [0, 3, 7].into_iter().enumerate() {
            let as_by = |texels: &[u32]| {
                let [was, is] = [&lent[i], &now[i]].map(|plane| back(texels, plane));
                let film = |load: &maulstick_model::brush::load::BrushLoad, texel: u32| {
                    load.film_of(slot)
                        .map_or(0, |film| i64::from(film[texel as usize]))
                };
                is.iter().all(|(texel, is)| {
                    film(step.load, *texel) == film(&before, *texel) + is - was[texel]
                })
            };
            assert!(lent[i] != now[i] && as_by(&texels), "paint {slot}");
            assert!(!as_by(&moved), "cells beside theirs pass");
        }
    });
}
