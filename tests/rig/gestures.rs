//! Random gestures of a painter in a real window: nothing is painted without a press, a stroke is one step of undo
//! and has no gap, and undo leads back to the blank canvas, redo to the same bytes.

#[path = "../support/mod.rs"]
mod support;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus as _, Qos, Queue, Wake, ZenohBus};
use maulstick_types::brush::{BrushConsumed, BrushState, Solve, solve_flags};
use maulstick_types::paint::{PaintConsumed, PaintStatus};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};
use support::display::{BACKSPACE, CONTROL, Display, ESCAPE, SHIFT, TAB};
use support::{Launcher, PATIENCE, Place, assert_same, wait_for};

/// Seed of the gestures.
const SEED: u64 = 20_261_125;
/// Longest distance between two solves of a stroke, m.
const GAP_M: f64 = 2e-3;
/// The window, pixels, without the rack, and a place over the desk that nothing covers.
const ROOM: [f64; 2] = [1200.0, 790.0];
const FREE: [i16; 2] = [600, 400];
/// The canvas in the window as it is at first, pixels: left, top, right, bottom.
const CANVAS_AREA: [f64; 4] = [440.0, 30.0, 1180.0, 740.0];
/// Time that a hand takes from one place of its way to the next.
const STEP: Duration = Duration::from_millis(5);
/// A place within the panels, pixels.
const IN_PANELS: [i16; 2] = [1040, 30];

/// What a gesture may do to the steps of undo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effect {
    /// Nothing.
    Nothing,
    /// One stroke, or none where the brush neither gives nor takes.
    Stroke,
    /// Whatever a command does.
    Command,
}

/// A painter, and all that the rig says.
struct Hand {
    display: Display,
    bus: ZenohBus,
    dice: Pcg64Mcg,
    hurried: bool,
    mouse: Receiver<StylusSample>,
    states: Receiver<BrushState>,
    consumed: Receiver<BrushConsumed>,
    painted: Receiver<PaintConsumed>,
    status: Receiver<PaintStatus>,
    scene: Receiver<Scene>,
    version: u64,
    newest_state: u64,
    newest_painted: u64,
    solves: Vec<Solve>,
}

impl Hand {
    fn new(display: Display, bus: ZenohBus, topics: &Topics) -> Self {
        let ring = Queue::Ring(65_536);
        let wake = Wake::new();
        Self {
            mouse: Receiver::new(&bus, &topics.sample("mouse"), Qos::RealTime, ring, &wake)
                .expect("samples"),
            states: Receiver::new(
                &bus,
                &topics.brush_state("main"),
                Qos::RealTime,
                ring,
                &wake,
            )
            .expect("states"),
            consumed: Receiver::new(
                &bus,
                &topics.brush_consumed("main"),
                Qos::Control,
                ring,
                &wake,
            )
            .expect("credit"),
            painted: Receiver::new(&bus, &topics.paint_consumed(), Qos::Control, ring, &wake)
                .expect("credit"),
            status: Receiver::new(&bus, &topics.paint_status(), Qos::Control, ring, &wake)
                .expect("status"),
            scene: Receiver::new(&bus, &topics.scene(), Qos::Cached, ring, &wake).expect("scene"),
            display,
            bus,
            hurried: false,
            dice: Pcg64Mcg::seed_from_u64(SEED),
            version: 0,
            newest_state: 0,
            newest_painted: 0,
            solves: Vec::new(),
        }
    }

    /// A number from 0 up to, and without, `end`.
    fn below(&mut self, end: u32) -> u32 {
        self.dice.next_u32() % end
    }

    fn share(&mut self) -> f64 {
        f64::from(self.dice.next_u32()) / f64::from(u32::MAX)
    }

    /// A place of an area, pixels.
    fn within(&mut self, [left, top, right, bottom]: [f64; 4]) -> [f64; 2] {
        [
            left + (right - left) * self.share(),
            top + (bottom - top) * self.share(),
        ]
    }

    /// A bent way between places of an area, in steps of a hand.
    fn way(&mut self, area: [f64; 4]) -> Vec<[i16; 2]> {
        let [a, b, c] = [0; 3].map(|_| self.within(area));
        let steps = 10 + self.below(50);
        let at = |i: u32| {
            let t = f64::from(i) / f64::from(steps);
            let s = 1.0 - t;
            [0, 1].map(|i| (s * s * a[i] + 2.0 * s * t * b[i] + t * t * c[i]).round() as i16)
        };
        (0..=steps).map(at).collect()
    }

    fn anywhere(&mut self) -> Vec<[i16; 2]> {
        self.way([0.0, 0.0, ROOM[0], ROOM[1]])
    }

    fn on_canvas(&mut self) -> Vec<[i16; 2]> {
        self.way(CANVAS_AREA)
    }

