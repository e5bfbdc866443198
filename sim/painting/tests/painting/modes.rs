//! Handling of brushes and preparation of surfaces (Baxter 2004, § 6.4.1, 6.7, 6.8).

use maulstick_brush::BrushFile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::{Counts, QUANTUM_M, SLOTS};
use maulstick_canvas::sheet::{quanta, slot_of};
use maulstick_models::{MODELS, ModelEntry};
use maulstick_painting::edits::{Fill, FillPaint, Handle, Piles, Size};
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::Solve;
use maulstick_types::name_hash;
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE};
use maulstick_types::values::{BrushName, FilmThickness, StainThickness};

use crate::studio::{BRUSH, fill, load, painting, solve, state};

const BLUE: &str = "Ultramarine Blue";
const WHITE: &str = "Titanium White";
/// Cells of the canvas either way.
const SIDE: u32 = 128;

fn brush() -> BrushFile {
    let mut file = BrushFile::library("round").expect("round");
    file.strips.count = 64;
    file
}

struct Easel {
    painting: Painting,
    strokes: u64,
}

impl Easel {
    fn new() -> Self {
        Self::of(PaintingSetup {
            cells: [SIDE, SIDE],
            tooth: "panel".into(),
            ..PaintingSetup::default()
        })
    }

    fn of(setup: PaintingSetup) -> Self {
        let mut painting = painting(&setup);
        painting.define_brush(BRUSH, brush());
        Self {
            painting,
            strokes: 0,
        }
    }

    /// A brush that is used like this, on wet white.
    fn on_white(mode: BrushMode, um: f64) -> Self {
        let mut easel = Self::new();
        easel.painting.apply(fill(WHITE, um)).expect("laid");
        easel.use_as(mode, |_| {});
        easel
    }

    fn use_as(&mut self, mode: BrushMode, change: impl FnOnce(&mut BrushHandling)) {
        let mut handling = BrushHandling {
            mode,
            ..BrushHandling::normal(BRUSH)
        };
        change(&mut handling);
        self.painting
            .apply(Handle::try_from(&handling).expect("in range"))
            .expect("known");
    }

    fn load(&mut self, text: &str) {
        self.painting.apply(load(text)).expect("loaded");
    }

    /// From left to right over the middle of the canvas, or of another place of a surface, mm.
    fn stroke(&mut self, surface: u32, [x, y]: [f64; 2]) {
        self.strokes += 1;
        let file = brush();
        let solves = (0..=60).map(|i| Solve {
            surface,
            ..solve(
                &file,
                self.strokes,
                [x + 0.2 * f64::from(i), y],
                0.6,
                [0.2, 0.1],
            )
        });
        let state = state(solves);
        self.painting.state(BRUSH, 1, &state).expect("it fits");
    }

    fn middle(&mut self) {
        self.stroke(CANVAS, [8.0, 12.0]);
    }

    /// Quanta by slot on a surface, after the windows are written back; the books must balance.
    fn on(&mut self, surface: u32) -> Counts {
        let report = self.painting.report();
        assert_eq!(report.quanta_missing, 0);
        self.painting.store(surface).expect("a surface").counts()
    }

    fn account(&mut self, name: &str) -> f64 {
        self.painting.report().accounts_m3[name]
    }

    /// Wet thickness of the canvas's cells, m.
    fn films(&mut self) -> Vec<f64> {
        self.painting.commit();
        let store = self.painting.store(CANVAS).expect("the canvas");
        let tiles = store.iter().filter_map(|(_, version)| version.tile.clone());
        let sums = tiles.flat_map(|tile| {
            let wet = tile.wet();
            (0..64 * 64)
                .map(|cell| {
                    wet.iter()
                        .map(|(_, plane)| f64::from(plane[cell]))
                        .sum::<f64>()
                })
                .collect::<Vec<f64>>()
        });
        sums.map(|quanta| quanta * QUANTUM_M).collect()
    }

    fn carried(&self) -> f32 {
        self.painting.fullness(name_hash(BRUSH))
    }
}

fn total(counts: &Counts) -> u64 {
    counts.iter().sum()
}

#[test]
fn a_normal_brush_gives_what_the_canvas_gains() {
    let mut easel = Easel::new();
    easel.load(BLUE);
    let (full, loaded) = (easel.carried(), easel.account("brush"));
    easel.middle();
    assert!(total(&easel.on(CANVAS)) > 0 && easel.carried() < full);
    assert!(easel.account("brush") < loaded);
    assert_eq!(easel.account("mode"), 0.0);
}

