//! The head over the cells of the grid, compared with the processor's drawing.

use maulstick_dab::device::probe::{Over, Probe, Prober};
use maulstick_dab::stroke::Stroker;
use maulstick_model::footprint::drawn::Drawn;
use maulstick_model::footprint::lying::Lying;
use maulstick_model::interface::{Step, Sweep};

use crate::crumpled::crumpled;
use crate::device;
use crate::scene::Scene;

/// Tolerance of positions and scores: roundings of a place below 128 cells, and of scores to 2⁻¹⁸ of their range.
const PLACE_TOLERANCE: f32 = 2e-4;

/// The processor's drawing of the head in the middle of a step, on the grid of the step's bounds, with all paint raised
/// by `higher` cells.
fn drawn(step: &mut Step<'_>, higher: f32) -> Drawn {
    let mut drawn = Drawn::default();
    let (from, to) = step.bounds;
    let canvas = step.window.area(from, to);
    let top = Lying::default().weigh(canvas, step);
    let low = top + higher + step.traits.sink * step.sweep.to.press + step.window.ride_below();
    let size = [0, 1].map(|i| (to[i] - from[i]) as usize);
    drawn.draw(step, from, size, low);
    drawn
}

/// Number of cells of a probe's grid with another part of the head over them, and number with any.
fn apart(drawn: &Drawn, probe: &Probe, travel: impl Fn(&Over) -> f32) -> (usize, usize) {
    let near = |a: f32, b: f32| (a - b).abs() <= PLACE_TOLERANCE;
    let alike = probe.over.iter().filter(|over| {
        // The device's grid is a part of this one.
        let [x, y] = [0, 1].map(|i| over.at[i] + (probe.origin[i] - drawn.origin[i]) as usize);
        let place = y * drawn.stride + x;
        over.texel == drawn.texel[place]
            && near(over.cover, drawn.cover[place])
            && near(over.height, drawn.height[place])
            && near(over.clearance, drawn.clearance[place])
            && near(travel(over), drawn.travel[place] * drawn.cover[place])
    });
    let covered = drawn.texel.iter().filter(|texel| **texel != Drawn::ABSENT);
    let (alike, covered) = (alike.count(), covered.count());
    (probe.over.len() + covered - 2 * alike, covered)
}

/// Takes the paint off brush and canvas: only low parts of the head are drawn there.
fn strip_bare(scene: &mut Scene) {
    scene.load.take_all();
    let planes = scene.window.planes_mut();
    planes.for_each(|(_, plane)| plane.fill(0.0));
}

/// Makes the step one of less than a cell in which the head keeps its shape: one that bends is drawn anew in each part.
fn move_rigidly(scene: &mut Scene) {
    let (from, to) = (&mut scene.from, &scene.to);
    from.z.clone_from(&to.z);
    for (from, to) in [(&mut from.x, &to.x), (&mut from.y, &to.y)] {
        let along = (to[0] - from[0]).clamp(-0.7, 0.7);
        from.clone_from(to);
        from.iter_mut().for_each(|at| *at -= along);
    }
    from.press = to.press;
}

/// Number of drawn cells outside the surface.
fn outside(scene: &Scene, probe: &Probe) -> usize {
    let limit = scene.window.limit().map(|cells| cells as i64);
    let outside = |over: &&Over| {
        (0..2).any(|i| !(0..limit[i]).contains(&(probe.origin[i] + over.at[i] as i64)))
    };
    probe.over.iter().filter(outside).count()
}

/// The share that a cell transfers follows from its path.
fn check_shares(scene: &Scene, probe: &Probe, seed: usize) {
    let exchanging = scene.traits.exchanging;
    let wrong = probe.over.iter().filter(|over| {
        let own = exchanging.share(over.way / over.cover) * over.cover;
        (own - over.rate).abs() > 1e-6
    });
    assert_eq!(wrong.count(), 0, "scene {seed}");
}

/// A seeded fault: the head twice the tolerance too high.
fn raised(probe: &Probe) -> Probe {
    let mut raised = probe.clone();
    for over in &mut raised.over {
        over.clearance += 2.0 * PLACE_TOLERANCE;
    }
    raised
}

#[test]
fn the_head_is_over_the_same_cells() {
    let mut prober = Prober::new(device(), Stroker::Better).expect("taken");
    // A step of about a cell has one drawing.
    let strips = (0..12).map(Scene::new);
    let (mut all, mut beside, mut higher) = (0, 0, 0);
    for (seed, mut scene) in strips.chain((0..4).map(crumpled)).enumerate() {
        if seed % 2 == 1 {
            strip_bare(&mut scene);
        }
        move_rigidly(&mut scene);
        let want = drawn(&mut scene.step(), 0.0);
        let probe = prober.run(&mut scene.step(), "draw_cells");
        let probe = probe.expect("done").expect("on the surface");
        let reference = scene.traits.cell_per_reference;
        let travel = |over: &Over| over.way / reference;
        let (off, covered) = apart(&want, &probe, travel);
        println!("scene {seed}: {off} of {covered} cells differ");
        all += covered;
        beside += outside(&scene, &probe);
        // Where two segments are equally deep, rounding decides; places in faces seen edge on are inexact.
        let few = if scene.head.skin().is_some() { 20 } else { 400 };
        assert!(off * few <= covered, "scene {seed}: {off} of {covered}");
        check_shares(&scene, &probe, seed);
        let raised = apart(&want, &raised(&probe), travel).0;
        assert!(raised * few > covered, "a fault passes");
        let cut_higher = drawn(&mut scene.step(), 0.5);
        higher += usize::from(apart(&cut_higher, &probe, travel).0 * few > covered);
        let (off, _) = apart(&want, &probe, |over| over.way);
        assert!(
            reference == 1.0 || off * few > covered,
            "another way passes"
        );
    }
    assert!(all > 3000 && beside > 30, "{all} {beside}");
    assert!(
        higher >= 6,
        "a head cut too high passes in all but {higher} scenes"
    );
}

/// A resting head has no motion of its own: all cells have the path of the step.
#[test]
fn a_fixed_footprint_goes_along_the_way_of_its_anchor() {
    let mut prober = Prober::new(device(), Stroker::Faster).expect("taken");
    let mut scene = Scene::far(3, 6.0);
    let want = {
        let rests = scene.to.clone();
        let mut step = scene.step();
        step.sweep = Sweep {
            before: None,
            from: &rests,
            to: &rests,
        };
        drawn(&mut step, 0.0)
    };
    let probe = prober.run(&mut scene.step(), "draw_cells");
    let probe = probe.expect("done").expect("on the surface");
    let (off, covered) = apart(&want, &probe, |_| 0.0);
    assert!(off * 400 <= covered && covered > 100, "{off} of {covered}");
    let each = |over: &Over| over.way / over.cover;
    let first = each(&probe.over[0]);
    assert!(first > 0.5 && first < 1.1, "{first}");
    assert!(
        probe
            .over
            .iter()
            .all(|over| (each(over) - first).abs() < 1e-5)
    );
}
