//! Whole strokes of any model on the device: twice the same, with balanced books, and after a loss of the device.

use maulstick_gpu::GpuError;
use maulstick_painting::edits::{Clean, Load};
use maulstick_painting::{Painting, Sequencer};
use maulstick_types::brush::BrushState;
use maulstick_types::paint::{Decision, Entry};
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Header, Message as _, name_hash};

use crate::device;
use crate::easel::{Easel, all, lifted, mixture, paint, stroke, volume};

/// True if the paintings of two backends agree, given the amount before.
pub(crate) type Agree<'a> = &'a dyn Fn(&mut Painting, &mut Painting, u64) -> bool;

/// The same bytes after a part of the 60 states of a stroke, whoever looks at the painting meanwhile.
pub(crate) fn have_the_same_bytes(easel: Easel<'_>, painted: usize) {
    let mut once = easel(Some(device()));
    let mut looked_at = easel(Some(device()));
    let states = &stroke(1, 0.0, 60)[..painted];
    paint(&mut once, "main", states);
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
    paint(&mut other, "main", &stroke(1, 1e-4, 60)[..painted]);
    assert!(one != all(&mut other), "a fault passes");
}

/// Two brushes at once, one cleaned in its stroke, undone and redone: nothing is lost or made, in so many of 24 states of each
/// stroke.
pub(crate) fn balance_the_books(easel: Easel<'_>, painted: usize) {
    let mut painting = easel(Some(device()));
    let part = |number, shift| {
        let mut states = stroke(number, shift, 24);
        states.truncate(painted);
        states
    };
    let (one, two) = (part(1, 0.0), part(1, 6.0));
    for (a, b) in one.iter().zip(&two) {
        paint(&mut painting, "main", std::slice::from_ref(a));
        paint(&mut painting, "other", std::slice::from_ref(b));
    }
    assert_eq!(painting.report().quanta_missing, 0);
    paint(&mut painting, "main", &part(2, 3.0));
    painting
        .apply(Clean {
            brush: BrushName::main(),
        })
        .expect("known");
    paint(&mut painting, "main", &part(2, 5.0));
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

pub(crate) fn header(seq: u64) -> Header {
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

/// Decisions of a paint node with this sequencer.
pub(crate) fn decisions(sequencer: &mut Sequencer) -> Vec<Decision> {
    let entries = sequencer.drain_journal().into_iter();
    let decided = entries.filter_map(|entry| match entry.entry {
        Entry::Decision { what } => Some(what),
        _ => None,
    });
    decided.collect()
}

/// The device goes in mid-stroke, with steps on it that nobody has seen: the processor does them again,
/// goes on, and at the stroke's end that is journalled. So many of 60 states of each stroke are painted.
pub(crate) fn outlive_their_device(easel: Easel<'_>, agree: Agree<'_>, painted: usize) {
    let before = volume(&mut easel(None));
    for (strokes, lost_at) in [(1, painted / 3), (2, 0)] {
        let gpu = device();
        let mut sequencer = Sequencer::new(easel(Some(gpu.clone())));
        let mut cpu = easel(None);
        let mut seq = 0;
        for number in 1..=strokes {
            let mut states = stroke(number, 0.0, 60);
            states.truncate(painted);
            states.push(lifted());
            for (i, state) in states.iter().enumerate() {
                if (number, i) == (strokes, lost_at) {
                    gpu.device.destroy();
                    assert!(matches!(
                        gpu.guarded(|| Ok(())),
                        Ok(()) | Err(GpuError::Lost(_))
                    ));
                }
                let (_, taken) = sequencer.state("main", &header(seq), state);
                taken.expect("it fits");
                seq += 1;
                if i == 2 * painted / 3 {
                    sequencer.painting_mut().commit();
                }
            }
            paint(&mut cpu, "main", &states);
        }
        assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
        assert_eq!(sequencer.painting().backend(), "cpu");
        assert!(agree(&mut cpu, sequencer.painting_mut(), before));
        let decided = decisions(&mut sequencer);
        let is_fallback =
            matches!(&decided[..], [Decision::Fallback { name, .. }] if name == "cpu");
        assert!(is_fallback, "{decided:?}");
    }
}
