//! Playback: the transport, the orders that change it, and the reports of where it is.

use std::collections::VecDeque;
use std::time::Duration;

use maulstick_bus::Wake;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender};
use tokio::time::{Instant, sleep};

use super::report::{Position, ReplayReport};
use super::settings::ReplaySettings;
use super::transport::{Order, Transport};

/// Time between two reports of where it is.
pub(super) const REPORT_PERIOD: Duration = Duration::from_millis(200);

/// Orders from the owner of a player, and reports to it.
#[derive(Debug)]
pub(super) struct Controls {
    orders: UnboundedReceiver<Order>,
    /// Orders that came while its task waited.
    waiting: VecDeque<Order>,
    reports: UnboundedSender<ReplayReport>,
}

impl Controls {
    pub(super) fn new(
        orders: UnboundedReceiver<Order>,
        reports: UnboundedSender<ReplayReport>,
    ) -> Self {
        Self {
            orders,
            waiting: VecDeque::new(),
            reports,
        }
    }

    /// The next order, if there is one.
    pub(super) fn next(&mut self) -> Option<Order> {
        let waiting = self.waiting.pop_front();
        waiting.or_else(|| self.orders.try_recv().ok())
    }

    /// True once the end was ordered; the orders before it are still to be carried out.
    pub(super) fn is_end_ordered(&mut self) -> bool {
        self.waiting
            .extend(std::iter::from_fn(|| self.orders.try_recv().ok()));
        self.waiting.contains(&Order::End)
    }

    /// Waits for an order, a ring of `wake`, or the end of the time.
    pub(super) async fn wait(&mut self, wake: &Wake, at_most: Duration) {
        if !self.waiting.is_empty() {
            return;
        }
        tokio::select! {
            order = self.orders.recv(), if !self.orders.is_closed() => self.waiting.extend(order),
            () = wake.ringing() => {}
            () = sleep(at_most) => {}
        }
    }

    /// Reports to the owner; one that has gone needs to know nothing.
    pub(super) fn report(&self, report: ReplayReport) {
        self.reports.send(report).ok();
    }
}

/// A replay in progress.
#[derive(Debug)]
pub(super) struct Playback {
    pub(super) transport: Transport,
    pub(super) controls: Controls,
    begun: Instant,
    reported: Option<Instant>,
}

/// A leap of a replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leap {
    /// To before what was played.
    Back,
    /// Over what is between.
    Forth,
}

/// Next step of a player after its orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// To play on.
    On,
    /// To go on elsewhere.
    Leap(Leap),
    /// To end.
    End,
}

impl Playback {
    pub(super) fn new(settings: &ReplaySettings, range_ns: [u64; 2], controls: Controls) -> Self {
        Self {
            transport: Transport::new(range_ns, settings.rate, settings.paused),
            controls,
            begun: Instant::now(),
            reported: None,
        }
    }

    /// Carries out the orders that came, and lets the transport go on; the times are those of the next event, and of the
    /// newest one that was played.
    pub(super) fn follow(&mut self, next_ns: Option<u64>, played_ns: u64) -> Next {
        self.transport.look(self.begun.elapsed().as_nanos() as u64);
        let mut leaps = false;
        while let Some(order) = self.controls.next() {
            if order == Order::End {
                return Next::End;
            }
            leaps |= matches!(order, Order::Seek(_) | Order::Skip(_));
            self.transport.wait_for(next_ns);
            self.transport.order(order, next_ns);
            self.reported = None;
            if order == Order::Step {
                break;
            }
        }
        self.report(next_ns);
        match (leaps, self.transport.position_ns() < played_ns) {
            (false, _) => Next::On,
            (true, true) => Next::Leap(Leap::Back),
            (true, false) => Next::Leap(Leap::Forth),
        }
    }

    /// Waits until the next event is due, for an order, a ring of the bus, or the next report.
    pub(super) async fn wait(&mut self, next_ns: Option<u64>, wake: &Wake, at_most: Duration) {
        let due_ns = next_ns.unwrap_or(self.transport.end_ns());
        let due = self.transport.time_to(due_ns);
        let at_most = due.unwrap_or(REPORT_PERIOD).min(REPORT_PERIOD).min(at_most);
        self.controls.wait(wake, at_most).await;
    }

    /// Reports where it is, at most five times a second.
    fn report(&mut self, next_ns: Option<u64>) {
        let is_recent = |reported: Instant| reported.elapsed() < REPORT_PERIOD;
        if self.reported.is_some_and(is_recent) {
            return;
        }
        self.reported = Some(Instant::now());
        let position_ns = self.transport.position_ns();
        let position_ns = next_ns.map_or(position_ns, |next_ns| position_ns.min(next_ns));
        self.controls.report(ReplayReport::Position(Position {
            position_s: position_ns as f64 * 1e-9,
            length_s: self.transport.end_ns() as f64 * 1e-9,
            rate: self.transport.rate(),
            paused: self.transport.is_paused(),
        }));
    }
}

#[cfg(test)]
mod tests {
    use tokio::sync::mpsc::unbounded_channel;

    use super::*;

    #[test]
    fn an_end_is_seen_before_the_orders_that_came_first_are_carried_out() {
        let (to_player, orders) = unbounded_channel();
        let mut controls = Controls::new(orders, unbounded_channel().0);
        to_player.send(Order::Seek(3.0)).expect("open");
        assert!(!controls.is_end_ordered());
        to_player.send(Order::End).expect("open");
        assert!(controls.is_end_ordered());
        let all: Vec<Order> = std::iter::from_fn(|| controls.next()).collect();
        assert_eq!(all, [Order::Seek(3.0), Order::End]);
    }
}
