//! Levelling compared with Orchard's decay (1962) and the arrest of Smith, Orchard and Rhind-Tutt (1961), and its
//! invariants for any paint.

use std::f64::consts::PI;

use maulstick_canvas::quantum::{BySlot, QUANTUM_M, SLOTS};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::window::{Area, Window};
use maulstick_impasto::Impasto;
use maulstick_impasto::stages::advection::{Advection, Axis};
use maulstick_impasto::stages::levelling::{Body, Levelling, Round};
use maulstick_impasto::stages::velocity::Faces;
use maulstick_model::interface::{self, PaintModel as _};
use maulstick_model::rheology::Setting;
use maulstick_num::{cos, exp};

const CELL_M: f64 = 1.25e-4;
const SIZE: usize = 128;
/// Surface tension of linseed oil, N/m, and weight of paint, N/m³.
const TENSION: f64 = 0.03;
const WEIGHT: f64 = 1800.0 * 9.81;
/// Slope at which an edge advances onto bare ground.
const ADVANCES: f64 = 1.0;
/// Oil without a yield stress.
const OIL: Body = Body {
    yield_pa: 0.0,
    viscosity_pa_s: 20.0,
};

/// A film whose height by cell is in metres.
fn film(height_m: impl Fn(usize, usize) -> f64) -> Window {
    let mut store = TileStore::new([SIZE as u32; 2]);
    let all = store.around([0; 2], [SIZE as i64; 2]).expect("a surface");
    let mut window = Window::open(&mut store, all, &Relief::flat(CELL_M)).expect("free");
    let width = window.width();
    let plane = window.plane_mut(0);
    for y in 0..SIZE {
        for x in 0..SIZE {
            plane[y * width + x] = (height_m(x, y) / QUANTUM_M).round() as f32;
        }
    }
    window
}

/// A film with a ripple of `cells` cells along x.
fn rippled(mean_m: f64, ripple_m: f64, cells: usize) -> Window {
    film(|x, _| mean_m + ripple_m * cos(2.0 * PI * (x as f64 + 0.5) / cells as f64))
}

/// Height of all paint on a cell, m.
fn height(window: &Window, x: usize, y: usize) -> f64 {
    QUANTUM_M * f64::from(window.total(y * window.width() + x))
}

/// Amplitude of the ripple in the middle, m.
fn amplitude(window: &Window, cells: usize) -> f64 {
    let middle = (SIZE / 2 / cells) * cells;
    let wave = (middle - cells..middle + cells).map(|x| {
        let phase = 2.0 * PI * (x as f64 + 0.5) / cells as f64;
        height(window, x, SIZE / 2) * cos(phase)
    });
    wave.sum::<f64>() / cells as f64
}

/// Parameters of levelling.
#[derive(Clone, Copy)]
struct Rest {
    body: Body,
    seconds: f64,
    rounds: usize,
    /// Number of rounds of heights alone at a time.
    at_once: usize,
    thinner: Option<usize>,
    /// Share of a cell below which a block rests.
    rests: f32,
    /// Quanta at or below which a cell counts as bare.
    bare: f32,
    cell_m: f64,
}

impl Rest {
    fn new(body: Body, seconds: f64, rounds: usize) -> Self {
        Self {
            body,
            seconds,
            rounds,
            at_once: 1,
            thinner: None,
            rests: 0.0,
            bare: 0.0,
            cell_m: CELL_M,
        }
    }

    /// Levels a whole window.
    fn level(&self, window: &mut Window) {
        let area = Area {
            from: [0; 2],
            size: [SIZE; 2],
        };
        self.level_on(window, area);
    }

    fn level_on(&self, window: &mut Window, area: Area) {
        let to_cells = (QUANTUM_M / self.cell_m) as f32;
        let seconds = self.seconds / self.rounds as f64;
        let round = Round::new(self.body, self.cell_m, seconds, to_cells, self.bare);
        let (mut levelling, mut advection) = (Levelling::default(), Advection::default());
        for number in 0..self.rounds / self.at_once {
            let mut faces = Faces::still(&area);
            let planes = [&mut faces.right[..], &mut faces.above[..]];
            let rounds = (self.at_once as u32, self.rests);
            let most = levelling.add(window, &area, &round, &self.thinner.into(), rounds, planes);
            assert!((0.0..=0.25).contains(&most), "{most}");
            let all = faces.right.iter().chain(&faces.above);
            assert!(all.clone().all(|v| v.is_finite()));
            faces.limit(area.size[0]);
            let first = if number % 2 == 0 { Axis::X } else { Axis::Y };
            advection.run(area, &faces, window, first, self.bare);
        }
    }
}