#[test]
fn a_full_sponge_never_runs_out_and_an_empty_one_never_fills() {
    let mut easel = Easel::new();
    easel.load(BLUE);
    easel.use_as(BrushMode::Sponge, |_| {});
    let (loaded, mut laid) = (easel.account("brush"), Vec::new());
    for at in [[8.0, 12.0], [8.0, 22.0], [8.0, 4.0]] {
        let before = total(&easel.on(CANVAS));
        easel.stroke(CANVAS, at);
        assert!(total(&easel.on(CANVAS)) > before);
        laid.push(total(&easel.on(CANVAS)) - before);
    }
    // On fresh ground it gives as at first; the last two lie in part beside the canvas or on paint.
    let least = laid.iter().copied().fold(u64::MAX, u64::min);
    assert!(2 * least > laid[0], "{laid:?}");
    assert_eq!(easel.account("brush"), loaded);
    assert!(easel.account("mode") < 0.0, "the mode gave");
    let mut easel = Easel::on_white(BrushMode::Sponge, 100.0);
    let before = total(&easel.on(CANVAS));
    easel.middle();
    assert!(total(&easel.on(CANVAS)) < before && easel.account("brush") == 0.0);
    assert!(easel.account("mode") > 0.0, "the mode took");
}

#[test]
fn without_push_paint_stays_where_nothing_takes_it_up() {
    let spread = |mode: BrushMode| {
        let mut easel = Easel::on_white(mode, 60.0);
        easel.middle();
        easel.on(CANVAS);
        let films = easel.films();
        films.iter().copied().fold(0.0, f64::max)
    };
    let laid = 60e-6 + 1e-8;
    assert!(
        spread(BrushMode::Normal) > 1.1 * laid,
        "a ridge is pushed up"
    );
    assert!(spread(BrushMode::Sponge) > 1.1 * laid);
    assert!(spread(BrushMode::SpongeNoPush) <= laid);
    // A brush that is not a sponge deposits its load, but no ridge.
    assert!(spread(BrushMode::NoPush) < 0.8 * spread(BrushMode::Normal));
}

#[test]
fn a_marker_lays_by_its_flow_and_takes_nothing_up() {
    let laid = |flow: f64| {
        let mut easel = Easel::on_white(BrushMode::Normal, 20.0);
        easel.load(BLUE);
        easel.use_as(BrushMode::Marker, |handling| handling.flow = flow);
        let before = easel.on(CANVAS);
        easel.middle();
        let after = easel.on(CANVAS);
        let slot = (0..SLOTS).find(|slot| before[*slot] > 0).expect("white");
        assert_eq!(after[slot], before[slot], "white stays where it lay");
        (total(&after) - total(&before)) as f64
    };
    let (thin, thick) = (laid(1e-4), laid(4e-4));
    assert!((3.5..4.5).contains(&(thick / thin)), "{thin} {thick}");
}

#[test]
fn a_sampler_takes_the_colour_and_leaves_the_canvas_as_it_is() {
    let mut easel = Easel::on_white(BrushMode::Normal, 50.0);
    easel.load(BLUE);
    easel.use_as(BrushMode::Sampler, |_| {});
    let before = (easel.on(CANVAS), easel.films());
    let blue = easel.painting.report().paints_m3[BLUE]["brush"];
    easel.middle();
    assert_eq!((easel.on(CANVAS), easel.films()), before);
    let report = easel.painting.report();
    assert!(report.paints_m3[WHITE]["brush"] > 0.0, "white came onto it");
    assert!(
        report.paints_m3[BLUE]["brush"] < blue,
        "in the place of blue"
    );
}

#[test]
fn the_vacuum_lifts_paint_and_leaves_the_brush_clean() {
    let mut easel = Easel::on_white(BrushMode::Normal, 50.0);
    easel.load(BLUE);
    easel.middle();
    easel.use_as(BrushMode::Vacuum, |_| {});
    let (before, cleaner) = (total(&easel.on(CANVAS)), easel.account("cleaner"));
    easel.middle();
    assert!(total(&easel.on(CANVAS)) < before);
    assert_eq!(easel.account("brush"), 0.0);
    assert!(easel.account("cleaner") > cleaner);
    let bare = easel.films().iter().filter(|film| **film == 0.0).count();
    assert!(bare > 200, "{bare} cells of the stroke are bare");
    // Nothing lies on top of nothing.
    let store = easel.painting.store(CANVAS).expect("the canvas");
    for wet in store
        .iter()
        .filter_map(|(_, version)| Some(version.tile.as_ref()?.wet()))
    {
        let is_bare = |cell: &usize| wet.iter().all(|(_, plane)| plane[*cell] == 0.0);
        let bare: Vec<usize> = (0..TILE_CELLS).filter(is_bare).collect();
        for own in wet.own().iter().filter(|own| slot_of(own.shape).is_some()) {
            let upper: Vec<f32> = quanta(&own.bytes).collect();
            assert!(bare.iter().all(|cell| upper[*cell] == 0.0));
        }
    }
}

