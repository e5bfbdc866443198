//! Touching and transfer, on the head as the device drew it: films are parted, blended and given back as on the processor.

use maulstick_canvas::quantum::SLOTS;
use maulstick_dab::device::probe::{Probe, Prober};
use maulstick_dab::dither::Dither;
use maulstick_dab::first_blend;
use maulstick_dab::raster::Raster;
use maulstick_dab::stroke::{Course, Stroker, Way, places};
use maulstick_model::footprint::drawn::Drawn;
use maulstick_model::interface::{Handling, Step, Sweep, Transfer};

use crate::device;
use crate::scene::{PAINTS, Scene, lying};

/// Share of the counts that may differ: where a sum that rounds otherwise decides whether a unit goes.
const FEW: f64 = 2e-4;

/// The device's drawing as the processor's; of the fixed footprint, whose strips do not move.
fn as_drawn(probe: &Probe) -> Drawn {
    let stride = probe.size[0].next_multiple_of(16);
    let cells = stride * probe.size[1];
    let mut drawn = Drawn::default();
    (drawn.origin, drawn.size, drawn.stride) = (probe.origin, probe.size, stride);
    for plane in [
        &mut drawn.cover,
        &mut drawn.height,
        &mut drawn.clearance,
        &mut drawn.travel,
    ] {
        plane.resize(cells, 0.0);
    }
    drawn.texel.resize(cells, Drawn::ABSENT);
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    for over in &probe.over {
        let place = over.at[1] * stride + over.at[0];
        drawn.cover[place] = over.cover;
        drawn.height[place] = over.height;
        drawn.clearance[place] = over.clearance;
        drawn.texel[place] = over.texel;
        low = [0, 1].map(|i| low[i].min(over.at[i]));
        high = [0, 1].map(|i| high[i].max(over.at[i] + 1));
    }
    drawn.reach = (low, high);
    drawn
}

/// Blends of the fixed footprint as the processor does them, the drawing's stages left out.
fn blend(probe: &Probe, step: &mut Step<'_>, seed: u64) {
    let mut raster = Raster::default();
    raster.drawn = as_drawn(probe);
    let way = Course::of(&step.sweep, None).way;
    let places: Vec<[i64; 2]> = places(way).collect();
    let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
    let each = Way::Cells(length / places.len() as f32);
    let slots: Vec<usize> = (0..SLOTS).filter(|slot| step.window.has(*slot)).collect();
    raster.lend(step.load, &step.traits, &slots, each);
    let to = step.sweep.to;
    step.sweep = Sweep {
        before: None,
        from: to,
        to,
    };
    let first = first_blend(step.load.steps());
    for (i, place) in places.into_iter().enumerate() {
        raster.blend(step, place, Dither::new(seed, first + i as u64));
    }
    if step.handling.transfer != Transfer::Sponge {
        raster.give_back(step.load);
    }
}

/// How many counts on cells and films of two scenes differ, of how many, and how many of a third one do.
fn apart(one: &Scene, two: &Scene) -> (usize, usize) {
    let (mut off, mut all) = (0, 0);
    for slot in 0..SLOTS {
        let planes = [one, two].map(|scene| scene.window.plane(slot).unwrap_or_default());
        let films = [one, two].map(|scene| scene.load.film_of(slot).unwrap_or_default());
        let cells = planes[0].iter().zip(planes[1]);
        let texels = films[0].iter().zip(films[1]);
        off += cells.filter(|(a, b)| a != b).count() + texels.filter(|(a, b)| a != b).count();
        all += planes[0].len() + films[0].len();
    }
    (off, all)
}

/// A way to use the brush.
#[derive(Clone, Copy)]
struct Mode {
    name: &'static str,
    handling: Handling,
    stain: f32,
    lasting: bool,
}

impl Mode {
    fn of(name: &'static str, handling: Handling) -> Self {
        Self {
            name,
            handling,
            stain: 0.0,
            lasting: false,
        }
    }

    fn scene(self, seed: u64) -> Scene {
        let mut scene = Scene::far(seed, 5.0);
        scene.handling = self.handling;
        // Nothing comes from inside the brush.
        scene.traits.refill = 0.0;
        // One more paint on the brush than on the canvas, and the other way about.
        (0..PAINTS + 2).for_each(|slot| {
            scene.window.plane_mut(slot);
        });
        scene
    }

    fn step(self, scene: &mut Scene) -> Step<'_> {
        let mut step = scene.step();
        (step.stain, step.lasting) = (self.stain, self.lasting);
        step
    }

    /// True if paint only changes places.
    fn keeps_counts(self) -> bool {
        self.handling.transfer != Transfer::Sponge && !self.lasting
    }
}

fn modes() -> [Mode; 6] {
    let painting = Handling::default();
    let with = |transfer| Handling {
        transfer,
        ..painting
    };
    let thin = Handling {
        most: 60_000.5,
        ..painting
    };
    [
        Mode::of("paint", painting),
        Mode {
            stain: 3000.0,
            ..Mode::of("stained", painting)
        },
        Mode::of("sponge", with(Transfer::Sponge)),
        Mode::of("marker", with(Transfer::Marker { flow: 0.002 })),
        Mode::of("thin", thin),
        Mode {
            lasting: true,
            ..Mode::of("lasting", painting)
        },
    ]
}

#[test]
fn paint_goes_both_ways_in_whole_units() {
    let mut prober = Prober::new(device(), Stroker::Faster).expect("taken");
    for mode in modes() {
        let name = mode.name;
        let (mut off, mut all, mut faulty, mut changed) = (0, 0, 0, 0);
        for seed in 0..6 {
            let mut on_gpu = mode.scene(seed);
            let counts = on_gpu.counts();
            let probe = prober.run(&mut mode.step(&mut on_gpu), "refill");
            let probe = probe.expect("done").expect("on the surface");
            lying(&on_gpu.window);
            if mode.keeps_counts() {
                assert_eq!(on_gpu.counts(), counts, "{name} {seed}");
            }
            let on_cpu = |by: u64| {
                let mut scene = mode.scene(seed);
                let thresholds = scene.load.seed() + by;
                blend(&probe, &mut mode.step(&mut scene), thresholds);
                scene
            };
            let (differ, of) = apart(&on_gpu, &on_cpu(0));
            (off, all) = (off + differ, all + of);
            faulty += apart(&on_gpu, &on_cpu(1)).0;
            changed += apart(&on_gpu, &mode.scene(seed)).0;
        }
        println!(
            "{name}: {off} of {all} counts differ, {changed} changed, by other thresholds {faulty}"
        );
        assert!(off as f64 <= FEW * all as f64, "{name}: {off} of {all}");
        assert!(
            changed > 2000 && faulty > 20 * off.max(5),
            "{name}: {faulty}, a fault passes"
        );
    }
}
