//! Whole strokes in thick paint: compared with the processor's, with too little memory, and after a loss of the device.

use maulstick_gpu::{Choice, Device};
use maulstick_model::interface::PaintModel;
use maulstick_painting::edits::{Fill, FillPaint};
use maulstick_painting::{Painting, Sequencer};
use maulstick_stokes::flow::Effort;
use maulstick_stokes::grid::Grid;
use maulstick_stokes_paint::StokesPaint;
use maulstick_stokes_paint::device::{GpuBrushFlow, GpuFlow, Tuning};
use maulstick_types::paint::Decision;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::FilmThickness;

use crate::device;
use crate::easel::{all, apart, easel_of, lifted, mixture, paint, stroke, volume};
use crate::strokes;

/// Tolerance of the backends' difference: mean and 99th percentile of ΔE00.
const COLOURS: [f64; 2] = [0.02, 0.3];
/// Tolerance of the backends' difference of volume, as a share: where rounding decides about the fall of a speck, later
/// steps differ.
const VOLUME: f64 = 1e-3;

/// A thick wet film, and a loaded brush.
fn thick(model: Option<Box<dyn PaintModel>>) -> Painting {
    let mut painting = easel_of(("stokes", 1), model);
    painting
        .apply(Fill {
            paint: FillPaint::Mixture {
                mixture: mixture("Titanium White=0.7,Yellow Ochre=0.3"),
            },
            thickness: FilmThickness::new(400e-6).expect("in range"),
            surface: CANVAS,
        })
        .expect("laid");
    painting
}

fn easel(gpu: Option<Device>) -> Painting {
    thick(gpu.map(|gpu| {
        let make = maulstick_stokes_paint::ENTRY.make_on.expect("there is one");
        make(gpu, Choice::Forced).expect("taken").model
    }))
}

fn tuned(tuning: &Tuning) -> Painting {
    let flow = GpuBrushFlow::tuned(device(), Choice::Forced, tuning).expect("made");
    thick(Some(Box::new(StokesPaint::on(Box::new(flow)))))
}

fn agree(cpu: &mut Painting, gpu: &mut Painting, before: u64) -> bool {
    let (volume, colours) = apart(cpu, gpu, before);
    volume <= VOLUME && colours[0] <= COLOURS[0] && colours[1] <= COLOURS[1]
}

/// Quanta of each paint by cell of the canvas.
fn lying(painting: &mut Painting) -> Vec<f32> {
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store.iter().filter_map(|(_, version)| version.tile.clone());
    let planes = tiles.map(|tile| {
        let wet = tile.wet();
        let plane = |slot| {
            wet.iter()
                .find(|(at, _)| *at == slot)
                .map(|(_, plane)| plane.to_vec())
        };
        [0, 1, 2]
            .map(|slot| plane(slot).unwrap_or_else(|| vec![0.0; 64 * 64]))
            .concat()
    });
    planes.flatten().collect()
}

/// Paint at other places after a few steps of a stroke than in the processor's painting, as a share of the moved paint.
fn elsewhere(gpu: &mut Painting) -> f64 {
    let mut cpu = easel(None);
    let before = lying(&mut cpu);
    // With the fifth state rounding decides about the fall of a speck.
    let few = &stroke(1, 0.0, 24)[..4];
    paint(&mut cpu, "main", few);
    paint(gpu, "main", few);
    let sum = |one: &[f32], two: &[f32]| {
        let pairs = one.iter().zip(two);
        pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
    };
    let (want, got) = (lying(&mut cpu), lying(gpu));
    assert_eq!((want.len(), got.len()), (before.len(), before.len()));
    assert_eq!(gpu.report().quanta_missing, 0);
    sum(&want, &got) / sum(&want, &before)
}

/// Tolerance as a share of the moved paint.
const ELSEWHERE: f64 = 1e-4;

#[test]
fn the_first_steps_leave_the_paint_where_the_processor_does() {
    let off = elsewhere(&mut easel(Some(device())));
    println!("{off:.1e}");
    for fault in ["fault_link", "fault_slope"] {
        let off = elsewhere(&mut tuned(&Tuning {
            fault: Some((fault, 1.01)),
            ..Tuning::default()
        }));
        println!("{fault}: {off:.1e}");
        assert!(off > ELSEWHERE, "a fault passes: {off:e}");
    }
    assert!(off < ELSEWHERE, "{off:e}");
}

