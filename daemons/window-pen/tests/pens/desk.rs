//! A desk that is shown in a window, and who hears the pen there.

use std::sync::Arc;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_types::Origin;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample};
use maulstick_types::wire::topics::Topics;
use maulstick_window_pen::{DeskView, PenLink, WindowStylus};

/// The panel lies to the right of this, pixels.
pub(crate) const PANEL: f64 = 500.0;
/// A pixel on the desk, m.
pub(crate) const PIXEL_M: f64 = 1e-3;

/// A window of 1,000 pixels: desk to the left, panel to the right.
#[derive(Default)]
pub(crate) struct Window {
    pub(crate) mirrored: bool,
    /// A key is held that makes something else of a touch.
    pub(crate) key: bool,
}

impl DeskView for Window {
    fn is_desk(&self, [x, y]: [f64; 2]) -> bool {
        (0.0..PANEL).contains(&x) && y >= 0.0
    }

    fn to_desk(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        [PIXEL_M * x, -PIXEL_M * y, 0.0]
    }

    fn takes_strokes(&self) -> bool {
        !self.key
    }

    fn is_mirrored(&self) -> bool {
        self.mirrored
    }
}

/// A bus, and who hears the pen.
pub(crate) struct Desk {
    pub(crate) net: MemoryNet,
    pub(crate) link: PenLink,
    pub(crate) samples: Receiver<StylusSample>,
    pub(crate) infos: Receiver<StylusInfo>,
}

/// A sample in a few words: where, m, how hard, and whether it is in range.
pub(crate) type Heard = ([f64; 2], f64, bool);

impl Desk {
    pub(crate) fn new() -> (Self, WindowStylus) {
        let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
        let (bus, topics, wake) = (net.bus(), Topics::new("t"), Wake::new());
        let me = Origin {
            source: 1,
            epoch: 1,
        };
        let link = PenLink::default();
        link.show(Some(Arc::new(Window::default())), "main");
        link.set_moves_no_pointer();
        let bus: Arc<dyn Bus> = Arc::new(bus);
        let hand = WindowStylus::new(Arc::clone(&bus), &topics, ("pen", me), link.clone());
        let all = Queue::Ring(100_000);
        let samples = Receiver::new(&*bus, &topics.sample("pen"), Qos::RealTime, all, &wake);
        let infos = Receiver::new(&*bus, &topics.stylus_info("pen"), Qos::Cached, all, &wake);
        let desk = Self {
            net,
            link,
            samples: samples.expect("a receiver"),
            infos: infos.expect("a receiver"),
        };
        (desk, hand.expect("a hand"))
    }

    /// All samples since the last call.
    pub(crate) fn heard(&mut self) -> Vec<(u64, StylusSample)> {
        self.net.advance(1_000_000);
        let next = || self.samples.try_recv();
        std::iter::from_fn(next)
            .map(|sample| (sample.header.event_ns, sample.message))
            .collect()
    }
}

/// The pose of a pen's sample: point, tilt, twist, pressure.
pub(crate) fn contact(sample: &StylusSample) -> ([f64; 3], [f64; 2], f64, f64) {
    match sample.pose {
        StylusPose::Contact {
            point_m,
            tilt_rad,
            twist_rad,
            pressure,
        } => (point_m, tilt_rad, twist_rad, pressure),
        StylusPose::Ferrule { .. } => unreachable!("a pen has no ferrule"),
    }
}

/// A sample in a few words.
pub(crate) fn words(sample: &StylusSample) -> Heard {
    let ([x, y, _], _, _, pressure) = contact(sample);
    ([x, y], pressure, sample.in_range)
}
