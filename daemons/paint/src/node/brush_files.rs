//! Files of the brushes, as their nodes announce them.

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_painting::Sequencer;
use maulstick_types::brush::BrushDef;
use maulstick_types::name_hash;
use maulstick_types::wire::topics::{Topics, check_name};

use super::outputs::CreditPublisher;

/// Announced files, and those that wait to be adopted.
pub(super) struct BrushFiles {
    topics: Topics,
    announced: Receiver<BrushDef>,
    /// Other files of known brushes, by name, until something is done with them.
    waiting: BTreeMap<String, BrushFile>,
    /// Files that were rejected.
    refused: u64,
}

impl BrushFiles {
    /// Subscribes.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let (topic, queue) = (topics.brush_def("*"), Queue::Ring(64));
        Ok(Self {
            topics: topics.clone(),
            announced: Receiver::new(bus, &topic, Qos::Cached, queue, wake)?,
            waiting: BTreeMap::new(),
            refused: 0,
        })
    }

    /// Introduces new brushes to the painting, and confirms files to their nodes.
    pub(super) fn drain(&mut self, sequencer: &mut Sequencer, credit: &mut CreditPublisher) {
        while let Some(def) = self.announced.try_recv() {
            let (key, def) = (&def.key, &def.message);
            // Its brush is the one of the topic, whose name is short.
            let brush = self.topics.middle(key).unwrap_or_default().to_owned();
            let refusal = match (check_name(&brush), BrushFile::parse(&def.toml)) {
                (Err(error), _) => error.to_string(),
                (Ok(()), Err(error)) => error.to_string(),
                (Ok(()), Ok(_)) if def.brush != brush => "it names another brush".to_owned(),
                (Ok(()), Ok(file)) if sequencer.painting().knows_brush(&brush) => {
                    credit.confirm(name_hash(&brush), name_hash(&def.toml));
                    self.waiting.insert(brush, file);
                    continue;
                }
                (Ok(()), Ok(file)) => match sequencer.define_brush(&brush, file) {
                    Ok(()) => {
                        credit.confirm(name_hash(&brush), name_hash(&def.toml));
                        continue;
                    }
                    Err(error) => format!("{error}: {}", error.advice()),
                },
            };
            self.refused += 1;
            tracing::warn!("{key}: the brush file is rejected: {refusal}");
        }
    }

    /// Gives known brushes the files that wait.
    pub(super) fn adopt(&mut self, sequencer: &mut Sequencer) {
        for (brush, file) in std::mem::take(&mut self.waiting) {
            // It is known, so there is room for it.
            if let Err(error) = sequencer.define_brush(&brush, file) {
                tracing::error!("{brush}: {error}");
            }
        }
    }

    /// Files that were rejected.
    pub(super) fn refused(&self) -> u64 {
        self.refused
    }
}
