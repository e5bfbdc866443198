//! Colours of the paint on brushes, for the windows that show them.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_brush::file::sections::Hair;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_painting::brush_colour::{Carried, hair};
use maulstick_types::Origin;
use maulstick_types::brush::BrushLook;
use maulstick_types::wire::topics::Topics;

use super::FrameState;

/// Says how the paint on brushes looks where it, or the light, has changed.
pub(super) struct BrushLooks {
    topics: Topics,
    told: BTreeMap<String, Told>,
    /// The look in which all colours were sent, and reflectances of hair under it.
    look: Option<Arc<Appearance>>,
    hair: Vec<(Hair, Vec<f32>)>,
}

/// State last sent of a brush.
struct Told {
    sender: Sender<BrushLook>,
    of: Option<Carried>,
}

impl BrushLooks {
    pub(super) fn new(topics: &Topics) -> Self {
        Self {
            topics: topics.clone(),
            told: BTreeMap::new(),
            look: None,
            hair: Vec::new(),
        }
    }

    /// Tells what is new.
    pub(super) fn publish(
        &mut self,
        bus: &dyn Bus,
        me: Origin,
        fed: &FrameState,
    ) -> Result<(), BusError> {
        let Some(look) = &fed.look else {
            return Ok(());
        };
        // Another light shows all paint anew, and so do paints that were not known.
        if !self.look.as_ref().is_some_and(|own| Arc::ptr_eq(own, look)) {
            self.told.values_mut().for_each(|told| told.of = None);
            self.hair.clear();
            self.look = Some(Arc::clone(look));
        }
        for (brush, carried) in &fed.carried {
            if !self.told.contains_key(brush) {
                let topic = self.topics.brush_look(brush);
                let sender = Sender::new(bus, &topic, Qos::Cached, me)?;
                self.told.insert(brush.clone(), Told { sender, of: None });
            }
            let Some(told) = self.told.get_mut(brush) else {
                continue;
            };
            if told.of.as_ref().is_some_and(|of| of.is(carried)) {
                continue;
            }
            if !self.hair.iter().any(|(kind, _)| *kind == carried.hair) {
                let reflectances = hair(carried.hair, &look.studio);
                self.hair.push((carried.hair, reflectances));
            }
            let found = self.hair.iter().find(|(kind, _)| *kind == carried.hair);
            let Some((_, under)) = found else { continue };
            let now = bus.now_ns();
            told.sender
                .send(now, now, &carried.look(&look.studio, under))?;
            told.of = Some(carried.clone());
        }
        Ok(())
    }
}
