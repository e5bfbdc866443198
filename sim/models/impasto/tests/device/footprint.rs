//! Stage 1: the same cells are touched by the same places of the head.

use maulstick_impasto::device::probe::Prober;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;

use crate::crumpled::crumpled;
use crate::device;
use crate::scene::Scene;

/// Tolerance of positions and scores: roundings of a place below 128 cells, and of scores to 2⁻¹⁸ of their range.
const PLACE_TOLERANCE: f32 = 2e-4;

/// Number of cells touched by either with a different contact.
fn apart(one: &[Contact], two: &[Contact]) -> (usize, usize) {
    let same = |a: &Contact, b: &Contact| {
        let near = |a: f32, b: f32| (a - b).abs() <= PLACE_TOLERANCE;
        a.cell == b.cell
            && a.texel == b.texel
            && near(a.cover, b.cover)
            && near(a.depth, b.depth)
            && near(a.fraction, b.fraction)
            && near(a.gap, b.gap)
            && near(a.moved[0], b.moved[0])
            && near(a.moved[1], b.moved[1])
    };
    let alike = one
        .iter()
        .filter(|a| {
            let place = two.binary_search_by_key(&a.cell, |b| b.cell);
            place.is_ok_and(|place| same(a, &two[place]))
        })
        .count();
    (one.len() + two.len() - 2 * alike, one.len())
}

#[test]
fn the_same_cells_are_touched() {
    let mut prober = Prober::new(device()).expect("taken");
    // Paths of one cell, and of several.
    let strips = (0..12).map(Scene::new);
    let strips = strips.chain((12..20).map(|seed| Scene::far(seed, 4.0)));
    let mut touched = 0;
    for (seed, mut scene) in strips.chain((0..4).map(crumpled)).enumerate() {
        let mut footprint = Footprint::default();
        footprint.find(&mut scene.step());
        let probe = prober.run(&mut scene.step(), "footprint");
        let probe = probe.expect("done").expect("on the surface");
        let (off, all) = apart(&footprint.contacts, &probe.contacts);
        println!("scene {seed}: {off} of {all} contacts differ");
        touched += all;
        // Where two segments are equally deep, rounding decides; places in faces seen edge on are inexact.
        let few = if scene.head.skin().is_some() { 20 } else { 400 };
        assert!(off * few <= all, "scene {seed}: {off} of {all}");
        let mut faulty = probe.contacts.clone();
        faulty
            .iter_mut()
            .for_each(|contact| contact.depth += 2.0 * PLACE_TOLERANCE);
        let (off, _) = apart(&footprint.contacts, &faulty);
        assert!(off * few > all, "a fault passes");
    }
    assert!(touched > 1600, "{touched}");
}
