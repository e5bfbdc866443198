//! Stage 2: half the brush's motion, and −c·∇p by central differences.

use std::collections::BTreeMap;

use maulstick_paint::impasto::footprint::Footprint;
use maulstick_paint::impasto::velocity::{FOLLOWS, SQUISH, STABLE, velocity};

use crate::scene::Scene;

/// Five operations on numbers of at most a few cells, each rounded to 2⁻²⁴ of its result.
const TOLERANCE: f64 = 2e-6;

fn oracle(footprint: &Footprint) -> Vec<[f64; 2]> {
    let [width, height] = footprint.size.map(|cells| cells as i64);
    let place = |local: u32| (i64::from(local) % width, i64::from(local) / width);
    let pressed: BTreeMap<(i64, i64), f64> = footprint
        .contacts
        .iter()
        .map(|c| (place(c.local), f64::from(c.depth) * f64::from(c.cover)))
        .collect();
    let p = |x: i64, y: i64| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        pressed
            .get(&(x, y))
            .filter(|_| inside)
            .copied()
            .unwrap_or(0.0)
    };
    let velocity = |c: &maulstick_paint::impasto::footprint::Contact| {
        let (x, y) = place(c.local);
        let gradient = [
            (p(x + 1, y) - p(x - 1, y)) / 2.0,
            (p(x, y + 1) - p(x, y - 1)) / 2.0,
        ];
        let wet = f64::from(c.depth) / f64::from(c.fraction).max(1e-30);
        let c_of_squish = f64::from(SQUISH).min(f64::from(STABLE) / wet.max(1e-6));
        [0, 1].map(|i| {
            let brush = f64::from(FOLLOWS) * f64::from(c.cover) * f64::from(c.moved[i]);
            (brush - c_of_squish * gradient[i]).clamp(-1.0, 1.0)
        })
    };
    footprint.contacts.iter().map(velocity).collect()
}

fn agrees(footprint: &Footprint, oracle: &[[f64; 2]]) -> bool {
    let mut pairs = footprint.contacts.iter().zip(oracle);
    pairs.all(|(c, want)| (0..2).all(|i| (f64::from(c.velocity[i]) - want[i]).abs() <= TOLERANCE))
}

#[test]
fn paint_goes_half_as_far_as_the_brush_and_out_of_its_way() {
    let (mut clamped, mut squished) = (0, 0);
    for seed in 0..24 {
        let mut scene = Scene::new(seed);
        let mut footprint = Footprint::default();
        footprint.find(&mut scene.step());
        if seed % 2 == 0 {
            // Faster than steps are, so that the clamp is seen at work.
            for contact in &mut footprint.contacts {
                contact.moved = contact.moved.map(|cells| 3.0 * cells);
            }
        }
        velocity(&mut footprint);
        let want = oracle(&footprint);
        assert!(agrees(&footprint, &want), "scene {seed}");
        for (c, v) in footprint.contacts.iter().zip(&want) {
            clamped += usize::from(v[0].abs() == 1.0);
            let follows = 0.5 * f64::from(c.cover) * f64::from(c.moved[0]);
            squished += usize::from((v[0] - follows).abs() > 1e-3);
        }
        let at = footprint.contacts.len() / 2;
        let fault = 10.0 * TOLERANCE as f32;
        footprint.contacts[at].velocity[1] += fault;
        assert!(!agrees(&footprint, &want), "a fault in scene {seed} passes");
    }
    assert!(clamped > 20 && squished > 1000, "{clamped} {squished}");
}
