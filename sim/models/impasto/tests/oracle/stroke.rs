//! Whole strokes of whole steps, without a painting around them.

use maulstick_brush::{BrushFile, Head, HeadPose};
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::relief::ride::reach;
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::store::{TileRect, TileStore};
use maulstick_canvas::window::Window;
use maulstick_impasto::Impasto;
use maulstick_impasto::stages::advection::STAIN;
use maulstick_model::brush::head::{Waypoint, low_bounds};
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Handling, PaintModel, Step, StepReport, Sweep};
use maulstick_model::path::PathStepper;
use maulstick_num::geometry::{Rigid, rotation};
use maulstick_types::brush::Solve;

use crate::scene::{CELL_M, brush};

const SIDE: u32 = 256;
const SCALE: Scale = Scale {
    cell_m: CELL_M,
    zoom: 1.0,
};

/// A loaded brush on a surface.
struct Bench {
    store: TileStore,
    relief: Relief,
    file: BrushFile,
    head: Head,
    load: BrushLoad,
    traits: BrushTraits,
    model: Impasto,
    versions: u64,
}

/// Extent of a window.
#[derive(Clone, Copy, PartialEq)]
enum Windows {
    Whole,
    /// The tiles that a step needs, with those that carry its bristles.
    Narrow,
}

impl Bench {
    /// A brush on a uniform surface without tooth.
    fn new() -> Self {
        Self::on(Relief::flat(CELL_M))
    }

    fn on(relief: Relief) -> Self {
        let file = brush(96, 0.25);
        let head = Head::of(&file);
        let traits = BrushTraits::of(&file, CELL_M, 1.0);
        let mut load = BrushLoad::clean(head.strips());
        load.fill(&head, &traits, &[(0, 0.7), (3, 0.3)], None, (Half::Both, 0));
        Self {
            store: TileStore::new([SIDE; 2]),
            relief,
            file,
            head,
            load,
            traits,
            model: Impasto::default(),
            versions: 0,
        }
    }

    fn window(&mut self, from: [i64; 2], to: [i64; 2]) -> Window {
        let rect: TileRect = self.store.around(from, to).expect("on the surface");
        Window::open(&mut self.store, rect, &self.relief).expect("free")
    }

    /// One step in its own window.
    fn step(&mut self, sweep: Sweep<'_>, windows: Windows) -> StepReport {
        let height = self.load.thickest() as f32 * self.traits.film_cells_per_quantum
            + self.traits.sink
            + self.relief.depth_m() as f32 * self.relief.cells_per_m()
            + 2.0;
        let Some(bounds) = low_bounds(&self.head, sweep.to, &self.traits, height) else {
            return StepReport::default();
        };
        let (from, to) = match windows {
            Windows::Whole => ([0; 2], [i64::from(SIDE); 2]),
            Windows::Narrow => {
                let ride = reach(CELL_M) as i64;
                (bounds.0.map(|i| i - ride), bounds.1.map(|i| i + ride))
            }
        };
        let mut window = self.window(from, to);
        let report = self.model.step(&mut Step {
            window: &mut window,
            head: &self.head,
            sweep,
            bounds,
            load: &mut self.load,
            traits: self.traits,
            handling: Handling::default(),
            stain: STAIN,
            lasting: false,
            thinner: None,
        });
        window.commit(&mut self.store, &mut self.versions, |_, _| {});
        window.close(&mut self.store);
        report
    }

    fn stroke(&mut self, way: &[HeadPose], windows: Windows) {
        for pair in way.windows(2) {
            let [from, to] = pair else { continue };
            self.step(sweep(from, to), windows);
        }
    }

    fn counts(&self) -> Counts {
        let mut counts = self.store.counts();
        add(&mut counts, &self.load.counts());
        counts
    }

    /// All paint by cell of the surface, row after row.
    fn films(&mut self) -> Vec<f64> {
        let window = self.window([0; 2], [i64::from(SIDE); 2]);
        let cells = (SIDE * SIDE) as usize;
        let films = (0..cells)
            .map(|cell| f64::from(window.total(cell)))
            .collect();
        window.close(&mut self.store);
        films
    }
}

fn sweep<'a>(from: &'a HeadPose, to: &'a HeadPose) -> Sweep<'a> {
    Sweep {
        before: None,
        from,
        to,
    }
}

