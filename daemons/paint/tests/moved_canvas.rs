//! A canvas that is moved while a stroke waits to be solved: the stroke lies where the hand made it.

mod support;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_painting::edits::{Load, Place};
use maulstick_types::brush::BrushState;
use maulstick_types::command::Command;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;
use support::{Device, Live, START_NS, loads, painting, pen};

/// Time of a turn, ns.
const MILLISECOND: u64 = 1_000_000;
/// The stroke's half length, and how far the canvas is moved, m.
const REACH_M: f64 = 0.02;
const MOVED_M: f64 = 0.03;

/// A stroke along x; paint has no turn, so that the brush may soon send no more.
fn stroke(live: &mut Live, mouse: &mut Device) {
    for step in 0..200 {
        mouse.send(&pen(REACH_M * (f64::from(step) / 100.0 - 1.0), 0.0, 0.4));
        live.net.advance(MILLISECOND);
        live.brush.poll().expect("turned");
    }
}

/// Lifts the brush; both nodes take their turns until all is painted.
fn lifted(live: &mut Live, mouse: &mut Device) {
    mouse.send(&pen(REACH_M, 0.0, 0.0));
    for _ in 0..200 {
        live.net.advance(5 * MILLISECOND);
        live.paint.poll().expect("turned");
        live.brush.poll().expect("turned");
    }
}

/// Where the strokes lie on the canvas: least and greatest x and y, m.
fn lies(states: &mut Receiver<BrushState>) -> [[f64; 2]; 2] {
    let mut lies = [[f64::MAX, f64::MIN]; 2];
    while let Some(state) = states.try_recv() {
        let strokes = state.message.solves.into_iter();
        for solve in strokes.filter(|solve| solve.stroke != 0) {
            for (range, at) in lies.iter_mut().zip(solve.pose.position_m) {
                *range = [range[0].min(at), range[1].max(at)];
            }
        }
    }
    lies
}

#[test]
fn what_was_painted_before_a_canvas_is_moved_stays_where_it_was_painted() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let bus = live.net.bus();
    let (topic, ring) = (live.topics.brush_state("main"), Queue::Ring(4096));
    let states = Receiver::new(&bus, &topic, Qos::RealTime, ring, &Wake::new());
    let mut states: Receiver<BrushState> = states.expect("listens");
    let mut mouse = live.device("mouse", 5);
    live.net.advance(MILLISECOND);
    live.brush.poll().expect("turned");
    stroke(&mut live, &mut mouse);
    let scene = painting().scene().clone();
    let mut pose = scene.surfaces[0].pose.clone();
    pose.position_m[1] += MOVED_M;
    live.command(
        1,
        Command::from(Place::new(CANVAS, pose, 1.0).expect("in reach")),
    );
    lifted(&mut live, &mut mouse);
    let [[left, right], [low, high]] = lies(&mut states);
    assert!(right - left > 1.9 * REACH_M, "{left} {right}");
    assert!(high - low < 0.05 * MOVED_M, "{low} {high}");
    // What is painted afterwards lies elsewhere on the canvas: on a canvas that stood still nothing above
    // would have been tried.
    stroke(&mut live, &mut mouse);
    lifted(&mut live, &mut mouse);
    let [_, [after, _]] = lies(&mut states);
    assert!((low - after - MOVED_M).abs() < 0.05 * MOVED_M, "{after}");
}

#[test]
fn a_device_is_told_of_its_samples_once_they_are_solved() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let mut mouse = live.device("mouse", 5);
    live.net.advance(MILLISECOND);
    live.brush.poll().expect("turned");
    stroke(&mut live, &mut mouse);
    let told = mouse.consumed();
    assert!((1..200).contains(&told), "{told}: the last of them wait");
    stroke(&mut live, &mut mouse);
    assert_eq!(mouse.consumed(), 0, "nothing new was told");
    // No further sample comes.
    for _ in 0..200 {
        live.net.advance(5 * MILLISECOND);
        live.paint.poll().expect("turned");
        live.brush.poll().expect("turned");
    }
    assert_eq!(mouse.consumed(), 400);
}

/// Cells that a stroke covers on a canvas that is zoomed at a time of the stroke.
fn covered(zoom: Option<Zoomed>) -> u64 {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let mut mouse = live.device("mouse", 5);
    let load = Command::from(Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    });
    live.command(1, load);
    live.net.advance(MILLISECOND);
    live.brush.poll().expect("turned");
    let larger = Command::from(
        Place::new(CANVAS, painting().scene().surfaces[0].pose.clone(), 1.3).expect("in reach"),
    );
    if zoom == Some(Zoomed::Before) {
        live.command(2, larger.clone());
        live.net.advance(MILLISECOND);
        live.brush.poll().expect("turned");
    }
    stroke(&mut live, &mut mouse);
    if zoom == Some(Zoomed::Before) {
        // Its states are painted as on the other canvas, which is not zoomed any more.
        let pose = painting().scene().surfaces[0].pose.clone();
        live.command(
            3,
            Command::from(Place::new(CANVAS, pose, 1.0).expect("in reach")),
        );
    } else if zoom == Some(Zoomed::Meanwhile) {
        live.command(2, larger);
    }
    lifted(&mut live, &mut mouse);
    live.paint.painting_mut().report().covered_cells
}

/// When a canvas is zoomed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Zoomed {
    /// Before the stroke, and not when it is painted.
    Before,
    /// While the stroke waits to be painted.
    Meanwhile,
}

#[test]
fn a_stroke_is_painted_as_large_as_the_canvas_was_when_it_was_made() {
    let whole = covered(None);
    assert!(whole > 500, "{whole}");
    let meanwhile = covered(Some(Zoomed::Meanwhile));
    assert!(
        whole.abs_diff(meanwhile) * 50 < whole,
        "{whole} {meanwhile}"
    );
    let smaller = covered(Some(Zoomed::Before));
    assert!(smaller * 10 < whole * 9, "{whole} {smaller}");
}
