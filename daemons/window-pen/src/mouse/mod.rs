//! The mouse over the window as a stylus of lowest priority.
//!
//! | module | holds |
//! | --- | --- |
//! | [`grip`] | how it holds the brush |
//! | [`brush_turn`] | turn of the brush over a stroke |
//! | `pixel_path` | its path without the steps of whole pixels |
//!
//! A tablet reaches the rig twice, by its daemon and as the pointer: the mouse counts only while no
//! other stylus has been in range for a second. It has neither twist nor pressure: its brush is set down across the stroke
//! once 2.5 mm or 80 ms have shown its direction, then follows as if drawn by a string.

use maulstick_brush::model::BRIDGED_NS;
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Queue, Wake};
use maulstick_rig::config::MOUSE_PRIORITY;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusInfo, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};

pub mod brush_turn;
pub mod grip;
mod pixel_path;

/// Another stylus in range silences the mouse for this long, ns.
const SILENCE_NS: u64 = 1_000_000_000;
/// Longest frame while no button is pressed, ns; a longer time is a pause.
const FRAME_NS: u64 = 90_000_000;

/// Position of the pointer on the desk, its button, and the turn of the brush there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// On the desk, m.
    pub at: [f64; 3],
    /// Pressed primary button.
    pub pressed: bool,
    /// Turn of the brush about its axis, rad.
    pub twist_rad: f64,
}

/// The mouse.
pub struct Mouse {
    samples: CreditSender<StylusSample>,
    others: Receiver<StylusSample>,
    info: Sender<StylusInfo>,
    told: StylusInfo,
    /// Sources of this window's mouse and pen on the bus.
    own: [u32; 2],
    silent_until_ns: u64,
    sent_ns: u64,
    was_in_range: bool,
    /// The last place that was sent, if it was pressed; `None` in the air.
    pressed: Option<Pointer>,
    /// The last place that was sent in the air.
    hovers: Option<Pointer>,
}

impl Mouse {
    /// A mouse called `name` that moves `brush`, beside the pen of its window.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        (name, pen): (&str, u32),
        brush: &str,
        me: Origin,
    ) -> Result<Self, BusError> {
        let wake = Wake::new();
        let mut info = Sender::new(bus, &topics.stylus_info(name), Qos::Cached, me)?;
        let now = bus.now_ns();
        let told = StylusInfo {
            device: name.to_owned(),
            driver: "pointer".into(),
            brush: brush.to_owned(),
            priority: MOUSE_PRIORITY,
            senses: axes::POSITION | axes::SWITCHES,
            drives: 0,
            rate_hz: 60.0,
            max_force_n: 0.0,
            max_stiffness_n_m: 0.0,
            workspace_m: [-0.5, -0.5, 0.0, 0.5, 0.5, 0.0],
        };
        info.send(now, now, &told)?;
        let others = topics.sample("*");
        Ok(Self {
            samples: CreditSender::new(bus, topics, &topics.sample(name), me, &wake)?,
            others: Receiver::new(bus, &others, Qos::RealTime, Queue::Ring(256), &wake)?,
            info,
            told,
            own: [me.source, pen],
            silent_until_ns: 0,
            sent_ns: 0,
            was_in_range: false,
            pressed: None,
            hovers: None,
        })
    }

    /// Takes another brush into the hand, or keeps the present one.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn take(&mut self, now_ns: u64, brush: &str) -> Result<(), BusError> {
        if self.told.brush == brush {
            return Ok(());
        }
        // The brush that was in the hand is lifted first.
        self.send(now_ns, &[], 0.0)?;
        brush.clone_into(&mut self.told.brush);
        self.info.send(now_ns, now_ns, &self.told)
    }

    /// True while no other stylus paints; otherwise the mouse is in the other hand.
    #[must_use]
    pub fn is_free(&self, now_ns: u64) -> bool {
        now_ns < self.silent_until_ns
    }

    /// Sends the movement of the pointer since the last call, at a pressure of 0 to 1: its positions in order, evenly
    /// spread over that time; none while it is not over the desk.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn send(&mut self, now_ns: u64, places: &[Pointer], pressure: f64) -> Result<(), BusError> {
        while let Some(other) = self.others.try_recv() {
            if !self.own.contains(&other.header.source) && other.message.in_range {
                self.silent_until_ns = now_ns + SILENCE_NS;
            }
        }
        self.samples.reset_credit();
        self.samples.serve(now_ns)?;
        let places = if now_ns < self.silent_until_ns {
            &[]
        } else {
            places
        };
        if places.is_empty() {
            return self.leave(now_ns);
        }
        // A brush that rests in the air is not sent again: each sample would draw another frame of the window, which
        // would send the next.
        if self.hovers.is_some() && places.iter().all(|place| Some(*place) == self.hovers) {
            return Ok(());
        }
        self.hovers = places.last().copied().filter(|last| !last.pressed);
        self.was_in_range = true;
        // After a pause the pointer has not crept here. In a stroke a long frame counts as a whole, because otherwise
        // the brush would leap and rest by turns.
        let since_ns = if self.pressed.is_some() && places[0].pressed {
            self.sent_ns
        } else {
            self.sent_ns.max(now_ns.saturating_sub(FRAME_NS))
        };
        let places = self.finer(places, now_ns - since_ns);
        self.pressed = places.last().copied().filter(|last| last.pressed);
        for (number, place) in places.iter().enumerate() {
            let share = (number + 1) as f64 / places.len() as f64;
            let event_ns = since_ns + ((now_ns - since_ns) as f64 * share) as u64;
            let sample = StylusSample {
                senses: axes::POSITION | axes::SWITCHES,
                pose: StylusPose::Contact {
                    point_m: place.at,
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: place.twist_rad,
                    pressure: if place.pressed { pressure } else { 0.0 },
                },
                switches: u32::from(place.pressed),
                in_range: true,
                ..StylusSample::away()
            };
            self.samples
                .send(Flags::NONE, Stamp { now_ns, event_ns }, &sample)?;
        }
        self.sent_ns = now_ns;
        Ok(())
    }

    /// Sends that the pointer is away, if that is new.
    fn leave(&mut self, now_ns: u64) -> Result<(), BusError> {
        (self.pressed, self.hovers) = (None, None);
        if std::mem::take(&mut self.was_in_range) {
            let stamp = Stamp {
                now_ns,
                event_ns: now_ns,
            };
            self.samples
                .send(Flags::NONE, stamp, &StylusSample::away())?;
        }
        self.sent_ns = now_ns;
        Ok(())
    }
}

