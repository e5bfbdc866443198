//! Pace of a replay that goes as fast as it can: no more samples are on their way than the brushes have credit for, so that
//! what is played is painted, and nothing else waits behind it.

use std::collections::BTreeMap;
use std::time::Duration;

use maulstick_bus::credit::{RETRY_NS, WINDOW};
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::Origin;
use maulstick_types::brush::BrushConsumed;
use maulstick_types::wire::topics::Topics;

/// A brush that consumed something and then nothing for so long is gone, ns: live samples wait for nobody for ever.
const GONE_NS: u64 = 1_000_000_000;

/// Samples that were sent, and those of them that brushes have consumed.
pub(super) struct Pacing {
    consumed: Receiver<BrushConsumed>,
    streams: BTreeMap<Origin, Stream>,
}

/// Samples of a device.
#[derive(Clone, Copy, Debug, Default)]
struct Stream {
    /// Number of the next one.
    next: u64,
    /// Those below are consumed, or given up.
    consumed: u64,
    /// True once a brush has consumed some.
    is_followed: bool,
    /// When something was consumed, or sent after all was.
    progress_ns: u64,
}

impl Stream {
    /// Longest wait for credit: samples that no brush follows go on by the window, not all at once.
    fn patience_ns(&self) -> u64 {
        if self.is_followed { GONE_NS } else { RETRY_NS }
    }
}

impl Pacing {
    /// Listens to the brushes.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(super) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let (topic, queue) = (topics.brush_consumed("*"), Queue::Ring(256));
        Ok(Self {
            consumed: Receiver::new(bus, &topic, Qos::Control, queue, wake)?,
            streams: BTreeMap::new(),
        })
    }

    /// A sample of a device was sent, and the next one has the number `next`.
    pub(super) fn sent(&mut self, device: Origin, next: u64, now_ns: u64) {
        let stream = self.streams.entry(device).or_default();
        if stream.consumed == stream.next {
            stream.progress_ns = now_ns;
        }
        stream.next = next;
    }

    /// Time to wait for credit, unless some comes before; `None` where another sample may be sent: fewer than the window of
    /// each device are on their way.
    pub(super) fn wait_for_credit(&mut self, now_ns: u64) -> Option<Duration> {
        while let Some(told) = self.consumed.try_recv() {
            let told = told.message;
            let device = Origin {
                source: told.device,
                epoch: told.device_epoch,
            };
            if let Some(stream) = self.streams.get_mut(&device)
                && told.next > stream.consumed
                && told.next <= stream.next
            {
                (stream.consumed, stream.progress_ns) = (told.next, now_ns);
                stream.is_followed = true;
            }
        }
        for stream in self.streams.values_mut() {
            if now_ns.saturating_sub(stream.progress_ns) > stream.patience_ns() {
                (stream.consumed, stream.progress_ns) = (stream.next, now_ns);
            }
        }
        let full = self.streams.values();
        let full = full.filter(|stream| stream.next - stream.consumed >= WINDOW);
        let left_ns = full.map(|stream| {
            let gone_ns = stream.progress_ns + stream.patience_ns() + 1;
            gone_ns.saturating_sub(now_ns)
        });
        left_ns.max().map(Duration::from_nanos)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::typed::Sender;
    use maulstick_bus::{Faults, MemoryNet};

    use super::*;

    const DEVICE: Origin = Origin {
        source: 1,
        epoch: 2,
    };
    const BRUSH: Origin = Origin {
        source: 3,
        epoch: 4,
    };
    const MS: u64 = 1_000_000;

    /// Samples that are sent in so long, ms, while a brush consumes `each_ms` of them each millisecond.
    fn sent_in(ms: u64, each_ms: Option<u64>) -> u64 {
        let net = MemoryNet::new(1, 0, Faults::default());
        let (bus, topics) = (net.bus(), Topics::new("t"));
        let mut pacing = Pacing::new(&bus, &topics, &Wake::new()).expect("a topic");
        let topic = topics.brush_consumed("main");
        let mut brush = Sender::new(&bus, &topic, Qos::Control, BRUSH).expect("a topic");
        let (mut next, mut consumed) = (0, 0);
        for _ in 0..ms {
            // A thousand times as fast as a hand.
            for _ in 0..1000 {
                if pacing.wait_for_credit(bus.now_ns()).is_none() {
                    next += 1;
                    pacing.sent(DEVICE, next, bus.now_ns());
                }
            }
            if let Some(each_ms) = each_ms {
                consumed = next.min(consumed + each_ms);
                let told = BrushConsumed {
                    device: DEVICE.source,
                    device_epoch: DEVICE.epoch,
                    next: consumed,
                    brush_epoch: BRUSH.epoch,
                    state: 0,
                };
                let now_ns = bus.now_ns();
                brush.send(now_ns, now_ns, &told).expect("sent");
            }
            net.advance(MS);
        }
        next
    }

    #[test]
    fn a_replay_is_as_fast_as_the_brush_that_follows_it() {
        let paced = sent_in(1000, Some(5));
        assert!((5000..=5000 + 2 * WINDOW).contains(&paced), "{paced}");
    }

    #[test]
    fn samples_that_no_brush_follows_go_by_the_window() {
        let unfollowed = sent_in(1000, None);
        let windows = unfollowed / WINDOW;
        assert!(
            (15..=21).contains(&windows),
            "{windows} windows in a second"
        );
    }
}
