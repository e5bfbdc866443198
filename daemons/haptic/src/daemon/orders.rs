//! Requests about the force of a device: carried out, answered, and logged with the name of who asked.

use maulstick_bus::typed::{Reader, answer};
use maulstick_bus::{Request, Server};
use maulstick_types::haptics::{ForceOrder, ForceReply, ForceRequest};
use maulstick_types::{Origin, plain};

use super::Daemon;
use super::force_settings::share_of;
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

    /// The next request that can be read.
    fn next(&mut self) -> Option<(Request, ForceRequest)> {
        while let Some(request) = self.server.try_recv() {
            let read = self
                .reader
                .read::<ForceRequest>(&request.key, &request.bytes);
            if let Some((_, asked)) = read {
                return Some((request, asked));
            }
        }
        None
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
    /// Line of the log for a request that has changed something: of many shares in a row the first, one a second, and
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
        if now_ns >= said_ns + SHARES_PERIOD_NS {
            self.unsaid.take()
        } else {
            None
        }
    }
}

/// Result of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Obeyed {
    /// It has changed something.
    Changed,
    /// It was so before.
    Unchanged,
    /// Too many programs move the hand.
    Crowded,
}

impl Daemon {
    /// Carries out the requests that have come, and answers each with the resulting state.
    pub(super) fn serve_orders(&mut self, now_ns: u64) {
        while let Some((request, asked)) = self.orders.next() {
            let obeyed = self.obey(&asked.order, now_ns);
            if obeyed == Obeyed::Changed
                && let Some(said) = self.orders.log.note(asked, now_ns)
            {
                log(self.connection.name(), &said);
            }
            let control = self.force.control();
            let reply = ForceReply {
                is_on: self.force.is_on(),
                strength: control.strength,
                fault: if obeyed == Obeyed::Crowded {
                    "too many programs move this hand".to_owned()
                } else {
                    self.output.fault()
                },
                guidance: control.guidance,
            };
            answer(request, &self.output.origin(), now_ns, &reply);
        }
        if let Some(said) = self.orders.log.due(now_ns) {
            log(self.connection.name(), &said);
        }
    }

    /// Carries out an order.
    fn obey(&mut self, order: &ForceOrder, now_ns: u64) -> Obeyed {
        if let ForceOrder::Drive { source, epoch } = *order {
            return match self.inlets.consent(Origin { source, epoch }, now_ns) {
                Consent::Given => Obeyed::Changed,
                Consent::Renewed => Obeyed::Unchanged,
                Consent::Refused => Obeyed::Crowded,
            };
        }
        let is_new = self.force.obey(order);
        let status = self.output.status_mut();
        if self.force.fault().is_none() {
            status.faults.clear();
        }
        self.force.report(status);
        self.connection.set_control(self.force.control());
        self.force.write();
        if is_new {
            Obeyed::Changed
        } else {
            Obeyed::Unchanged
        }
    }
}

/// Logs what was done to a device, and who asked for it.
fn log(device: &str, request: &ForceRequest) {
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
    tracing::info!("{device}: {what}, asked by {}", plain(asker));
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