#[test]
fn a_brush_adds_no_more_than_its_most() {
    let thickest = |most_m: f64| {
        let mut easel = Easel::new();
        easel.load(BLUE);
        easel.use_as(BrushMode::NoPush, |handling| handling.most_m = most_m);
        easel.middle();
        easel.on(CANVAS);
        easel.films().into_iter().fold(0.0, f64::max)
    };
    // The same again in hollows.
    assert!(thickest(5e-6) <= 2.0 * 5e-6 + 2e-9);
    assert!(thickest(0.0) > 6e-6, "without a bound it is thicker");
}

#[test]
fn a_bound_film_gathers_in_hollows_and_is_none_on_the_palette() {
    let bound = |most_m: f64| {
        let mut easel = Easel::new();
        easel.load(BLUE);
        easel.use_as(BrushMode::NoPush, |handling| handling.most_m = most_m);
        easel
    };
    let mut easel = bound(5e-6);
    easel.middle();
    let deep = easel.films().into_iter().filter(|film| *film > 5e-6 + 2e-9);
    assert!(deep.count() > 20, "the tooth has hollows");
    let mixed = |most_m: f64| {
        let mut easel = bound(most_m);
        easel.stroke(PALETTE, [8.0, 12.0]);
        total(&easel.on(PALETTE))
    };
    assert!(mixed(5e-6) > 0);
    assert_eq!(mixed(5e-6), mixed(0.0));
}

#[test]
fn a_fill_with_the_brush_has_its_colour_and_costs_it_nothing() {
    let mut easel = Easel::new();
    assert!(
        easel
            .painting
            .apply(Fill {
                paint: FillPaint::Carried {
                    brush: BrushName::new(BRUSH).expect("valid")
                },
                thickness: FilmThickness::new(2e-5).expect("in range"),
                surface: CANVAS
            })
            .is_err()
    );
    easel.load("Ultramarine Blue=0.25,Titanium White=0.75");
    let loaded = easel.account("brush");
    easel
        .painting
        .apply(Fill {
            paint: FillPaint::Carried {
                brush: BrushName::new(BRUSH).expect("valid"),
            },
            thickness: FilmThickness::new(2e-5).expect("in range"),
            surface: CANVAS,
        })
        .expect("filled");
    assert_eq!(easel.account("brush"), loaded);
    let counts = easel.on(CANVAS);
    let [blue, white] = [counts[0].min(counts[1]), counts[0].max(counts[1])];
    let share = blue as f64 / (blue + white) as f64;
    assert!((share - 0.25).abs() < 1e-3, "{share}");
    assert!(easel.account("mode") < 0.0);
    easel.painting.undo(None).expect("a step");
    assert_eq!(total(&easel.on(CANVAS)), 0);
    assert_eq!(easel.account("mode"), 0.0);
}

#[test]
fn a_sized_canvas_is_brushed_bare_and_another_keeps_a_stain() {
    let ridge = |stain_m: f64| {
        let mut easel = Easel::on_white(BrushMode::SpongeNoPush, 30.0);
        easel.use_as(BrushMode::Normal, |_| {});
        easel
            .painting
            .apply(Size {
                stain: StainThickness::new(stain_m).expect("in range"),
                surface: CANVAS,
            })
            .expect("sized");
        easel.middle();
        easel.on(CANVAS);
        easel.films().into_iter().fold(0.0, f64::max)
    };
    let (sized, absorbent) = (ridge(0.0), ridge(2.9e-5));
    assert!(sized > 1.2 * absorbent, "{sized:e} {absorbent:e}");
    assert!(absorbent < 4e-5, "{absorbent:e}");
}

#[test]
fn piles_deplete_or_last_as_the_painter_says() {
    let taken = |last: bool| {
        let mut easel = Easel::new();
        easel
            .painting
            .apply(Fill {
                surface: PALETTE,
                ..fill(WHITE, 300.0)
            })
            .expect("laid");
        easel
            .painting
            .apply(Piles {
                last,
                surface: PALETTE,
            })
            .expect("the palette");
        let before = total(&easel.on(PALETTE));
        easel.stroke(PALETTE, [60.0, 100.0]);
        let after = total(&easel.on(PALETTE));
        let left = (before as f64 - after as f64) / before as f64;
        (left, easel.account("brush"), easel.account("mode"))
    };
    let (left, carried, mode) = taken(false);
    assert!(
        left > 1e-4 && carried > 0.0 && mode == 0.0,
        "{left:e} {carried:e} {mode:e}"
    );
    let (left, carried, mode) = taken(true);
    assert!(
        left < 1e-6 && left > -1e-2 && carried > 0.0,
        "{left:e} {carried:e}"
    );
    // A mixture there grows by the brush's deposit, and never shrinks.
    assert!(
        -mode >= 0.999 * carried && -mode < 1.2 * carried,
        "{mode:e} {carried:e}"
    );
}

