//! Random gestures of a painter in a real window: nothing is painted without a press, a stroke is one step of undo
//! and has no gap, and undo leads back to the blank canvas, redo to the same bytes.

#[path = "../support/mod.rs"]
mod support;

#[path = "gestures/hand.rs"]
mod hand;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hand::{Effect, Hand};
use support::display::{CONTROL, Display, SHIFT};
use support::{Launcher, PATIENCE, Place, assert_same};

/// Seed of the gestures.
const SEED: u64 = 20_261_125;
/// Threads that leave the processors no rest.
struct Busy(Arc<AtomicBool>);

impl Busy {
    fn start(loops: usize) -> Self {
        let run = Arc::new(AtomicBool::new(true));
        for _ in 0..loops {
            let run = Arc::clone(&run);
            std::thread::spawn(move || {
                while run.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        Self(run)
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Relaxed);
    }
}

/// The picture and the ledger as the rig writes them.
fn snapshot(place: &Place) -> (Vec<u8>, serde_json::Value) {
    place.done(&[
        "snapshot",
        "-o",
        "p.png",
        "--ledger",
        "l.json",
        "--overwrite",
    ]);
    let ledger = serde_json::from_slice(&place.bytes("l.json")).expect("JSON");
    (place.bytes("p.png"), ledger)
}

/// A rig with its window, and a hand at it.
fn sit_down(place: &Place) -> (Launcher, Hand) {
    let display = Display::start();
    let mut command = place.maulstick(&["up", "hand.maul"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(place);
    display.window("Maulstick");
    (launcher, Hand::new(display, bus, &topics, SEED))
}

/// Closes the window, which ends the rig.
fn get_up(mut launcher: Launcher, hand: Hand) {
    hand.bus.close();
    let window = hand.display.window("Maulstick");
    hand.display.close(window);
    let ended = launcher.wait(PATIENCE);
    assert_eq!(ended.code(), Some(0), "{}", launcher.said());
}

fn gestures(count: usize, busy: usize) {
    let place = Place::new();
    let (launcher, mut hand) = sit_down(&place);
    let _busy = Busy::start(busy);
    let mut steps = hand.settle();
    let (blank, _) = snapshot(&place);
    // The brush is loaded as the rig starts.
    let first = steps.undo;
    assert!(first <= 1 && steps.redo == 0, "nothing was done yet");
    let mut painted = 0;
    for number in 0..count {
        let (name, effect) = hand.gesture();
        let what = format!("gesture {number} of seed {SEED}, {name}");
        let mut now = hand.settle();
        let strokes = hand.strokes(&what);
        match effect {
            Effect::Nothing => {
                assert_eq!((now.undo, now.redo), (steps.undo, steps.redo), "{what}");
                assert_eq!(strokes, 0, "{what}: something touched");
            }
            Effect::Stroke => {
                let more = now.undo.checked_sub(steps.undo);
                assert!(
                    more.is_some_and(|more| more <= 1),
                    "{what}: {steps:?} {now:?}"
                );
                assert!(strokes <= 1, "{what}: {strokes} strokes");
                painted += more.unwrap_or_default();
            }
            Effect::Command => {
                now = hand.fence();
            }
        }
        steps = now;
    }
    assert!(
        painted as usize > count / 6,
        "only {painted} strokes left paint"
    );

    let (end, ledger) = snapshot(&place);
    assert_eq!(ledger["quanta_missing"], 0);
    let depth = hand.settle().undo;
    assert!(depth > first && end != blank, "{depth} steps");
    for left in (first..depth).rev() {
        hand.display.keys(&[CONTROL, u32::from('z')]);
        hand.wait_status(|status, _| status.undo == left);
    }
    let (undone, ledger) = snapshot(&place);
    assert_same(&undone, &blank, "all undone");
    assert_eq!(ledger["quanta_missing"], 0);
    for left in (0..depth - first).rev() {
        hand.display.keys(&[CONTROL, SHIFT, u32::from('z')]);
        hand.wait_status(|status, _| status.redo == left);
    }
    let (redone, ledger) = snapshot(&place);
    assert_same(&redone, &end, "all redone");
    assert_eq!(ledger["quanta_missing"], 0);
    get_up(launcher, hand);
}

#[test]
fn some_random_gestures_surprise_nobody() {
    gestures(24, 0);
}

#[test]
#[ignore = "takes a quarter of an hour"]
fn five_hundred_random_gestures_beside_busy_loops_surprise_nobody() {
    gestures(500, 2);
}

/// Bytes of memory that a process holds.
fn resident(pid: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).expect("a process");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.expect("its memory").trim().trim_end_matches(" kB");
    kib.parse::<u64>().expect("a number") << 10
}

/// A thousand strokes are more than an hour of a painter.
#[test]
#[ignore = "takes ten minutes: `./test --long`"]
fn a_thousand_strokes_leave_memory_and_file_within_their_bounds() {
    /// The window may hold so much more after the last stroke than after the first two hundred.
    const MORE: u64 = 24 << 20;
    /// The painting's bound, as rigs have it.
    const BOUND: u64 = 1 << 30;
    let place = Place::new();
    let (launcher, mut hand) = sit_down(&place);
    let window = place.pid("maulstick-ui").expect("a window");
    let mut held = Vec::new();
    for number in 1..=1000 {
        hand.stroke();
        if number % 20 == 0 {
            hand.settle();
            hand.display.keys(&[u32::from('b')]);
        }
        if number % 200 == 0 {
            let status = hand.settle();
            assert!(status.memory_bytes <= BOUND, "{status:?}");
            held.push(resident(window));
        }
    }
    println!("window after each 200 strokes: {held:?} bytes");
    let grown = held[4].saturating_sub(held[0]);
    assert!(
        grown <= MORE,
        "the window has grown by {grown} bytes: {held:?}"
    );
    get_up(launcher, hand);
    let kept = place.bytes("hand.maul").len();
    place.done(&["painting", "pack", "hand.maul"]);
    let packed = place.bytes("hand.maul").len();
    println!("file {kept} bytes, packed {packed}");
    assert!(kept <= 2 * packed, "{kept} bytes, packed {packed}");
}