impl Mouse {
    /// Places over a duration, with enough additional ones between those of a pressed button that the brush crosses any
    /// pause: the button is known to have stayed down.
    fn finer(&self, places: &[Pointer], took_ns: u64) -> Vec<Pointer> {
        let each_ns = took_ns / places.len().max(1) as u64;
        let parts = each_ns / BRIDGED_NS + 1;
        let mut before = self.pressed;
        let mut all = Vec::new();
        for place in places {
            if let (Some(from), true) = (before, place.pressed) {
                all.extend((1..parts).map(|part| {
                    let share = part as f64 / parts as f64;
                    let between = |from: f64, to: f64| from + share * (to - from);
                    Pointer {
                        at: std::array::from_fn(|i| between(from.at[i], place.at[i])),
                        pressed: true,
                        twist_rad: between(from.twist_rad, place.twist_rad),
                    }
                }));
            }
            all.push(*place);
            before = place.pressed.then_some(*place);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::{Faults, MemoryNet};

    use super::*;

    const SECOND: u64 = 1_000_000_000;
    const PRESSED: Pointer = Pointer {
        at: [0.0; 3],
        pressed: true,
        twist_rad: 0.0,
    };
    const PRESSURE: f64 = 0.5;

    /// A mouse, and its listener.
    struct Desk {
        net: MemoryNet,
        topics: Topics,
        mouse: Mouse,
        samples: Receiver<StylusSample>,
        infos: Receiver<StylusInfo>,
    }

    impl Desk {
        fn new() -> Self {
            let net = MemoryNet::new(1, SECOND, Faults::default());
            let (bus, topics, wake) = (net.bus(), Topics::new("t"), Wake::new());
            let me = Origin {
                source: 1,
                epoch: 1,
            };
            let mouse = Mouse::new(&bus, &topics, ("mouse", 7), "main", me).expect("a mouse");
            let (topic, ring) = (topics.sample("mouse"), Queue::Ring(64));
            let samples = Receiver::new(&bus, &topic, Qos::RealTime, ring, &wake);
            let (topic, ring) = (topics.stylus_info("mouse"), Queue::Ring(8));
            let infos = Receiver::new(&bus, &topic, Qos::Cached, ring, &wake);
            Self {
                mouse,
                samples: samples.expect("a receiver"),
                infos: infos.expect("a receiver"),
                net,
                topics,
            }
        }

        /// The mouse sends its position; returns the range state that was received.
        fn turn(&mut self) -> Option<bool> {
            let now_ns = self.net.bus().now_ns();
            self.mouse.send(now_ns, &[PRESSED], PRESSURE).expect("sent");
            self.net.advance(SECOND / 10);
            self.samples.newest().map(|sample| sample.message.in_range)
        }
    }

    #[test]
    fn another_stylus_silences_the_mouse_for_a_second() {
        let mut desk = Desk::new();
        let pen = Origin {
            source: 2,
            epoch: 1,
        };
        let topic = desk.topics.sample("pen");
        let mut pen = Sender::new(&desk.net.bus(), &topic, Qos::RealTime, pen).expect("a pen");
        assert_eq!(desk.turn(), Some(true));
        let near = StylusSample {
            in_range: true,
            ..StylusSample::away()
        };
        pen.send(0, 0, &near).expect("sent");
        desk.turn();
        assert_eq!(desk.turn(), Some(false), "it says that it is out of range");
        for _ in 0..9 {
            assert_eq!(desk.turn(), None);
        }
        assert_eq!(desk.turn(), Some(true));
    }

    #[test]
    fn another_brush_is_taken_after_the_first_was_put_down() {
        let mut desk = Desk::new();
        desk.mouse.send(SECOND, &[PRESSED], PRESSURE).expect("sent");
        for brush in ["main", "second", "second"] {
            desk.mouse.take(SECOND + 1, brush).expect("told");
        }
        desk.net.advance(SECOND / 10);
        let mut told: Vec<String> = std::iter::from_fn(|| desk.infos.try_recv())
            .map(|info| info.message.brush)
            .collect();
        // Late joiners get the last message once more.
        told.dedup();
        assert_eq!(told, ["main", "second"]);
        let ranges: Vec<bool> = std::iter::from_fn(|| desk.samples.try_recv())
            .map(|sample| sample.message.in_range)
            .collect();
        assert_eq!(ranges, [true, false]);
    }

    #[test]
    fn a_stroke_goes_on_over_a_frame_however_long_it_is() {
        let mut desk = Desk::new();
        let at = |x: f64| Pointer {
            at: [x, 0.0, 0.0],
            pressed: true,
            twist_rad: x,
        };
        let mut send = |now_ns: u64, places: &[Pointer]| {
            desk.mouse.send(now_ns, places, PRESSURE).expect("sent");
        };
        send(SECOND, &[at(0.0)]);
        let slow = 4 * SECOND;
        send(slow, &[at(0.01), at(0.06)]);
        desk.net.advance(SECOND / 10);
        let mut heard = Vec::new();
        while let Some(sample) = desk.samples.try_recv() {
            let StylusPose::Contact {
                point_m,
                pressure,
                twist_rad,
                ..
            } = sample.message.pose
            else {
                panic!("no contact");
            };
            assert!(pressure == PRESSURE && twist_rad == point_m[0]);
            heard.push((sample.header.event_ns, point_m[0]));
        }
        assert_eq!((heard.len(), heard[heard.len() - 1]), (13, (slow, 0.06)));
        for pair in heard.windows(2) {
            let [(from_ns, from), (to_ns, to)] = [pair[0], pair[1]];
            assert!(to_ns - from_ns <= BRIDGED_NS && to > from, "{heard:?}");
        }
        // In the air it leaps.
        for (now_ns, x) in [(slow + 1, 0.0), (slow + SECOND, 0.02)] {
            let lifted = Pointer {
                pressed: false,
                ..at(x)
            };
            desk.mouse.send(now_ns, &[lifted], PRESSURE).expect("sent");
        }
        desk.net.advance(SECOND / 10);
        assert_eq!(std::iter::from_fn(|| desk.samples.try_recv()).count(), 2);
    }

    #[test]
    fn a_pointer_that_rests_in_the_air_is_sent_once() {
        let mut desk = Desk::new();
        let hovers = |x: f64| Pointer {
            at: [x, 0.0, 0.0],
            pressed: false,
            ..PRESSED
        };
        let frames = [0.0, 0.0, 0.0, 0.01, 0.01].map(hovers);
        for (number, place) in frames.iter().enumerate() {
            let now_ns = SECOND + 16_000_000 * number as u64;
            desk.mouse.send(now_ns, &[*place], PRESSURE).expect("sent");
        }
        desk.net.advance(SECOND / 10);
        assert_eq!(std::iter::from_fn(|| desk.samples.try_recv()).count(), 2);
    }

    #[test]
    fn what_is_moved_in_a_long_frame_is_spread_over_it() {
        let mut desk = Desk::new();
        for frame in 1..=3 {
            let now_ns = SECOND + frame * 80_000_000;
            let sent = desk.mouse.send(now_ns, &[PRESSED; 8], PRESSURE);
            sent.expect("sent");
        }
        desk.net.advance(SECOND / 10);
        let times: Vec<u64> = std::iter::from_fn(|| desk.samples.try_recv())
            .map(|sample| sample.header.event_ns)
            .collect();
        let steps = times.windows(2).skip(7).map(|pair| pair[1] - pair[0]);
        assert_eq!(times.len(), 24);
        for step in steps {
            assert_eq!(step, 10_000_000);
        }
    }
}