/// Stirred in a pile, a brush is filled through and through, and not its films alone.
#[test]
fn the_palette_fills_the_reservoir() {
    // A load fills films and inside in their proportions.
    let load = brush().load;
    let mut easel = Easel::new();
    easel.load(WHITE);
    let films = easel.account("brush") * load.film_um / (load.film_um + load.inside_um);
    let films = films / f64::from(easel.carried());
    let inside = |surface: u32, at: [f64; 2]| {
        let mut easel = Easel::new();
        easel
            .painting
            .apply(Fill {
                surface,
                ..fill(WHITE, 500.0)
            })
            .expect("laid");
        easel.stroke(surface, at);
        easel.account("brush") - films * f64::from(easel.carried())
    };
    let (palette, canvas) = (inside(PALETTE, [60.0, 100.0]), inside(CANVAS, [8.0, 12.0]));
    assert!(palette > 3.0 * canvas, "{palette:e} {canvas:e}");
}

#[test]
fn thinned_paint_clings_in_thinner_films() {
    let loaded = |text: &str| {
        let mut easel = Easel::new();
        easel.load(text);
        easel.carried()
    };
    let (paint, thin) = (loaded(BLUE), loaded("Ultramarine Blue=0.3,Thinner=0.7"));
    assert!(thin < 0.6 * paint, "{thin} {paint}");
    let mut easel = Easel::new();
    easel.load("Thinner");
    easel.middle();
    assert!(total(&easel.on(CANVAS)) > 0, "thinner alone is a film too");
}

/// High paint elsewhere on the palette does not extend its jar.
#[test]
fn the_jar_cleans_a_brush_that_is_in_it() {
    let left = |from: [f64; 2]| {
        let mut easel = Easel::new();
        easel.load(BLUE);
        // Through a well, in which paint lies 2 mm high.
        easel.stroke(PALETTE, [107.0, 128.0]);
        let carried = easel.account("brush");
        easel.stroke(PALETTE, from);
        easel.account("brush") / carried
    };
    assert_eq!(left([86.0, 14.0]), 0.0, "in the jar");
    assert!(left([60.0, 40.0]) > 0.3, "beside it");
}

/// Surfaces of a few cells, narrower than a run of the kernels.
#[test]
fn narrow_surfaces_are_painted_on() {
    for cells in [[1, 1], [1, 40], [2, 40], [40, 1], [3, 3]] {
        let mut easel = Easel::of(PaintingSetup {
            cells,
            ..PaintingSetup::default()
        });
        easel.painting.apply(fill(WHITE, 100.0)).expect("laid");
        easel.load(BLUE);
        easel.stroke(CANVAS, [-4.0, 0.2]);
        assert!(total(&easel.on(CANVAS)) > 0);
    }
}

#[test]
fn what_lies_under_the_brush_has_the_viscosity_of_its_model() {
    let under = |model: &ModelEntry, text: &str| {
        let mut easel = Easel::of(PaintingSetup {
            model: model.name.to_owned(),
            ..PaintingSetup::default()
        });
        easel.painting.apply(fill(text, 100.0)).expect("laid");
        easel.middle();
        easel.painting.under_brush(name_hash(BRUSH))
    };
    for model in &MODELS {
        let tube = under(model, WHITE);
        assert!((5e-5..2e-4).contains(&tube.film_m), "{model:?}: {tube:?}");
        assert!(
            (1e-3..2e-2).contains(&tube.contact_m),
            "{model:?}: {tube:?}"
        );
        let thin = under(model, "Titanium White=0.5,Thinner=0.5");
        for (found, thinner) in [(tube, 0.0), (thin, 0.5)] {
            let own = model.rheology.thinned_m2_s(thinner);
            let off = (found.viscosity_m2_s / own - 1.0).abs();
            assert!(off < 0.05, "{model:?}: {found:?} instead of {own}");
        }
    }
    let [tube, thin] = [0.0, 0.5].map(|thinner| MODELS[0].rheology.thinned_m2_s(thinner));
    assert!(tube == 1e-2 && thin < 0.2 * tube, "{tube} {thin}");
}
