//! States of the brushes and presence of the nodes, as the paint node receives them.

use maulstick_bus::credit::ReceiverCounts;
use maulstick_bus::sender_arbiter::Once;
use maulstick_bus::typed::Received;
use maulstick_bus::{Bus, BusError, CreditReceiver, Subscription, Wake};
use maulstick_painting::{EditError, Painting};
use maulstick_types::brush::BrushState;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Header, Origin, name_hash};

/// Wait of a state from which the log names a brush without a file, ns.
const UNKNOWN_NS: u64 = 100_000_000;

/// A node that came or went.
pub(super) struct Presence {
    /// Hash of its name.
    pub(super) node: u32,
    pub(super) is_there: bool,
}

/// The next state of a brush.
pub(super) enum NextState {
    /// None can be consumed now.
    None,
    /// One of a sender that uses another brush's topic is dropped.
    Foreign,
    /// One of a known brush.
    Of {
        brush: String,
        received: Received<BrushState>,
    },
}

/// Receivers of states and presence.
pub(super) struct Inputs {
    topics: Topics,
    states: CreditReceiver<BrushState>,
    tokens: Subscription,
    /// States that were rejected.
    refused: u64,
    /// Brushes without a file that the log names.
    unknown: Once,
    /// Topics with states that do not fit that the log names.
    misfits: Once,
    /// Topics with a foreign sender that the log names.
    foreign: Once,
}

impl Inputs {
    /// Subscribes.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            topics: topics.clone(),
            states: CreditReceiver::new(bus, topics, &topics.brush_state("*"), me, wake)?,
            tokens: bus.watch(&topics.node("*"), wake)?,
            refused: 0,
            unknown: Once::default(),
            misfits: Once::default(),
            foreign: Once::default(),
        })
    }

    /// The next node that came or went.
    pub(super) fn next_presence(&mut self) -> Option<Presence> {
        let token = self.tokens.try_recv()?;
        Some(Presence {
            node: name_hash(self.topics.node_of(&token.key).unwrap_or_default()),
            is_there: token.present,
        })
    }

    /// Takes in arrived states and asks for missing ones.
    pub(super) fn poll(&mut self, bus: &dyn Bus) -> Result<(), BusError> {
        self.states.poll(bus)
    }

    /// True if a brush has missed what was consumed of its states.
    pub(super) fn take_unheard(&mut self) -> bool {
        !self.states.unheard().is_empty()
    }

    /// Takes the next state of a known brush. A brush whose file has not come waits, and holds up no other.
    pub(super) fn next_state(&mut self, painting: &Painting) -> NextState {
        let topics = &self.topics;
        let is_known = |next: &Received<BrushState>| is_known(topics, painting, &next.key);
        let Some(received) = self.states.pop_where(is_known) else {
            return NextState::None;
        };
        if !is_own(topics, &received) {
            self.refused += 1;
            if self.foreign.say(&received.key) {
                tracing::warn!("{}: a stranger's states are dropped", received.key);
            }
            return NextState::Foreign;
        }
        let brush = topics.middle(&received.key).unwrap_or_default().to_owned();
        NextState::Of { brush, received }
    }

    /// The states of a brush that wait, the oldest first.
    pub(super) fn queued(&self, brush: Origin) -> impl Iterator<Item = (&Header, &BrushState)> {
        let waiting = self.states.waiting(brush);
        let own = waiting.filter(|state| is_own(&self.topics, state));
        own.map(|state| (&state.header, &state.message))
    }

    /// Counts a state that does not fit the painting.
    pub(super) fn reject(&mut self, topic: &str, error: &EditError) {
        self.refused += 1;
        if self.misfits.say(topic) {
            tracing::warn!("{topic}: {error}: {}", error.advice());
        }
    }

    /// Names brushes in the log that move without a brush file.
    pub(super) fn warn_of_unknown(&mut self, painting: &Painting, now_ns: u64) {
        for next in self.states.heads() {
            let brush = self.topics.middle(&next.key).unwrap_or_default();
            let waits = now_ns.saturating_sub(next.arrived_ns) > UNKNOWN_NS;
            if waits && !painting.knows_brush(brush) && self.unknown.say(brush) {
                tracing::warn!("{}: its brush file has not come, its states wait", next.key);
            }
        }
    }

    /// Brushes that wait to be painted, and those whose file has not come.
    pub(super) fn waiting(&self, painting: &Painting) -> (u64, u64) {
        let heads = self.states.heads();
        let is_known = |next: &&Received<BrushState>| is_known(&self.topics, painting, &next.key);
        let (waiting, held): (Vec<_>, Vec<_>) = heads.partition(is_known);
        (waiting.len() as u64, held.len() as u64)
    }

    /// Age of the oldest state that waits, ns.
    pub(super) fn lag_ns(&self, now_ns: u64) -> u64 {
        let oldest_ns = self.states.heads().map(|next| next.header.event_ns).min();
        oldest_ns.map_or(0, |oldest_ns| now_ns.saturating_sub(oldest_ns))
    }

    /// Counts of the states.
    pub(super) fn counts(&self) -> ReceiverCounts {
        self.states.counts()
    }

    /// States that were not obeyed.
    pub(super) fn refused(&self) -> u64 {
        self.refused + self.states.counts().refused
    }
}

fn is_known(topics: &Topics, painting: &Painting, key: &str) -> bool {
    let brush = topics.middle(key);
    brush.is_some_and(|brush| painting.knows_brush(brush))
}

/// True for a state by the brush of its topic: credit and places in the journal are by the hash of the brush's name.
fn is_own(topics: &Topics, state: &Received<BrushState>) -> bool {
    let brush = topics.middle(&state.key).unwrap_or_default();
    name_hash(brush) == state.header.source
}