    /// Goes along a way at the speed of a hand; a hurried one leaps, as pointers of remote desktops do.
    fn go(&self, way: &[[i16; 2]]) {
        for at in way {
            self.display.point(*at);
            if !self.hurried {
                std::thread::sleep(STEP);
            }
        }
    }

    fn drag(&self, button: u8, way: &[[i16; 2]]) {
        self.display.press(button, &way[..1]);
        self.go(way);
        self.display.release(button, &[]);
    }

    fn drag_with(&self, keys: &[u32], way: &[[i16; 2]]) {
        self.display.hold(keys);
        self.drag(1, way);
        self.display.let_go(keys);
    }

    /// Waits until the window has seen all that the hand did, and the paint has taken it in; the status after that.
    fn settle(&mut self) -> PaintStatus {
        let mut newest = 0;
        // A place that is heard is in a frame after all that the hand did before it.
        let mut stirred = 0;
        for _ in 0..4 {
            support::drain(&mut self.mouse);
            let seen = wait_for(PATIENCE, || {
                stirred += 1;
                self.display.point([FREE[0] + stirred % 2, FREE[1]]);
                let heard = self.mouse.try_recv()?;
                newest = heard.header.seq;
                (heard.message.switches == 0).then_some(())
            });
            assert!(seen.is_some(), "the pointer is not heard");
        }
        let mut state = None;
        let painted = wait_for(PATIENCE, || {
            while let Some(heard) = self.states.try_recv() {
                // A sender without progress repeats its newest message.
                if heard.header.seq <= self.newest_state {
                    continue;
                }
                self.newest_state = heard.header.seq;
                self.solves.extend(heard.message.solves);
            }
            while let Some(heard) = self.consumed.try_recv() {
                if heard.message.next > newest {
                    state = Some(heard.message.state);
                }
            }
            while let Some(heard) = self.painted.try_recv() {
                for credit in heard.message.brushes {
                    self.newest_painted = self.newest_painted.max(credit.next);
                }
            }
            state.filter(|state| self.newest_painted > *state && self.newest_state >= *state)
        });
        assert!(painted.is_some(), "the paint does not follow");
        let from_ns = self.bus.now_ns();
        self.wait_status(|_, sent_ns| sent_ns > from_ns)
    }

    /// Waits until all commands so far are carried out: those that place the canvas do not overtake them.
    fn fence(&mut self) -> PaintStatus {
        while let Some(heard) = self.scene.try_recv() {
            self.version = heard.message.version;
        }
        self.display.click(4, FREE);
        let placed = wait_for(PATIENCE, || {
            let heard = self.scene.try_recv()?;
            (heard.message.version > self.version).then_some(())
        });
        assert!(placed.is_some(), "the canvas is not placed");
        self.display.keys(&[u32::from('0')]);
        let fitted = wait_for(PATIENCE, || self.scene.try_recv().map(drop));
        assert!(fitted.is_some(), "the canvas is not fitted");
        self.settle()
    }

    /// The first status that `wanted` accepts, with the time at which it was sent.
    fn wait_status(&mut self, wanted: impl Fn(&PaintStatus, u64) -> bool) -> PaintStatus {
        let mut last = None;
        let status = wait_for(PATIENCE, || {
            while let Some(heard) = self.status.try_recv() {
                let sent_ns = heard.header.sent_ns;
                last = Some(heard.message.clone());
                if wanted(&heard.message, sent_ns) {
                    return Some(heard.message);
                }
            }
            None
        });
        assert!(status.is_some(), "no such status, but {last:?}");
        status.expect("asserted")
    }

