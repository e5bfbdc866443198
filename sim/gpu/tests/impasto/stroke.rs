//! Whole strokes: beside those of the processor, twice the same, with the books in order.

use maulstick_gpu::GpuError;
use maulstick_painting::{Painting, Sequencer};
use maulstick_types::brush::BrushState;
use maulstick_types::edits::{Clean, Load};
use maulstick_types::paint::Entry;
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Header, Message as _, name_hash};

use crate::device;
use crate::easel::{all, difference, easel, easel_of, lifted, mixture, paint, stroke, volume};

/// Mean and 99th percentile of ΔE00 by which the backends may differ.
const COLOURS: [f64; 2] = [0.3, 2.0];
/// Share of the volume by which they may.
const VOLUME: f64 = 1e-3;

fn agree(cpu: &mut Painting, gpu: &mut Painting, before: u64) -> bool {
    let deposited = |after: u64| after as f64 - before as f64;
    let (on_cpu, on_gpu) = (deposited(volume(cpu)), deposited(volume(gpu)));
    let off = (on_gpu / on_cpu - 1.0).abs();
    let apart = difference(cpu, gpu);
    println!("volume off by {off:.2e}, ΔE00 {apart:.3?}");
    off <= VOLUME && apart[0] <= COLOURS[0] && apart[1] <= COLOURS[1]
}

#[test]
fn both_backends_paint_the_same_stroke() {
    let (mut cpu, mut gpu) = (easel(None), easel(Some(device())));
    let before = volume(&mut cpu);
    assert_eq!(volume(&mut gpu), before);
    for painting in [&mut cpu, &mut gpu] {
        paint(painting, "main", &stroke(1, 0.0, 48));
        paint(painting, "main", &stroke(2, 1.5, 48));
    }
    assert!(gpu.backend().starts_with("gpu "), "{}", gpu.backend());
    assert!(agree(&mut cpu, &mut gpu, before));
    assert_eq!(gpu.report().quanta_missing, 0);
    let (cells, same) = (gpu.work().1 as f64, cpu.work().1 as f64);
    assert!((cells / same - 1.0).abs() < 0.01, "{cells} {same}");
    // A stroke a fifth of a cell beside it is another one.
    let mut beside = easel(None);
    paint(&mut beside, "main", &stroke(1, 0.05, 48));
    paint(&mut beside, "main", &stroke(2, 1.55, 48));
    assert!(!agree(&mut beside, &mut gpu, before), "a fault passes");
}

/// On finer cells a step is several of them long, and paint moves in as many parts.
#[test]
fn both_backends_paint_the_same_on_fine_cells() {
    let (mut cpu, mut gpu) = (easel_of(3, None), easel_of(3, Some(device())));
    let before = volume(&mut cpu);
    for painting in [&mut cpu, &mut gpu] {
        paint(painting, "main", &stroke(1, 0.0, 48));
    }
    assert!(agree(&mut cpu, &mut gpu, before));
    assert_eq!(gpu.report().quanta_missing, 0);
    let mut beside = easel_of(3, None);
    paint(&mut beside, "main", &stroke(1, 0.05, 48));
    assert!(!agree(&mut beside, &mut gpu, before), "a fault passes");
}

/// Whoever looks at the painting meanwhile, and however often: the same bytes.
#[test]
fn the_same_stroke_has_the_same_bytes() {
    let mut once = easel(Some(device()));
    let mut looked_at = easel(Some(device()));
    let states = stroke(1, 0.0, 60);
    paint(&mut once, "main", &states);
    for (number, state) in states.iter().enumerate() {
        paint(&mut looked_at, "main", std::slice::from_ref(state));
        if number % 7 == 3 {
            looked_at.commit();
        }
    }
    let (one, two) = (all(&mut once), all(&mut looked_at));
    assert!(one.iter().map(Vec::len).sum::<usize>() > 10_000);
    assert!(one == two, "the bytes differ");
    let mut other = easel(Some(device()));
    paint(&mut other, "main", &stroke(1, 1e-4, 60));
    assert!(one != all(&mut other), "a fault passes");
}

/// Two brushes at once, one cleaned in its stroke, undone and redone: nothing is lost or made.
#[test]
fn the_books_balance() {
    let mut painting = easel(Some(device()));
    let (one, two) = (stroke(1, 0.0, 24), stroke(1, 6.0, 24));
    for (a, b) in one.iter().zip(&two) {
        paint(&mut painting, "main", std::slice::from_ref(a));
        paint(&mut painting, "other", std::slice::from_ref(b));
    }
    assert_eq!(painting.report().quanta_missing, 0);
    paint(&mut painting, "main", &stroke(2, 3.0, 24));
    painting
        .apply(Clean {
            brush: BrushName::main(),
        })
        .expect("known");
    paint(&mut painting, "main", &stroke(2, 5.0, 24));
    assert_eq!(painting.report().quanta_missing, 0);
    let painted = all(&mut painting);
    painting.undo(None).expect("a step");
    painting.undo(None).expect("a step");
    assert_eq!(painting.report().quanta_missing, 0);
    assert!(painted != all(&mut painting));
    painting.redo(None).expect("a step");
    painting.redo(None).expect("a step");
    assert!(painted == all(&mut painting), "redone it is as it was");
    painting
        .apply(Load {
            mixture: mixture("Yellow Ochre"),
            beside: None,
            brush: BrushName::main(),
        })
        .expect("loaded");
    assert_eq!(painting.report().quanta_missing, 0);
}

fn header(seq: u64) -> Header {
    Header {
        version: BrushState::VERSION,
        schema: 0,
        source: name_hash("main"),
        epoch: 1,
        flags: Flags::NONE,
        length: 0,
        seq,
        event_ns: 0,
        sent_ns: 0,
    }
}

/// The device goes in mid-stroke, with steps on it that nobody has seen: the processor does them again,
/// goes on, and at the stroke's end that is journalled.
#[test]
fn a_lost_device_loses_no_paint() {
    let mut cpu = easel(None);
    let before = volume(&mut cpu);
    for (strokes, lost_at) in [(1, 20), (2, 0)] {
        let gpu = device();
        let mut sequencer = Sequencer::new(easel(Some(gpu.clone())));
        let mut cpu = easel(None);
        let mut seq = 0;
        for number in 1..=strokes {
            let mut states = stroke(number, 0.0, 60);
            states.push(lifted());
            for (i, state) in states.iter().enumerate() {
                if (number, i) == (strokes, lost_at) {
                    gpu.device.destroy();
                    assert!(matches!(
                        gpu.guarded(|| Ok(())),
                        Ok(()) | Err(GpuError::Lost(_))
                    ));
                }
                let (_, painted) = sequencer.state("main", &header(seq), state);
                painted.expect("it fits");
                seq += 1;
                if i == 40 {
                    sequencer.painting_mut().commit();
                }
            }
            paint(&mut cpu, "main", &states);
        }
        assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
        assert_eq!(sequencer.painting().backend(), "cpu");
        assert!(agree(&mut cpu, sequencer.painting_mut(), before));
        let decided = sequencer.drain_journal().into_iter();
        let decided: Vec<String> = decided
            .filter_map(|entry| match entry.entry {
                Entry::Decision { what } => Some(what),
                _ => None,
            })
            .collect();
        println!("{decided:?}");
        let told = |what: &String| what.starts_with("backend cpu: the graphics device failed");
        assert!(
            decided.len() == 1 && decided.iter().all(told),
            "{decided:?}"
        );
    }
}