/// The first `states` of 24 states of two strokes that are `shift` mm higher, the second one across what the first has left.
fn strokes_of(painting: &mut Painting, states: usize, shift: f64) {
    paint(painting, "main", &stroke(1, shift, 24)[..states]);
    paint(painting, "main", &stroke(2, 1.5 + shift, 24)[..states]);
}

/// Paints the first `states` of the strokes on both backends; what the processor painted, and the volume before.
fn painted_the_same(states: usize) -> (Painting, u64) {
    let (mut cpu, mut gpu) = (easel(None), easel(Some(device())));
    let before = volume(&mut cpu);
    assert_eq!(volume(&mut gpu), before);
    strokes_of(&mut cpu, states, 0.0);
    strokes_of(&mut gpu, states, 0.0);
    assert!(gpu.backend().starts_with("gpu "), "{}", gpu.backend());
    assert!(agree(&mut cpu, &mut gpu, before));
    assert_eq!(gpu.report().quanta_missing, 0);
    let (cells, same) = (gpu.work().1 as f64, cpu.work().1 as f64);
    assert!((cells / same - 1.0).abs() < 0.01, "{cells} {same}");
    // A stroke a fifth of a cell beside it is another one.
    let mut beside = easel(None);
    strokes_of(&mut beside, states, 0.05);
    assert!(!agree(&mut beside, &mut gpu, before), "a fault passes");
    (cpu, before)
}

#[test]
fn both_backends_paint_the_same_strokes() {
    painted_the_same(12);
}

/// A weight that is wrong by a hundredth shows in whole strokes too.
#[test]
#[ignore = "long: whole strokes"]
fn both_backends_paint_the_same_whole_strokes() {
    let (mut cpu, before) = painted_the_same(24);
    let mut faulty = tuned(&Tuning {
        fault: Some(("fault_link", 1.01)),
        ..Tuning::default()
    });
    strokes_of(&mut faulty, 24, 0.0);
    assert!(!agree(&mut cpu, &mut faulty, before), "a fault passes");
    assert_eq!(faulty.report().quanta_missing, 0);
}

#[test]
fn the_same_stroke_has_the_same_bytes() {
    strokes::have_the_same_bytes(&easel, 12);
}

#[test]
fn the_books_balance() {
    strokes::balance_the_books(&easel, 8);
}

#[test]
fn a_lost_device_loses_no_paint() {
    strokes::outlive_their_device(&easel, &agree, 15);
}

/// Two strokes with `most_bytes` of memory for a window: the decisions, the backend, and the painting.
fn limited(most_bytes: u64) -> (Vec<Decision>, Painting) {
    let tuning = Tuning {
        most_bytes,
        ..Tuning::default()
    };
    let mut sequencer = Sequencer::new(tuned(&tuning));
    for number in 1..=2 {
        let mut states = stroke(number, 0.0, 24);
        states.truncate(4);
        states.push(lifted());
        for (seq, state) in states.iter().enumerate() {
            let header = strokes::header(100 * number + seq as u64);
            sequencer.state("main", &header, state).1.expect("it fits");
        }
    }
    assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
    let decided = strokes::decisions(&mut sequencer);
    (decided, sequencer.into_painting())
}

#[test]
fn too_little_memory_makes_cells_coarser_and_that_is_said_once() {
    let bytes = |cells| GpuFlow::window_bytes(&Grid::walled(cells), Effort::default());
    let (decided, mut whole) = limited(u64::MAX);
    assert_eq!(decided, []);
    let before = volume(&mut easel(None));
    let (decided, mut coarse) = limited(bytes([14, 14, 8]).expect("it has an index"));
    println!("{decided:?}");
    assert!(
        matches!(&decided[..], [Decision::CoarserFlow { .. }]),
        "{decided:?}"
    );
    let backend = coarse.backend();
    assert!(
        backend.starts_with("gpu ") && backend != whole.backend(),
        "{backend}"
    );
    let (off, colours) = apart(&mut whole, &mut coarse, before);
    assert!(off < 0.05 && colours[0] < 1.0, "{off} {colours:?}");
    assert!(all(&mut whole) != all(&mut coarse));
    // Where not even the coarsest cells fit, the processor continues.
    let (decided, mut none) = limited(bytes([1; 3]).expect("it has an index"));
    println!("{decided:?}");
    assert_eq!(none.backend(), "cpu");
    assert!(
        matches!(&decided[..], [Decision::Fallback { .. }]),
        "{decided:?}"
    );
    assert!(agree(&mut whole, &mut none, before));
}
