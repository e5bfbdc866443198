//! Requests about the force of a device: followed, answered, and said with the name of who asked.

use maulstick_bus::Server;
use maulstick_bus::typed::Reader;
use maulstick_haptics::Switch;
use maulstick_types::haptics::{ForceOrder, ForceReply, ForceRequest};
use maulstick_types::{Flags, Origin, encode, plain};

use super::Daemon;
use crate::senders::Consent;

/// Time between two lines about shares that the same hand drags to and fro, ns.
const SHARES_PERIOD_NS: u64 = 1_000_000_000;

/// Requests to a device.
pub(super) struct Orders {
    server: Server,
    reader: Reader,
    log: OrderLog,
}

impl Orders {
    pub(super) fn new(server: Server) -> Self {
        Self {
            server,
            reader: Reader::default(),
            log: OrderLog::default(),
        }
    }
}

/// Requests as they are said.
#[derive(Debug, Default)]
struct OrderLog {
    /// When a share was said last, ns, and by whom it was asked.
    shared: Option<(u64, String)>,
    /// A share that is not yet said.
    unsaid: Option<ForceRequest>,
}

impl OrderLog {
    /// What is to be said of a request that has changed something: of many shares in a row the first, one a second, and
    /// the last one.
    fn note(&mut self, request: ForceRequest, now_ns: u64) -> Option<ForceRequest> {
        let is_share = matches!(
            request.order,
            ForceOrder::Strength { .. } | ForceOrder::Guidance { .. }
        );
        if !is_share {
            return Some(request);
        }
        let goes_on = self.shared.as_ref().is_some_and(|(said_ns, asker)| {
            *asker == request.asker && now_ns < said_ns + SHARES_PERIOD_NS
        });
        if goes_on {
            self.unsaid = Some(request);
            return None;
        }
        self.unsaid = None;
        self.shared = Some((now_ns, request.asker.clone()));
        Some(request)
    }

    /// A share that has waited for its line.
    fn due(&mut self, now_ns: u64) -> Option<ForceRequest> {
        let (said_ns, _) = self.shared.as_ref()?;
        match now_ns >= said_ns + SHARES_PERIOD_NS {
            true => self.unsaid.take(),
            false => None,
        }
    }
}

impl Daemon {
    /// Follows the requests that have come, and answers each with the resulting state.
    pub(super) fn obey(&mut self, now_ns: u64) {
        while let Some(request) = self.orders.server.try_recv() {
            let read = self
                .orders
                .reader
                .read::<ForceRequest>(&request.key, &request.bytes);
            let Some((_, asked)) = read else { continue };
            let mut refusal = None;
            let is_news = match asked.order {
                ForceOrder::Off => self.switch(Switch::Off),
                ForceOrder::On => self.switch(Switch::On),
                ForceOrder::Strength { share } => {
                    let share = share_of(share);
                    std::mem::replace(&mut self.control.strength, share) != share
                }
                ForceOrder::Guidance { share } => {
                    let share = share_of(share);
                    std::mem::replace(&mut self.control.guidance, share) != share
                }
                ForceOrder::Rearm => {
                    self.control.rearms += 1;
                    self.told.faults.clear();
                    self.latched = None;
                    true
                }
                ForceOrder::Drive { source, epoch } => {
                    let consent = self.senders.consent(Origin { source, epoch }, now_ns);
                    if consent == Consent::Refused {
                        refusal = Some("too many programs move this hand".to_owned());
                    }
                    consent == Consent::Given
                }
            };
            self.tell_control();
            if let Some(servo) = &mut self.servo {
                servo.controls.write(self.control);
            }
            if !matches!(asked.order, ForceOrder::Drive { .. }) {
                self.write_state();
            }
            if is_news && let Some(said) = self.orders.log.note(asked, now_ns) {
                self.say(&said);
            }
            let reply = ForceReply {
                is_on: self.control.switch == Switch::On,
                strength: self.control.strength,
                fault: refusal.unwrap_or_else(|| self.fault()),
                guidance: self.control.guidance,
            };
            let me = self.samples.origin();
            match encode(&me, Flags::NONE, 0, now_ns, now_ns, &reply) {
                Ok(bytes) => {
                    if let Err(error) = request.answer(bytes) {
                        tracing::debug!("a client is gone: {error}");
                    }
                }
                Err(error) => tracing::error!("an order cannot be answered: {error}"),
            }
        }
        if let Some(said) = self.orders.log.due(now_ns) {
            self.say(&said);
        }
    }

    /// Switches the force; true if that changes it.
    fn switch(&mut self, to: Switch) -> bool {
        std::mem::replace(&mut self.control.switch, to) != to
    }

    /// Says what was done, and who asked for it.
    fn say(&self, request: &ForceRequest) {
        let percent = |share: f64| (100.0 * share_of(share)).round();
        let what = match request.order {
            ForceOrder::Off => "force off".to_owned(),
            ForceOrder::On => "force on".to_owned(),
            ForceOrder::Strength { share } => format!("force {} %", percent(share)),
            ForceOrder::Guidance { share } => format!("guidance {} %", percent(share)),
            ForceOrder::Rearm => "force re-armed".to_owned(),
            ForceOrder::Drive { source, .. } => {
                format!("another program (source {source:08x}) may move the hand")
            }
        };
        let asker = match request.asker.as_str() {
            "" => "a program without a name",
            asker => asker,
        };
        let device = &self.settings.device.name;
        tracing::info!("{device}: {what}, asked by {}", plain(asker));
    }
}

/// A share from 0 to 1; NaN counts as 0.
fn share_of(share: f64) -> f64 {
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn of_shares_that_a_hand_drags_the_first_and_the_last_are_said_and_all_else_at_once() {
        let mut orders = OrderLog::default();
        let share = |share: f64| ForceRequest::by("hand", ForceOrder::Strength { share });
        let mut said = Vec::new();
        for ms in 0..1500 {
            said.extend(orders.due(ms * MS));
            if ms < 700 {
                said.extend(orders.note(share(ms as f64 / 1e3), ms * MS));
            }
            if ms == 300 {
                let off = ForceRequest::by("hand", ForceOrder::Off);
                assert!(orders.note(off, ms * MS).is_some());
            }
        }
        assert_eq!(said, [share(0.0), share(0.699)]);
    }
}
