//! Scenes, each followed once the samples from before it are solved.

use maulstick_bus::typed::{Received, Receiver};
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::scene::Scene;
use maulstick_types::wire::topics::Topics;

/// The scenes of the painting.
pub(super) struct SceneFeed {
    scenes: Receiver<Scene>,
    /// A scene that waits for samples from before it.
    waiting: Option<Received<Scene>>,
    /// When the followed scene was sent, ns.
    sent_ns: u64,
}

/// Time at which a scene was sent; never later than it arrived.
fn sent_ns(scene: &Received<Scene>) -> u64 {
    scene.header.sent_ns.min(scene.arrived_ns)
}

impl SceneFeed {
    /// Subscribes.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let queue = Queue::Ring(16);
        let scenes = Receiver::new(bus, &topics.scene(), Qos::Cached, queue, wake)?;
        Ok(Self {
            scenes: scenes.checking(Scene::fault),
            waiting: None,
            sent_ns: 0,
        })
    }

    /// The next scene that is not older than the followed one: of another painting the version may be lower.
    pub(super) fn next(&mut self) -> Option<Received<Scene>> {
        loop {
            let scene = self.waiting.take().or_else(|| self.scenes.try_recv())?;
            if sent_ns(&scene) >= self.sent_ns {
                return Some(scene);
            }
        }
    }

    /// Puts a scene back until the next turn.
    pub(super) fn put_back(&mut self, scene: Received<Scene>) {
        self.waiting = Some(scene);
    }

    /// Notes that a scene is followed from now on.
    pub(super) fn follow(&mut self, scene: &Received<Scene>) {
        self.sent_ns = sent_ns(scene);
    }

    /// Time of the waiting scene, ns: only samples before it are consumed.
    pub(super) fn waiting_ns(&self) -> Option<u64> {
        self.waiting.as_ref().map(|scene| scene.header.event_ns)
    }
}
