//! Relief below brushes, for the hands that feel it.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_painting::Painting;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushRelief, Solve};
use maulstick_types::stylus::{StylusInfo, axes};
use maulstick_types::wire::topics::Topics;

/// Least time between two reliefs below a brush, ns.
const PERIOD_NS: u64 = 15_000_000;
/// A relief that stays as it is is sent again after this time, ns: another brush node may have come.
const AGAIN_NS: u64 = 500_000_000;

/// Sends the relief below each brush while its states come, where a device of the rig gives force.
pub(super) struct BrushReliefs {
    bus: Arc<dyn Bus>,
    me: Origin,
    topics: Topics,
    infos: Receiver<StylusInfo>,
    is_felt: bool,
    brushes: BTreeMap<String, LastSent>,
}

/// State last sent of a brush.
struct LastSent {
    sender: Sender<BrushRelief>,
    sent_ns: u64,
    read_ns: u64,
    relief: Option<BrushRelief>,
    /// Where it was solved since.
    solve: Option<Solve>,
}

impl BrushReliefs {
    /// Listens for devices that give force.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let key = topics.stylus_info("*");
        Ok(Self {
            topics: topics.clone(),
            infos: Receiver::new(&*bus, &key, Qos::Cached, Queue::Ring(64), wake)?,
            is_felt: false,
            brushes: BTreeMap::new(),
            bus,
            me,
        })
    }

    /// Notes where a brush is.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn note(&mut self, brush: &str, solve: Option<&Solve>) -> Result<(), BusError> {
        while let Some(info) = self.infos.try_recv() {
            self.is_felt |= info.message.drives & axes::FORCE != 0;
        }
        if !self.is_felt {
            return Ok(());
        }
        if !self.brushes.contains_key(brush) {
            let topic = self.topics.brush_relief(brush);
            let sent = LastSent {
                sender: Sender::new(&*self.bus, &topic, Qos::RealTime, self.me)?,
                sent_ns: 0,
                read_ns: 0,
                relief: None,
                solve: None,
            };
            self.brushes.insert(brush.to_owned(), sent);
        }
        if let Some(sent) = self.brushes.get_mut(brush) {
            sent.solve = solve.cloned();
        }
        Ok(())
    }

    /// Sends what is new.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish(&mut self, painting: &Painting, now_ns: u64) -> Result<(), BusError> {
        for (brush, sent) in &mut self.brushes {
            if now_ns < sent.read_ns + PERIOD_NS {
                continue;
            }
            let solve = sent.solve.take();
            let Some(relief) = solve.and_then(|solve| painting.relief_below(brush, &solve)) else {
                continue;
            };
            sent.read_ns = now_ns;
            let is_same = sent.relief.as_ref() == Some(&relief);
            if is_same && now_ns < sent.sent_ns + AGAIN_NS {
                continue;
            }
            sent.sent_ns = now_ns;
            sent.sender.send(now_ns, now_ns, &relief)?;
            sent.relief = Some(relief);
        }
        Ok(())
    }
}
