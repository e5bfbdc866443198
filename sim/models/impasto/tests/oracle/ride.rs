//! The ride of a bristle: no cell within reach is higher than the curve that rests on it.

use maulstick_canvas::relief::Relief;
use maulstick_canvas::relief::ride::{REACH_M, ride};
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::Window;

use crate::scene::{Random, window};

/// Tolerance: four roundings of a height of 32 cells.
const TOLERANCE: f64 = 4.0 * 32.0 / 16_777_216.0;

/// Heights in cells, rows of `width`, of cells of `cell_m`.
struct Ground {
    base: Vec<f32>,
    width: usize,
    cell_m: f64,
}

/// Tooth, and ridges and spots of dry paint of up to `most_m` on it.
fn ground(seed: u64, kind: &str, cell_m: f64, most_m: f64) -> Ground {
    let mut random = Random::new(seed);
    let tooth = Tooth::new(kind, seed, cell_m).expect(kind);
    let window = window(&Relief::new(tooth, cell_m));
    let (mut base, width) = (window.base().to_vec(), window.width());
    let rows = base.len() / width;
    for _ in 0..5 {
        let (x, y) = (random.below(width), random.below(rows));
        let wide = 1 + random.below(4);
        let dry = (most_m * random.unit() / cell_m) as f32;
        for row in y..(y + 20).min(rows) {
            base[row * width + x..row * width + (x + wide).min(width)]
                .iter_mut()
                .for_each(|base| *base = base.max(dry));
        }
    }
    Ground {
        base,
        width,
        cell_m,
    }
}

/// How a bristle hangs: radii of curvature of its length and of its free tip, and where that begins, m.
#[derive(Clone, Copy)]
struct Bend {
    radius_m: f64,
    free_m: f64,
    tip_radius_m: f64,
}

impl Bend {
    const HOG: Self = Self {
        radius_m: 28e-3,
        free_m: 4e-4,
        tip_radius_m: 1.5e-4,
    };

    /// How far it hangs below its support at a distance of `off_m`, m.
    fn at(self, off_m: f64) -> f64 {
        let of_length = off_m.powi(2) / self.radius_m;
        let of_tip = (off_m.abs() - self.free_m).max(0.0).powi(2) / self.tip_radius_m;
        0.5 * (of_length + of_tip)
    }
}

/// The highest curve at a cell, cells, over the cells within reach.
fn oracle(ground: &Ground, bend: Bend, [x, y]: [usize; 2]) -> f64 {
    let reach = (REACH_M / ground.cell_m).ceil() as i64;
    let rows = (ground.base.len() / ground.width) as i64;
    let mut highest = f64::MIN;
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let (i, j) = (x as i64 + dx, y as i64 + dy);
            if i < 0 || j < 0 || i >= ground.width as i64 || j >= rows {
                continue;
            }
            let base = ground.base[j as usize * ground.width + i as usize];
            let hang = [dx, dy].map(|d| bend.at(d as f64 * ground.cell_m) / ground.cell_m);
            highest = highest.max(f64::from(base) - hang[0] - hang[1]);
        }
    }
    highest
}

fn agrees(ground: &Ground, ride: &[f32], bend: Bend) -> bool {
    let width = ground.width;
    (0..ride.len()).all(|place| {
        let want = oracle(ground, bend, [place % width, place / width]);
        (f64::from(ride[place]) - want).abs() <= TOLERANCE
    })
}

fn ridden(ground: &Ground) -> Vec<f32> {
    ride(&ground.base, ground.width, 1.0 / ground.cell_m)
}

#[test]
fn a_bristle_lies_on_the_highest_curve() {
    let hog = Bend::HOG;
    let faults = [
        Bend {
            radius_m: 1.02 * hog.radius_m,
            ..hog
        },
        Bend {
            free_m: 1.02 * hog.free_m,
            ..hog
        },
        Bend {
            tip_radius_m: 1.02 * hog.tip_radius_m,
            ..hog
        },
    ];
    for (seed, kind) in (0..).zip(["linen", "cotton", "panel", "paper"]) {
        let cell_m = [1.25e-4, 2.5e-4][seed as usize % 2];
        let ground = ground(seed, kind, cell_m, 4e-3);
        let ride = ridden(&ground);
        assert!(agrees(&ground, &ride, hog), "{kind}");
        for fault in faults {
            assert!(!agrees(&ground, &ride, fault), "another bend passes");
        }
        assert!(!agrees(&ground, &ground.base, hog), "no ride passes");
    }
}

/// A stroke that leaves a ridge of dry paint has bare ground behind it for a millimetre at most.
#[test]
fn a_tip_is_on_the_ground_a_millimetre_from_a_cliff() {
    let (cell_m, cliff_m) = (6.25e-5, 7e-4);
    let mut base = vec![0.0; 64];
    base[..16].fill((cliff_m / cell_m) as f32);
    let ride = ride(&base, 64, 1.0 / cell_m);
    let hung = ride[16..].iter().take_while(|height| **height > 0.0);
    let hung_mm = 1e3 * cell_m * hung.count() as f64;
    assert!((0.6..=1.0).contains(&hung_mm), "{hung_mm} mm");
}

/// On flat ground the ride is the ground, also far above or below, and on less than a row.
#[test]
fn on_flat_ground_it_lies_on_the_ground() {
    for (height, width, cells) in [
        (0.0f32, 64, 4096),
        (-3.5, 64, 4096),
        (7.25, 5, 25),
        (1.0, 1, 9),
    ] {
        let base = vec![height; cells];
        assert_eq!(ride(&base, width, 4000.0), base);
    }
}

/// The ride is never below the ground or the deepest valley of the tooth, and is independent of the window.
#[test]
fn the_ride_is_the_same_in_every_window() {
    for kind in Tooth::names() {
        let relief = Relief::new(Tooth::new(kind, 5, 2.5e-4).expect(kind), 2.5e-4);
        let open = |from: [i64; 2], to: [i64; 2]| {
            let mut store = TileStore::new([320, 256]);
            let rect = store.around(from, to).expect("on the surface");
            Window::open(&mut store, rect, &relief).expect("free")
        };
        let all = open([0; 2], [320, 256]);
        let part = open([100, 70], [180, 100]);
        let (width, origin) = (all.width(), part.origin());
        assert!(part.width() < width && origin[0] > 0);
        let reach = maulstick_canvas::relief::ride::reach(2.5e-4) as i64;
        for y in 70 - reach..100 + reach {
            for x in 100 - reach..180 + reach {
                // The planes extend beyond by the reach.
                if !(64 + reach..192 - reach).contains(&x)
                    || !(64 + reach..128 - reach).contains(&y)
                {
                    continue;
                }
                let in_all = all.ride()[y as usize * width + x as usize];
                let at = [x - origin[0], y - origin[1]].map(|cell| cell as usize);
                assert_eq!(in_all, part.ride()[at[1] * part.width() + at[0]], "{x} {y}");
            }
        }
        assert_eq!(all.ride_below(), part.ride_below());
        let lower = all.ride().iter().zip(all.base());
        assert!(lower.clone().all(|(ride, base)| ride >= base));
        let deepest = lower.fold(0.0f32, |most, (ride, _)| most.max(-ride));
        assert!(
            deepest > 0.0 && deepest <= all.ride_below() + 1e-6,
            "{kind}"
        );
    }
}
