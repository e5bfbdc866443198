//! A hand at the window, and what the rig says of what it does.

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

use crate::support::display::{BACKSPACE, CONTROL, Display, ESCAPE, SHIFT, TAB};
use crate::support::{PATIENCE, drain, wait_for};

/// Longest distance between two solves of a stroke, m.
const GAP_M: f64 = 2e-3;
/// The window, pixels, without the rack, and a place over the desk that nothing covers.
const ROOM: [f64; 2] = [1200.0, 790.0];
const FREE: [i16; 2] = [600, 400];
/// The canvas in the window as it is at first, pixels: left, top, right, bottom.
const CANVAS_AREA: [f64; 4] = [440.0, 30.0, 1180.0, 740.0];
/// Time that a hand takes from one place of its way to the next: its speed, nothing waits for it.
const STEP: Duration = Duration::from_millis(5);
/// The button that hides the panels, pixels, and where it is in a mirrored view: a drag that begins there moves nothing.
const IN_PANELS: [[i16; 2]; 2] = [[1171, 25], [383, 25]];

/// What a gesture may do to the steps of undo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect {
    /// No step is begun.
    Nothing,
    /// One stroke, or none where the brush neither gives nor takes.
    Stroke,
    /// Whatever a command does.
    Command,
}

/// A painter, and all that the rig says.
pub(crate) struct Hand {
    pub(crate) display: Display,
    pub(crate) bus: ZenohBus,
    dice: Pcg64Mcg,
    /// True in a gesture whose pointer leaps.
    hurried: bool,
    /// True while the view is mirrored.
    mirrored: bool,
    mouse: Receiver<StylusSample>,
    states: Receiver<BrushState>,
    consumed: Receiver<BrushConsumed>,
    painted: Receiver<PaintConsumed>,
    status: Receiver<PaintStatus>,
    scene: Receiver<Scene>,
    /// Version of the newest scene that was heard.
    version: u64,
    newest_state: u64,
    newest_painted: u64,
    solves: Vec<Solve>,
}

impl Hand {
    pub(crate) fn new(display: Display, bus: ZenohBus, topics: &Topics, seed: u64) -> Self {
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
            mirrored: false,
            dice: Pcg64Mcg::seed_from_u64(seed),
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
    pub(crate) fn settle(&mut self) -> PaintStatus {
        let mut newest = 0;
        // A place that is heard is in a frame after all that the hand did before it.
        let mut stirred = 0;
        for _ in 0..4 {
            drain(&mut self.mouse);
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
    pub(crate) fn fence(&mut self) -> PaintStatus {
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
    pub(crate) fn wait_status(
        &mut self,
        wanted: impl Fn(&PaintStatus, u64) -> bool,
    ) -> PaintStatus {
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

    /// Paints a stroke on the canvas.
    pub(crate) fn stroke(&mut self) {
        let way = self.on_canvas();
        self.drag(1, &way);
    }

    /// Does a gesture; its name and what it may do.
    pub(crate) fn gesture(&mut self) -> (String, Effect) {
        self.hurried = self.below(2) == 0;
        let (name, effect) = match self.below(24) {
            0..=5 => {
                self.stroke();
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
                self.drag_with(&[u32::from('c')], &way);
                ("lifting stroke", Effect::Command)
            }
            11..=13 => {
                let way = self.anywhere();
                self.go(&way);
                ("hover", Effect::Nothing)
            }
            kind @ 14..=19 => return (self.handle_view(kind), Effect::Nothing),
            kind => return self.command(kind),
        };
        (name.to_owned(), effect)
    }

    /// Handles the view or chooses a brush, by the number among the [gestures](Self::gesture); its name.
    fn handle_view(&mut self, kind: u32) -> String {
        let name = match kind {
            14 => {
                self.turn_wheel();
                "wheel"
            }
            15 => {
                self.move_canvas();
                "move of the canvas"
            }
            16 => {
                self.drag_with_a_key();
                "drag with a key"
            }
            17 => {
                self.drag_out_of_panels();
                "drag out of the panels"
            }
            18 => return format!("key '{}'", self.press_key_of_view()),
            _ => {
                for _ in 0..1 + self.below(3) {
                    self.display.keys(&[u32::from('b')]);
                }
                "another brush"
            }
        };
        name.to_owned()
    }

    fn turn_wheel(&mut self) {
        let at = self.within(CANVAS_AREA).map(|at| at as i16);
        let (notches, button) = (1 + self.below(3), 4 + self.below(2) as u8);
        for _ in 0..notches {
            self.display.click(button, at);
        }
    }

    fn move_canvas(&mut self) {
        let way = self.on_canvas();
        let keys: &[u32] = [&[][..], &[SHIFT], &[0xffe9]][self.below(3) as usize];
        self.display.hold(keys);
        self.drag(2, &way[..way.len().min(12)]);
        self.display.let_go(keys);
    }

    fn drag_with_a_key(&mut self) {
        let way = self.on_canvas();
        let letter = ['s', 'z'][self.below(2) as usize];
        self.drag_with(&[u32::from(letter)], &way[..way.len().min(8)]);
    }

    /// From the panels over the canvas: nobody paints; over them from the canvas: one stroke.
    fn drag_out_of_panels(&mut self) {
        self.display.keys(&[TAB]);
        self.settle();
        let mut way = self.way([450.0, 60.0, 700.0, 700.0]);
        way.insert(0, IN_PANELS[usize::from(self.mirrored)]);
        self.drag(1, &way);
        self.display.keys(&[ESCAPE]);
        self.display.keys(&[TAB]);
    }

    /// Presses a key that changes view or brush; its letter.
    fn press_key_of_view(&mut self) -> &'static str {
        let keys = [
            "[", "]", "b", ",", ".", "t", "-", "=", "m", "0", "1", " ", "[", "]", "b",
        ];
        let word = keys[self.below(keys.len() as u32) as usize];
        let shown: Vec<u32> = word.chars().map(u32::from).collect();
        self.mirrored ^= word == "m";
        self.display.keys(&shown);
        word
    }

    /// Gives a command by its keys, by its number among the [gestures](Self::gesture).
    fn command(&mut self, kind: u32) -> (String, Effect) {
        let (name, keys) = match kind {
            20 => ("undo".to_owned(), vec![CONTROL, u32::from('z')]),
            21 => ("redo".to_owned(), vec![CONTROL, SHIFT, u32::from('z')]),
            22 => {
                let letter = ['d', 'c', 'i', 'i'][self.below(4) as usize];
                (format!("key '{letter}'"), vec![u32::from(letter)])
            }
            _ => ("scrape".to_owned(), vec![BACKSPACE]),
        };
        self.display.keys(&keys);
        (name, Effect::Command)
    }

    /// Checks what a gesture painted: no gap in any stroke, and how many strokes there were.
    pub(crate) fn strokes(&mut self, what: &str) -> usize {
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
                    "{what}: a gap of {:.1} mm, anew: {anew}, mirrored: {}, {last:?} {solve:?}",
                    1e3 * gap_m,
                    self.mirrored
                );
            }
            last = Some(solve);
        }
        strokes.len()
    }
}
