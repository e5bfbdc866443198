//! Scenes with a skin.

use maulstick_brush::head::STATIONS;
use maulstick_brush::{BrushFile, Head};
use maulstick_model::brush::traits::BrushTraits;

use crate::scene::{CELL_M, Random, Scene};

/// A scene whose strips all hang high, over which the fude's skin is crumpled.
pub(crate) fn crumpled(seed: u64) -> Scene {
    let mut scene = Scene::new(seed);
    let mut random = Random::new(seed + 100);
    let mut file = BrushFile::library("fude").expect("fude");
    file.strips.count = scene.head.strips();
    scene.head = Head::of(&file);
    scene.traits.recede = BrushTraits::of(&file, CELL_M, 1.0).recede;
    let places = scene.head.skin().expect("a skin").places().to_vec();
    let turn = random.range(0.0, 6.0);
    for (pose, shift) in [(&mut scene.to, [0.0; 2]), (&mut scene.from, [-0.4, 0.3])] {
        pose.z = vec![1e3; file.strips.count * STATIONS];
        for [around, along] in &places {
            let angle = f64::from(*around) * 2.0 * std::f64::consts::PI + turn;
            let (sine, cosine) = maulstick_num::sin_cos(angle);
            let wide = 14.0 * (1.0 - 0.6 * f64::from(*along));
            let x = 50.0 + wide * cosine + 30.0 * f64::from(*along) + shift[0];
            let z = 1.5 + 2.0 * sine + random.range(-0.2, 0.2);
            pose.skin.x.push(x as f32);
            pose.skin.y.push((45.0 + wide * sine + shift[1]) as f32);
            pose.skin.z.push(z.max(0.0) as f32);
        }
    }
    scene
}
