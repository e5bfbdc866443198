//! Publications of the paint node but for frames: credit, relief, journal, scene, status.

mod brush_reliefs;
mod credit_publisher;

use std::sync::Arc;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Announcer, Bus, BusError, Qos, Wake};
use maulstick_painting::Sequencer;
use maulstick_types::Origin;
use maulstick_types::brush::Solve;
use maulstick_types::paint::{JournalEntry, PaintStatus};
use maulstick_types::scene::Scene;
use maulstick_types::wire::topics::Topics;

use brush_reliefs::BrushReliefs;
pub(super) use credit_publisher::CreditPublisher;

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Time between two statuses that say the same, ns: each one wakes all that listen.
const AT_REST_NS: u64 = 5 * STATUS_PERIOD_NS;

/// Senders of the paint node.
pub(super) struct Outputs {
    credit: CreditPublisher,
    reliefs: BrushReliefs,
    journal: Sender<JournalEntry>,
    scene: Announcer<Scene>,
    /// Version of the scene that was sent last.
    scene_version: u64,
    status: Sender<PaintStatus>,
    /// The status that was sent last, and its time, ns.
    last_status: Option<(PaintStatus, u64)>,
    /// Time of the last status that was due, ns.
    status_ns: u64,
}

impl Outputs {
    /// Declares all topics, and sends the scene.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        me: Origin,
        first: &Scene,
    ) -> Result<Self, BusError> {
        let b = &**bus;
        let mut scene = Announcer::new(b, &topics.scene(), me, wake)?;
        scene.send(b.now_ns(), first)?;
        Ok(Self {
            credit: CreditPublisher::new(b, topics, me)?,
            reliefs: BrushReliefs::new(Arc::clone(bus), topics, me, wake)?,
            journal: Sender::new(b, &topics.journal(), Qos::Data, me)?,
            scene,
            scene_version: first.version,
            status: Sender::new(b, &topics.paint_status(), Qos::Background, me)?,
            last_status: None,
            status_ns: 0,
        })
    }

    /// Number of journal entries sent.
    pub(super) fn entries(&self) -> u64 {
        self.journal.sent()
    }

    /// Credit of the brushes.
    pub(super) fn credit_mut(&mut self) -> &mut CreditPublisher {
        &mut self.credit
    }

    /// Notes where a brush is.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn note_solve(
        &mut self,
        brush: &str,
        solve: Option<&Solve>,
    ) -> Result<(), BusError> {
        self.reliefs.note(brush, solve)
    }

    /// Publishes credit, relief below the brushes, and new entries of the journal.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish_progress(
        &mut self,
        sequencer: &mut Sequencer,
        now_ns: u64,
    ) -> Result<(), BusError> {
        self.credit.publish(sequencer, now_ns)?;
        self.reliefs.publish(sequencer.painting(), now_ns)?;
        for entry in sequencer.drain_journal() {
            self.journal.send(now_ns, now_ns, &entry)?;
        }
        Ok(())
    }

    /// Publishes a scene of another version, and repeats it for late subscribers.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish_scene(&mut self, scene: &Scene, now_ns: u64) -> Result<(), BusError> {
        if scene.version != self.scene_version {
            self.scene_version = scene.version;
            self.scene.send(now_ns, scene)?;
        }
        self.scene.poll(now_ns)
    }

    /// True once the next status is due; it counts as looked at.
    pub(super) fn is_status_due(&mut self, now_ns: u64) -> bool {
        let is_due = now_ns >= self.status_ns + STATUS_PERIOD_NS;
        if is_due {
            self.status_ns = now_ns;
        }
        is_due
    }

    /// Makes the next status due at once.
    pub(super) fn hasten_status(&mut self) {
        self.status_ns = 0;
    }

    /// Publishes a status; one that says the same as the last only after a while.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish_status(
        &mut self,
        status: PaintStatus,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let last = self.last_status.as_ref();
        if last.is_some_and(|(last, last_ns)| *last == status && now_ns < last_ns + AT_REST_NS) {
            return Ok(());
        }
        self.status.send(now_ns, now_ns, &status)?;
        self.last_status = Some((status, now_ns));
        Ok(())
    }
}
