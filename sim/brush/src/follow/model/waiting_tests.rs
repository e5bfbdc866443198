//! A pen that waits to be set down and whose stroke does not continue.

use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Origin};

use super::BrushModel;
use super::tests::{DEVICE, MS, brush, pen};

fn is_painted(solve: &Solve) -> bool {
    solve.flags & solve_flags::PREVIEW == 0
}

/// A brush whose pen was just set down, and still waits; it hovered before.
fn waiting() -> BrushModel {
    let mut model = brush();
    for (ms, x, pressure) in [(1000, 0.0, 0.0), (1008, 0.0, 0.4), (1016, 3e-4, 0.4)] {
        let solves = model.follow(DEVICE, ms * MS, &pen(x, 0.0, pressure));
        assert_eq!(solves.iter().any(is_painted), pressure == 0.0, "{ms} ms");
    }
    model
}

/// Asserts that a mark of two samples, .3 mm apart, is in the solves.
fn assert_mark(solves: &[Solve]) {
    let painted: Vec<&Solve> = solves.iter().filter(|solve| is_painted(solve)).collect();
    assert!(painted.len() > 1, "{} solves", painted.len());
    assert_eq!(painted[0].event_ns, 1008 * MS);
    assert!(painted.iter().all(|solve| !solve.contacts.is_empty()));
    let last = solves.last().map(|last| (last.event_ns, is_painted(last)));
    assert_eq!(last, Some((1016 * MS, false)), "shown where the pen is");
}

#[test]
fn a_pen_that_waits_at_the_end_is_set_down_once_and_goes_on_from_there() {
    let mut model = waiting();
    assert_mark(&model.finish());
    assert!(model.finish().is_empty());
    let solves = model.follow(DEVICE, 1024 * MS, &pen(2e-3, 0.0, 0.4));
    assert!(solves.len() > 5, "{} solves", solves.len());
    let goes_on = |solve: &Solve| solve.stroke == 1 && solve.flags & solve_flags::RESTARTED == 0;
    assert!(solves.iter().all(goes_on));
    assert!(model.finish().is_empty() && brush().finish().is_empty());
}

#[test]
fn a_pen_that_waits_is_set_down_before_its_brush_begins_anew() {
    let mut model = waiting();
    assert_mark(&model.begin_anew());
    assert!(model.begin_anew().is_empty());
    let anew = model.follow(DEVICE, 1024 * MS, &pen(0.01, 0.0, 0.4));
    assert!(anew[0].flags & solve_flags::RESTARTED != 0);
}

/// Solves of a take that ends as its pen is set down: by its last sample, or by a call after it where that is not flagged.
fn ended(last: &StylusSample, flags: Flags) -> Vec<Solve> {
    let mut model = brush();
    let take: [(u64, StylusSample, Flags); 3] = [
        (1000, pen(0.0, 0.0, 0.0), Flags::REPLAY),
        (1008, pen(0.0, 0.0, 0.4), Flags::REPLAY),
        (1016, last.clone(), flags),
    ];
    let mut solves = Vec::new();
    for (number, (ms, sample, flags)) in (0..).zip(&take) {
        let state = model.state_in_take(DEVICE, number, ms * MS, sample, *flags);
        solves.extend(state.map_or_else(Vec::new, |state| state.solves));
    }
    if !flags.has(Flags::LAST) {
        solves.extend(model.finish());
    }
    solves
}

#[test]
fn the_last_sample_of_a_take_sets_a_waiting_pen_down_even_if_it_is_faulty() {
    let last = Flags::REPLAY.with(Flags::LAST);
    let sample = pen(3e-4, 0.0, 0.4);
    let with_the_last = ended(&sample, last);
    assert!(
        with_the_last
            .iter()
            .any(|solve| is_painted(solve) && solve.stroke == 1)
    );
    assert!(with_the_last == ended(&sample, Flags::REPLAY));
    let faulty = ended(&pen(f64::NAN, 0.0, 0.4), last);
    assert!(
        faulty
            .iter()
            .any(|solve| is_painted(solve) && solve.stroke == 1)
    );
}

#[test]
fn a_pen_that_waits_is_set_down_before_another_device_has_its_brush() {
    let mut model = waiting();
    let other = Origin {
        source: 2,
        epoch: 1,
    };
    let solves = model.follow(other, 1024 * MS, &pen(0.02, 0.0, 0.0));
    let (lifted, mark) = solves.split_last().expect("solves");
    assert_mark(mark);
    assert!(lifted.contacts.is_empty() && lifted.flags & solve_flags::RESTARTED != 0);
}

#[test]
fn a_pen_that_rested_is_shown_once_where_it_is_set_down() {
    let mut model = waiting();
    for ms in 1017..1090 {
        let solves = model.follow(DEVICE, ms * MS, &pen(0.0, 0.0, 0.4));
        assert_eq!(solves.len(), 1, "{ms} ms: it waits");
    }
    let solves = model.follow(DEVICE, 1090 * MS, &pen(0.0, 0.0, 0.0));
    let previews = solves.iter().filter(|solve| !is_painted(solve));
    assert_eq!(previews.count(), 1, "{} solves", solves.len());
}

#[test]
fn samples_that_wait_are_bounded_however_fast_they_come() {
    let mut model = waiting();
    let set_down = (1..2000_u64).find(|micros| {
        let ns = 1016 * MS + micros * 1000;
        let solves = model.follow(DEVICE, ns, &pen(0.0, 0.0, 0.4));
        solves.iter().any(is_painted)
    });
    // Of a device of 8 kHz all wait.
    assert!(
        set_down.is_some_and(|samples| samples > 800),
        "{set_down:?}"
    );
}