/// Quanta of all paints, which must be whole and not negative.
fn quanta(window: &Window) -> u64 {
    let counts = window.planes().flat_map(|(_, plane)| plane);
    counts
        .map(|count| {
            assert!(*count >= 0.0 && count.fract() == 0.0, "{count}");
            *count as u64
        })
        .sum()
}

/// Share left of a ripple of a tenth of the film after 7/10 of its decay time, and Orchard's: γh³k⁴/3η, with the film's
/// weight beside its tension. The film is so thick that the flow of a round is many quanta.
fn decay(body: Body) -> [f64; 2] {
    let (mean, ripple, cells) = (2e-3, 200e-6, 16);
    let k = 2.0 * PI / (cells as f64 * CELL_M);
    let rate = (TENSION * k.powi(4) + WEIGHT * k * k) * mean * mean * mean / (3.0 * 20.0);
    let seconds = 0.7 / rate;
    let mut window = rippled(mean, ripple, cells);
    let before = quanta(&window);
    Rest::new(body, seconds, 2000).level(&mut window);
    assert_eq!(quanta(&window), before);
    [amplitude(&window, cells) / ripple, exp(-rate * seconds)]
}

#[test]
fn a_ripple_decays_as_orchard_has_it() {
    let [got, want] = decay(OIL);
    assert!((got / want - 1.0).abs() < 0.05, "{got} {want}");
    for factor in [0.85, 1.18] {
        let [got, want] = decay(Body {
            viscosity_pa_s: factor * OIL.viscosity_pa_s,
            ..OIL
        });
        let off = (got / want - 1.0).abs();
        assert!(off > 0.05, "{factor} of the viscosity passes: {off}");
    }
}

/// On fine cells the rounds of a second are too few for long waves, which coarser grids level.
#[test]
fn coarser_grids_level_what_fine_cells_cannot() {
    let (mean, ripple, cells) = (300e-6, 10e-6, 16);
    let exponent = 0.5;
    let left = |cell_m: f64| {
        let k = 2.0 * PI / (cells as f64 * cell_m);
        let rate = (TENSION * k.powi(4) + WEIGHT * k * k) * mean * mean * mean / (3.0 * 20.0);
        let mut window = rippled(mean, ripple, cells);
        let before = quanta(&window);
        let rest = Rest {
            at_once: 16,
            cell_m,
            ..Rest::new(OIL, exponent / rate, 64)
        };
        rest.level(&mut window);
        assert_eq!(quanta(&window), before);
        amplitude(&window, cells) / ripple
    };
    let (got, want) = (left(6.25e-5), exp(-exponent));
    assert!((got / want - 1.0).abs() < 0.1, "{got} {want}");
    // Twice these cells are larger than the coarsest grid.
    let alone = left(5.1e-4);
    assert!(alone > 0.9, "{alone}: without a coarser grid it passes");
}

#[test]
fn a_ripple_is_arrested_at_the_yield_stress() {
    let (mean, ripple) = (300e-6, 40e-6);
    for cells in [8, 3] {
        let left = |yield_pa: f64| {
            let body = Body {
                yield_pa,
                viscosity_pa_s: 1.0,
            };
            let mut window = rippled(mean, ripple, cells);
            Rest::new(body, 10.0, 3000).level(&mut window);
            amplitude(&window, cells)
        };
        let k = 2.0 * PI / (cells as f64 * CELL_M);
        let held = mean * (TENSION * k.powi(3) + WEIGHT * k);
        let yields = 10e-6 * held;
        let want = yields / held;
        let got = left(yields);
        assert!((got / want - 1.0).abs() < 0.3, "{cells}: {got} {want}");
        let softer = left(0.5 * yields);
        assert!(
            (softer / want - 1.0).abs() > 0.3,
            "{cells}: half the yield stress passes"
        );
        assert!(
            left(10.0 * yields) > 0.99 * ripple,
            "{cells}: what yields at ten times as much stands"
        );
    }
}