/// An arc from left to right that crosses tile borders both ways, turning under rising pressure.
fn arc(bench: &Bench) -> Vec<HeadPose> {
    let waypoint = |i: usize| {
        let t = i as f64 / 40.0;
        let turned = Rigid {
            rotation: rotation(glam::DVec3::Z, 0.8 * t),
            translation: glam::DVec3::new(
                0.013 + 0.018 * t,
                0.02 + 0.01 * maulstick_num::sin(2.5 * t),
                (0.85 - 0.3 * t) * bench.file.length_m(),
            ),
        };
        let joints = bench.file.spines.all_joints();
        Waypoint::of(
            &Solve {
                event_ns: 0,
                stroke: 1,
                surface: 0,
                flags: 0,
                pose: turned.to_pose(),
                zoom: 1.0,
                angles_rad: vec![[0.1, 0.25]; joints],
                contacts: Vec::new(),
            },
            SCALE,
            1.0,
        )
    };
    let mut path = PathStepper::begin(&bench.head, waypoint(0), SCALE);
    let mut way = Vec::new();
    for i in 1..=40 {
        path.advance(&bench.head, (waypoint(i), 0), |sweep, _| {
            way.push(sweep.to.clone());
        });
    }
    way.iter_mut().for_each(exact);
    way
}

/// Rounds places to odd multiples of 2⁻¹¹ cell: a shift by whole cells or a reflection of the surface does not round
/// them again, and none lies on the border or in the middle of a cell.
fn exact(pose: &mut HeadPose) {
    for place in pose.x.iter_mut().chain(&mut pose.y) {
        *place = ((*place * 1024.0).floor() + 0.5) / 1024.0;
    }
}

fn shifted(way: &[HeadPose], by: f32) -> Vec<HeadPose> {
    let shift = |pose: &HeadPose| HeadPose {
        x: pose.x.iter().map(|x| x + by).collect(),
        y: pose.y.iter().map(|y| y + by).collect(),
        ..pose.clone()
    };
    way.iter().map(shift).collect()
}

fn mirrored(way: &[HeadPose]) -> Vec<HeadPose> {
    let mirror = |pose: &HeadPose| HeadPose {
        x: pose.x.iter().map(|x| SIDE as f32 - x).collect(),
        ..pose.clone()
    };
    way.iter().map(mirror).collect()
}

/// The picture with each cell at the place that `to` gives.
fn moved(films: &[f64], to: impl Fn(usize, usize) -> Option<(usize, usize)>) -> Vec<f64> {
    let side = SIDE as usize;
    let mut out = vec![0.0; films.len()];
    for (cell, film) in films.iter().enumerate() {
        if let Some((x, y)) = to(cell % side, cell / side) {
            out[y * side + x] = *film;
        }
    }
    out
}

/// Difference of two pictures' volume, as a share, and the 95th percentile of the difference of painted cells, as a
/// share of the mean film. Where two strips are equally deep, rounding decides between them, and the picture differs
/// over a few cells.
fn difference(one: &[f64], two: &[f64]) -> [f64; 2] {
    let volume = one.iter().sum::<f64>();
    let pairs = one.iter().zip(two).filter(|(a, b)| **a + **b > 0.0);
    let mut apart: Vec<f64> = pairs.map(|(a, b)| (a - b).abs()).collect();
    apart.sort_by(f64::total_cmp);
    let mean = volume / apart.len() as f64;
    let off = (two.iter().sum::<f64>() - volume).abs();
    [off / volume, apart[apart.len() * 95 / 100] / mean]
}

fn agrees(apart: [f64; 2]) -> bool {
    apart.iter().all(|share| *share <= ROUNDED)
}

fn painted(change: impl Fn(&[HeadPose]) -> Vec<HeadPose>, windows: Windows) -> Vec<f64> {
    painted_on(Bench::new(), change, windows)
}

fn painted_on(
    mut bench: Bench,
    change: impl Fn(&[HeadPose]) -> Vec<HeadPose>,
    windows: Windows,
) -> Vec<f64> {
    let before = bench.counts();
    let way = change(&arc(&bench));
    bench.stroke(&way, windows);
    assert_eq!(bench.counts(), before, "on the tiles and on the brush");
    bench.films()
}

/// The part of the stroke with a lightly pressed head. Where paint lies some cells thick, −c·∇p amplifies small
/// differences.
fn light(way: &[HeadPose]) -> Vec<HeadPose> {
    way[..60].to_vec()
}

/// There and back, so that much paint is taken up and pushed.
fn back_again(way: &[HeadPose]) -> Vec<HeadPose> {
    way.iter().chain(way.iter().rev()).cloned().collect()
}