    /// Does a gesture; its name and what it may do.
    fn gesture(&mut self) -> (String, Effect) {
        let key = |letter: char| u32::from(letter);
        self.hurried = self.below(2) == 0;
        let kind = self.below(24);
        let (name, effect) = match kind {
            0..=5 => {
                let way = self.on_canvas();
                self.drag(1, &way);
                ("stroke", Effect::Stroke)
            }
            6 | 7 => {
                let way = self.anywhere();
                self.drag(1, &way);
                ("stroke from anywhere", Effect::Stroke)
            }
            8 => {
                let way = self.way([10.0, 20.0, 400.0, 740.0]);
                self.drag(1, &way);
                ("stroke on the palette", Effect::Stroke)
            }
            9 => {
                let way = self.on_canvas();
                self.drag_with(&[SHIFT], &way);
                ("straight stroke", Effect::Stroke)
            }
            10 => {
                let way = self.on_canvas();
                // What it lifts is what was painted; how the brush is used is no step.
                self.drag_with(&[key('c')], &way);
                ("lifting stroke", Effect::Command)
            }
            11..=13 => {
                let way = self.anywhere();
                self.go(&way);
                ("hover", Effect::Nothing)
            }
            14 => {
                let at = self.within(CANVAS_AREA).map(|at| at as i16);
                let (notches, button) = (1 + self.below(3), 4 + self.below(2) as u8);
                for _ in 0..notches {
                    self.display.click(button, at);
                }
                ("wheel", Effect::Nothing)
            }
            15 => {
                let way = self.on_canvas();
                let keys: &[u32] = [&[][..], &[SHIFT], &[0xffe9]][self.below(3) as usize];
                self.display.hold(keys);
                self.drag(2, &way[..way.len().min(12)]);
                self.display.let_go(keys);
                ("move of the canvas", Effect::Nothing)
            }
            16 => {
                let way = self.on_canvas();
                let letter = ['s', 'z'][self.below(2) as usize];
                self.drag_with(&[key(letter)], &way[..way.len().min(8)]);
                ("drag with a key", Effect::Nothing)
            }
            17 => {
                // From the panels over the canvas: nobody paints; over them from the canvas: one stroke.
                self.display.keys(&[TAB]);
                self.settle();
                let mut way = self.way([450.0, 60.0, 700.0, 700.0]);
                way.insert(0, IN_PANELS);
                self.drag(1, &way);
                self.display.keys(&[ESCAPE]);
                self.display.keys(&[TAB]);
                ("drag out of the panels", Effect::Nothing)
            }
            18 => {
                let keys = [
                    "[", "]", "b", ",", ".", "t", "-", "=", "m", "0", "1", " ", "[", "]", "b",
                ];
                let word = keys[self.below(keys.len() as u32) as usize];
                let shown = word.chars().map(key);
                let shown: Vec<u32> = shown.collect();
                self.display.keys(&shown);
                return (format!("key '{word}'"), Effect::Nothing);
            }
            19 => {
                for _ in 0..1 + self.below(3) {
                    self.display.keys(&[key('b')]);
                }
                ("another brush", Effect::Nothing)
            }
            20 => {
                self.display.keys(&[CONTROL, key('z')]);
                ("undo", Effect::Command)
            }
            21 => {
                self.display.keys(&[CONTROL, SHIFT, key('z')]);
                ("redo", Effect::Command)
            }
            22 => {
                let letter = ['d', 'c', 'i', 'i'][self.below(4) as usize];
                self.display.keys(&[key(letter)]);
                return (format!("key '{letter}'"), Effect::Command);
            }
            _ => {
                self.display.keys(&[BACKSPACE]);
                ("scrape", Effect::Command)
            }
        };
        (name.to_owned(), effect)
    }

    /// Checks what a gesture painted: no gap in any stroke, and how many strokes there were.
    fn strokes(&mut self, what: &str) -> usize {
        let mut strokes = std::collections::BTreeSet::new();
        let mut last: Option<Solve> = None;
        for solve in std::mem::take(&mut self.solves) {
            if solve.flags & solve_flags::PREVIEW != 0 {
                continue;
            }
            if solve.stroke > 0 {
                strokes.insert(solve.stroke);
            }
            // Beyond the edge of its surface a brush may touch nothing.
            let touched = |last: &Solve| last.stroke == solve.stroke && solve.stroke > 0;
            if let Some(last) = last.filter(touched) {
                let [a, b] = [&last, &solve].map(|solve| solve.pose.position_m);
                let way = [0, 1].map(|i| a[i] - b[i]);
                let gap_m = (way[0] * way[0] + way[1] * way[1]).sqrt();
                let anew = solve.flags & solve_flags::RESTARTED != 0;
                assert!(
                    gap_m < GAP_M && !anew,
                    "{what}: a gap of {:.1} mm, anew: {anew}",
                    1e3 * gap_m
                );
            }
            last = Some(solve);
        }
        strokes.len()
    }
}

/// Two threads that leave the processors no rest.
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

fn gestures(count: usize, busy: usize) {
    let place = Place::new();
    let display = Display::start();
    let mut command = place.maulstick(&["up", "hand.maul"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(&place);
    display.window("Maulstick");
    let _busy = Busy::start(busy);
    let mut hand = Hand::new(display, bus, &topics);
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
    hand.bus.close();
    let window = hand.display.window("Maulstick");
    hand.display.close(window);
    assert_eq!(
        launcher.wait(PATIENCE).code(),
        Some(0),
        "{}",
        launcher.said()
    );
}

#[test]
#[ignore = "takes half a minute"]
fn forty_random_gestures_surprise_nobody() {
    gestures(40, 0);
}

#[test]
#[ignore = "takes a quarter of an hour"]
fn five_hundred_random_gestures_beside_busy_loops_surprise_nobody() {
    gestures(500, 2);
}