/// A wide sheet on a level film beside a ripple: blocks at rest skip negligible flow, and wake when their neighbours'
/// flow arrives.
#[test]
fn what_rests_changes_nothing() {
    let levelled = |rests: f32| {
        let mut window = film(|x, _| match x {
            // What flows from it reaches the next block of 16 columns.
            18..28 => 600e-6,
            80.. => 200e-6 + 30e-6 * f64::from(x as u32 / 3 % 2),
            _ => 200e-6,
        });
        let rest = Rest {
            at_once: 20,
            rests,
            ..Rest::new(OIL, 6.0, 400)
        };
        rest.level(&mut window);
        (0..SIZE)
            .map(|x| height(&window, x, 64))
            .collect::<Vec<_>>()
    };
    let all = levelled(0.0);
    let off = |rests: f32| {
        let pairs = levelled(rests).into_iter().zip(&all);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (fine, coarse) = (off(1e-5), off(0.2));
    assert!(fine < 1e-6, "{fine}");
    assert!(coarse > 1e-6, "a film that hardly levels passes: {coarse}");
}

/// Heights alone go through many rounds, with the same result as if paint had followed in each.
#[test]
fn paint_may_follow_later() {
    let levelled = |rounds: usize, at_once: usize| {
        let mut window = film(|x, y| {
            let [across, up] = [x as f64 / 3.0, y as f64 / 4.0].map(cos);
            500e-6 + 60e-6 * across + 40e-6 * up
        });
        let before = quanta(&window);
        // Twice these cells are larger than the coarsest grid.
        let rest = Rest {
            at_once,
            cell_m: 5.1e-4,
            ..Rest::new(OIL, 0.02 * rounds as f64, rounds)
        };
        rest.level(&mut window);
        assert_eq!(quanta(&window), before);
        let cells = (0..SIZE * SIZE).map(|cell| height(&window, cell % SIZE, cell / SIZE));
        cells.collect::<Vec<_>>()
    };
    let each = levelled(64, 1);
    let off = |other: &[f64]| {
        let squares = each.iter().zip(other).map(|(a, b)| (a - b) * (a - b));
        (squares.sum::<f64>() / each.len() as f64).sqrt()
    };
    let (later, shorter) = (off(&levelled(64, 16)), off(&levelled(48, 16)));
    println!(
        "later: {:.2} µm, a quarter less: {:.2} µm",
        1e6 * later,
        1e6 * shorter
    );
    assert!(later < 2e-6 && later < 0.5 * shorter, "{later} {shorter}");
}

/// An isolated heap: none is lost, also at an edge of the levelled area.
#[test]
fn nothing_is_created_or_lost() {
    let areas = [
        ([0, 0], [SIZE, SIZE]),
        ([60, 60], [9, 7]),
        ([0, 127], [128, 1]),
        ([66, 0], [2, 99]),
    ];
    for (from, size) in areas {
        let mut window = film(|x, y| match (x.abs_diff(66), y.abs_diff(66)) {
            (0, 0) => 900e-6,
            _ => 100e-6 + 20e-6 * ((x * 7 + y * 13) % 5) as f64,
        });
        let before = quanta(&window);
        let outside = |window: &Window| -> Vec<f64> {
            let cells = (0..SIZE * SIZE).map(|cell| [cell % SIZE, cell / SIZE]);
            let out =
                cells.filter(|at| (0..2).any(|i| at[i] < from[i] || at[i] >= from[i] + size[i]));
            out.map(|[x, y]| height(window, x, y)).collect()
        };
        let beside = outside(&window);
        let start = height(&window, 66, 66);
        Rest::new(OIL, 2.0, 40).level_on(&mut window, Area { from, size });
        assert_eq!(quanta(&window), before, "{from:?} {size:?}");
        assert!(outside(&window) == beside, "what is beside the area moves");
        assert_eq!(
            from[1] + size[1] > 66 && from[1] <= 66,
            height(&window, 66, 66) < start
        );
    }
}

/// A film that ends: bare ground beside it stays bare below the slope at which an edge advances, and is wetted above
/// it.
#[test]
fn an_edge_advances_only_down_a_steep_slope() {
    for (slope, bare) in [(0.95, true), (1.1, false)] {
        let edge = slope * ADVANCES * CELL_M;
        let mut window = film(|x, y| {
            let inside = (40..90).contains(&x) && (40..90).contains(&y);
            if inside { edge } else { 0.0 }
        });
        Rest::new(OIL, 5e-3, 1).level(&mut window);
        let beside = (0..SIZE * SIZE).map(|cell| [cell % SIZE, cell / SIZE]);
        let mut beside = beside.filter(|at| at.iter().any(|i| !(40..90).contains(i)));
        let wet = beside.any(|[x, y]| height(&window, x, y) > 0.0);
        assert_eq!(!wet, bare, "a slope of {slope}");
        // A stain is bare ground, and stays unchanged.
        let stain = 2000.0;
        let mut window = film(|x, _| if x < 64 { edge } else { stain * QUANTUM_M });
        let rest = Rest {
            bare: 2013.0,
            ..Rest::new(OIL, 5e-3, 1)
        };
        rest.level(&mut window);
        let kept = height(&window, 64, 64) == stain * QUANTUM_M;
        assert_eq!(kept, bare, "a slope of {slope}");
    }
}

/// Thinned paint yields sooner and is more fluid: more thinner leaves less of a ripple, and one half removes the yield
/// stress.
#[test]
fn thinned_paint_levels_further() {
    let (mean, ripple, cells) = (300e-6, 20e-6, 8);
    let left = |share: f64, body: Body| {
        let mut window = rippled(mean, ripple, cells);
        let counts = window.plane(0).expect("paint").to_vec();
        for (thin, count) in window.plane_mut(1).iter_mut().zip(&counts) {
            *thin = (f64::from(*count) * share).floor() as f32;
        }
        let thin = window.plane(1).expect("thinner").to_vec();
        for (count, thin) in window.plane_mut(0).iter_mut().zip(&thin) {
            *count -= thin;
        }
        let (before, start) = (quanta(&window), amplitude(&window, cells));
        let rest = Rest {
            thinner: Some(1),
            ..Rest::new(body, 1e-3, 400)
        };
        rest.level(&mut window);
        assert_eq!(quanta(&window), before);
        amplitude(&window, cells) / start
    };
    let body = Body {
        yield_pa: 80.0,
        viscosity_pa_s: 20.0,
    };
    let shares = [0.0, 0.2, 0.4, 0.6, 0.8].map(|share| left(share, body));
    assert_eq!(shares[0], 1.0, "paint from the tube stands");
    let flows = |pair: &[f64]| pair[1] <= pair[0];
    assert!(
        shares.windows(2).all(flows) && shares[4] < 0.5,
        "{shares:?}"
    );
    let stiff = Body {
        yield_pa: 1e6,
        ..body
    };
    assert_eq!(left(0.4, stiff), 1.0);
    let (yields, never) = (
        left(0.6, stiff),
        left(
            0.6,
            Body {
                yield_pa: 0.0,
                ..body
            },
        ),
    );
    assert!((yields - never).abs() < 0.01, "{yields} {never}");
}

/// Yield stresses and viscosities of 0 and of 10⁶: all is finite, nothing is lost, and paint that cannot flow does not.
#[test]
fn extreme_bodies_stay_finite() {
    for yield_pa in [0.0, 80.0, 1e6] {
        for viscosity_pa_s in [0.0, 20.0, 1e6] {
            for seconds in [0.0, 1e-3, 1e3] {
                let mut window = film(|x, y| match (x * 31 + y * 17) % 11 {
                    0 => 2e-3,
                    1..4 => 0.0,
                    n => 40e-6 * n as f64,
                });
                let (before, planes) = (quanta(&window), window.plane(0).expect("paint").to_vec());
                let body = Body {
                    yield_pa,
                    viscosity_pa_s,
                };
                Rest::new(body, seconds, 4).level(&mut window);
                assert_eq!(quanta(&window), before, "{body:?}");
                let still = window.plane(0) == Some(&planes);
                let stands = seconds == 0.0 || yield_pa == 1e6;
                assert!(still || !stands, "{body:?} in {seconds} s flows");
                assert!(!still || stands || viscosity_pa_s == 1e6, "{body:?} stands");
            }
        }
    }
}

/// Paints that yield at nothing and at 10⁵ Pa, at once and after a day: all is finite, and no quantum is lost.
#[test]
fn extreme_settings_stay_finite() {
    for rest_pa in [0.0, 1e5] {
        for recovers_s in [0.0, 86_400.0] {
            let mut window = rippled(300e-6, 40e-6, 8);
            let (before, start) = (quanta(&window), amplitude(&window, 8));
            let own = Setting {
                rest_pa,
                recovers_s,
            };
            Impasto::default().rest(&mut interface::Rest {
                window: &mut window,
                area: Area {
                    from: [0; 2],
                    size: [SIZE; 2],
                },
                cell_m: CELL_M,
                stain: 0.0,
                thinner: None,
                settings: BySlot::from([own; SLOTS]),
            });
            assert_eq!(quanta(&window), before, "{own:?}");
            let left = amplitude(&window, 8) / start;
            assert!(left.is_finite(), "{own:?}");
            assert_eq!(
                left > 0.99,
                rest_pa > 0.0 && recovers_s == 0.0,
                "{own:?}: {left}"
            );
        }
    }
}
