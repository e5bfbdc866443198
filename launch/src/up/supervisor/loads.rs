//! Loads of the brushes when a painting begins.

use std::sync::Arc;
use std::time::Duration;

use maulstick_painting::edits::Load;
use maulstick_rig::UserError;
use maulstick_rig::command_client::CommandClient;
use maulstick_types::values::BrushName;

use super::Supervisor;

/// Longest wait until the paint node has loaded a brush.
const LOAD_TIME: Duration = Duration::from_secs(10);

impl Supervisor {
    /// Loads the brushes as soon as paint and all brushes are there, at the start and whenever paint
    /// was started again. A take that is played brings its own loads.
    pub(super) fn load_when_ready(&mut self) {
        if self.unloaded && self.ready() {
            self.unloaded = false;
            if self.conductor.is_none() {
                self.load_brushes();
            }
        }
    }

    /// Gives the painter loaded brushes. The commands run by themselves: nothing waits for them.
    fn load_brushes(&self) {
        let (bus, topics) = (Arc::clone(&self.bus), self.topics.clone());
        let brushes: Vec<String> = self.config.brush.iter().map(|b| b.name.clone()).collect();
        let Some(mixture) = self.first_load.clone() else {
            return;
        };
        let stop = self.stop.clone();
        let load = move || {
            let mut commander = CommandClient::new(bus, &topics);
            for brush in brushes {
                let load = BrushName::new(brush).map(|brush| Load {
                    mixture: mixture.clone(),
                    beside: None,
                    brush,
                });
                let loaded = load
                    .map_err(UserError::from)
                    .and_then(|load| commander.send(load, None, LOAD_TIME, &|| stop.requested()));
                if let Err(fault) = loaded {
                    tracing::warn!("{}", fault.what);
                }
            }
        };
        if let Err(error) = std::thread::Builder::new().name("load".into()).spawn(load) {
            tracing::warn!("the brushes cannot be loaded: {error}");
        }
    }
}
