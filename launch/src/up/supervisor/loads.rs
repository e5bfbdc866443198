//! Loads of the brushes when a painting begins.

use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::Bus;
use maulstick_painting::edits::common;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::{RigConfig, Stop, UserError};
use maulstick_types::Mixture;
use maulstick_types::wire::topics::Topics;
use tokio::task::spawn_blocking;

/// Longest wait until the paint node has loaded a brush.
const LOAD_TIME: Duration = Duration::from_secs(10);

/// Loads of the brushes.
#[derive(Debug)]
pub(super) struct Loads {
    /// The load of a new painting's brushes; `None` where they keep theirs.
    pub(super) first: Option<Mixture>,
    /// True while paint has clean brushes, or is about to start with them: the painter's are to be loaded.
    pub(super) are_due: bool,
}

impl Loads {
    /// Loads the painter's brushes, if due. The commands run in the background.
    pub(super) fn send(
        &mut self,
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        config: &RigConfig,
        stop: &Stop,
    ) {
        self.are_due = false;
        let Some(mixture) = self.first.clone() else {
            return;
        };
        let brushes: Vec<String> = config.brush.iter().map(|own| own.name.clone()).collect();
        let (mut client, stop) = (CommandClient::new(Arc::clone(bus), topics), stop.clone());
        spawn_blocking(move || {
            for brush in brushes {
                let loaded = common::load(&brush, mixture.clone(), None)
                    .map_err(UserError::from)
                    .and_then(|load| client.send(load, None, LOAD_TIME, &|| stop.requested()));
                if let Err(fault) = loaded {
                    tracing::warn!("{}", fault.what);
                }
            }
        });
    }
}
