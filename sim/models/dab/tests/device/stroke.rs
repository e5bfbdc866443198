//! Whole strokes of all stroking algorithms, compared with the processor's.

use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_gpu::{Choice, Device};
use maulstick_model::interface::PaintModel;
use maulstick_painting::Painting;
use maulstick_painting::edits::{Clean, Dry};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;

use crate::device;
use crate::easel::{apart, easel_of, paint, stroke, volume};
use crate::strokes;

/// Tolerance of the backends' difference: mean and 99th percentile of ΔE00.
const COLOURS: [f64; 2] = [0.05, 0.5];
/// Tolerance of the backends' difference of volume, as a share.
const VOLUME: f64 = 2e-4;

fn stroking(stroker: Stroker, gpu: Option<Device>) -> Painting {
    let model: Box<dyn PaintModel> = match gpu {
        Some(gpu) => Box::new(maulstick_dab::device::stroking(gpu, stroker).expect("taken")),
        None => Box::new(Dab::stroking(stroker)),
    };
    easel_of(("dab", 1), Some(model))
}

fn easel(gpu: Option<Device>) -> Painting {
    let model = gpu.map(|gpu| {
        let make = maulstick_dab::ENTRY.make_on.expect("there is one");
        make(gpu, Choice::Forced).expect("taken").model
    });
    easel_of(("dab", 1), model)
}

fn agree(cpu: &mut Painting, gpu: &mut Painting, before: u64) -> bool {
    let (volume, colours) = apart(cpu, gpu, before);
    volume <= VOLUME && colours[0] <= COLOURS[0] && colours[1] <= COLOURS[1]
}

fn clean(painting: &mut Painting) {
    let brush = BrushName::main();
    painting.apply(Clean { brush }).expect("known");
}

/// A loaded brush on dry paint.
#[test]
fn both_backends_paint_the_same_on_dry_paint() {
    for stroker in [Stroker::Faster, Stroker::Better] {
        let painted = |shift: f64, gpu: Option<Device>| {
            let mut painting = stroking(stroker, gpu);
            painting.apply(Dry::whole(CANVAS)).expect("dried");
            let before = volume(&mut painting);
            paint(&mut painting, "main", &stroke(1, shift, 48));
            (painting, before)
        };
        let ((mut cpu, before), (mut gpu, _)) = (painted(0.0, None), painted(0.0, Some(device())));
        assert!(agree(&mut cpu, &mut gpu, before), "{stroker:?}");
        assert_eq!((before, gpu.report().quanta_missing), (0, 0), "{stroker:?}");
        let (mut beside, _) = painted(0.05, None);
        assert!(
            !agree(&mut beside, &mut gpu, before),
            "{stroker:?}: a fault passes"
        );
    }
}

/// A loaded brush, and then a clean one through its paint, on wet paint.
#[test]
fn both_backends_paint_the_same_strokes() {
    for stroker in [Stroker::Faster, Stroker::Better, Stroker::Spline] {
        let painted = |shift: f64, gpu: Option<Device>| {
            let mut painting = stroking(stroker, gpu);
            let before = volume(&mut painting);
            paint(&mut painting, "main", &stroke(1, shift, 48));
            clean(&mut painting);
            paint(&mut painting, "main", &stroke(2, 1.5 + shift, 48));
            (painting, before)
        };
        let ((mut cpu, before), (mut gpu, same)) =
            (painted(0.0, None), painted(0.0, Some(device())));
        assert_eq!(before, same);
        assert!(gpu.backend().starts_with("gpu "), "{}", gpu.backend());
        assert!(agree(&mut cpu, &mut gpu, before), "{stroker:?}");
        assert_eq!(gpu.report().quanta_missing, 0, "{stroker:?}");
        let (cells, same) = (gpu.work().1 as f64, cpu.work().1 as f64);
        assert!((cells / same - 1.0).abs() < 0.01, "{cells} {same}");
        // A stroke a fifth of a cell aside is another one.
        let (mut beside, _) = painted(0.05, None);
        assert!(
            !agree(&mut beside, &mut gpu, before),
            "{stroker:?}: a fault passes"
        );
    }
}

#[test]
fn the_same_stroke_has_the_same_bytes() {
    strokes::have_the_same_bytes(&easel, 60);
}

#[test]
fn the_books_balance() {
    strokes::balance_the_books(&easel, 24);
}

#[test]
fn a_lost_device_loses_no_paint() {
    strokes::outlive_their_device(&easel, &agree, 60);
    // A spline goes through the step before, too.
    strokes::outlive_their_device(&|gpu| stroking(Stroker::Spline, gpu), &agree, 60);
}