/// Steps in windows of only the tiles that they need, written back each time, paint to the quantum like steps in one
/// window on the whole surface: also on tooth, on which bristles ride from peak to peak, where other windows have other
/// valleys.
#[test]
fn borders_of_windows_do_not_show() {
    for kind in [None, Some("linen"), Some("paper")] {
        let relief = || match kind {
            Some(kind) => Relief::new(Tooth::new(kind, 3, CELL_M).expect(kind), CELL_M),
            None => Relief::flat(CELL_M),
        };
        let painted = |way: fn(&[HeadPose]) -> Vec<HeadPose>, windows| {
            painted_on(Bench::on(relief()), way, windows)
        };
        let one = painted(back_again, Windows::Whole);
        assert!(one.iter().filter(|film| **film > 0.0).count() > 2000);
        let narrow = painted(back_again, Windows::Narrow);
        let apart = one.iter().zip(&narrow).filter(|(a, b)| a != b).count();
        assert_eq!(apart, 0, "{kind:?}");
        let shorter = painted(|way| back_again(&way[1..]), Windows::Narrow);
        assert_ne!(one, shorter, "a shorter stroke passes");
    }
}

/// Only the ends of clipped strips are rounded anew, by 2⁻¹⁷ cell: ten steps' errors in a row.
const ROUNDED: f64 = 10.0 / 131_072.0;

#[test]
fn borders_of_tiles_do_not_show() {
    let by =
        |cells: usize, off: f32| move |way: &[HeadPose]| shifted(&light(way), cells as f32 + off);
    let place = |x: usize, y: usize| {
        let side = SIDE as usize;
        (x + 13 < side && y + 13 < side).then_some((x + 13, y + 13))
    };
    let want = moved(&painted(light, Windows::Narrow), place);
    let apart = difference(&want, &painted(by(13, 0.0), Windows::Narrow));
    println!("shifted: {apart:?}");
    assert!(agrees(apart), "{apart:?}");
    let fault = difference(
        &want,
        &painted(by(13, 10.0 * ROUNDED as f32), Windows::Narrow),
    );
    println!("seeded: {fault:?}");
    assert!(!agrees(fault), "a stroke beside its place passes");
}

#[test]
fn a_mirrored_stroke_is_the_mirrored_picture() {
    // Short, because rounding decides about contact where a film just bridges its gap.
    let short = |way: &[HeadPose]| way[..12].to_vec();
    let one = painted(short, Windows::Whole);
    let want = moved(&one, |x, y| Some((SIDE as usize - 1 - x, y)));
    let got = painted(|way| mirrored(&short(way)), Windows::Whole);
    let apart = difference(&want, &got);
    println!("mirrored: {apart:?}");
    assert!(agrees(apart), "{apart:?}");
    assert!(
        !agrees(difference(&one, &got)),
        "the picture is its own mirror image"
    );
}

/// A head that touches nothing, because it hovers or is beside the surface.
#[test]
fn a_step_without_contact_changes_nothing() {
    let mut bench = Bench::new();
    let way = arc(&bench);
    bench.stroke(&way, Windows::Whole);
    let (films, load, counts) = (bench.films(), bench.load.clone(), bench.counts());
    let versions = bench.versions;
    let lifted = |pose: &HeadPose| HeadPose {
        z: pose.z.iter().map(|z| z + 20.0).collect(),
        ..pose.clone()
    };
    let beside = |pose: &HeadPose| HeadPose {
        x: pose.x.iter().map(|x| x + 2.0 * SIDE as f32).collect(),
        ..pose.clone()
    };
    for away in [lifted, beside] {
        let mut window = bench.window([0; 2], [i64::from(SIDE); 2]);
        for pair in way.windows(2) {
            let (from, to) = (away(&pair[0]), away(&pair[1]));
            let report = bench.model.step(&mut Step {
                window: &mut window,
                head: &bench.head,
                sweep: Sweep {
                    before: None,
                    from: &from,
                    to: &to,
                },
                bounds: ([-64; 2], [1024; 2]),
                load: &mut bench.load,
                traits: bench.traits,
                handling: Handling::default(),
                stain: STAIN,
                lasting: false,
                thinner: None,
            });
            assert_eq!(report, StepReport::default());
        }
        window.commit(&mut bench.store, &mut bench.versions, |_, _| {});
        window.close(&mut bench.store);
    }
    assert_eq!((bench.versions, bench.counts()), (versions, counts));
    assert_eq!((bench.films(), bench.load), (films, load));
}

/// A brush without paint leaves none on a bare surface, but touches it.
#[test]
fn an_empty_brush_leaves_nothing() {
    let mut bench = Bench::new();
    bench.load.take_all();
    let way = arc(&bench);
    let mut touched = 0;
    for pair in way.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        touched += bench.step(sweep(from, to), Windows::Narrow).footprint_cells;
    }
    assert!(touched > 0);
    assert_eq!(bench.counts(), [0; SLOTS]);
}
