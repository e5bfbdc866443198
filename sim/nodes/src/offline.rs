//! The same brush and the same paint in one process, without a bus: what `maulstick render` runs.
//! The messages that would have crossed the bus are handed on directly, so the painting is the
//! same, byte for byte.

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_paint::{PaintRefusal, Painting, Sequencer};
use maulstick_types::command::Command;
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Header, Message as _, Mixture, Origin, name_hash};

/// Brush and paint, driven by samples.
#[derive(Debug)]
pub struct Offline {
    model: BrushModel,
    sequencer: Sequencer,
    brush: String,
    player: Origin,
    me: Origin,
    next: u64,
    samples: u64,
}

impl Offline {
    /// A brush called `brush` over a painting; each stroke takes the next of `loads` in turn.
    ///
    /// # Errors
    /// [`PaintRefusal`] where a load is wrong.
    pub fn new(
        painting: Painting,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
        loads: Vec<Mixture>,
    ) -> Result<Self, PaintRefusal> {
        Self::going_on(Sequencer::new(painting), brush, file, depth_share, loads)
    }

    /// As [`new`](Self::new), over a painting that goes on where its sequencer is.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn going_on(
        mut sequencer: Sequencer,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
        loads: Vec<Mixture>,
    ) -> Result<Self, PaintRefusal> {
        let mut model = BrushModel::new(file.clone(), depth_share);
        model.set_scene(sequencer.painting().scene());
        sequencer.define_brush(brush, file);
        let player = Origin {
            source: name_hash("player"),
            epoch: 1,
        };
        let me = Origin {
            source: name_hash(brush),
            epoch: 1,
        };
        let mut offline = Self {
            model,
            sequencer,
            brush: brush.to_owned(),
            player,
            me,
            next: 0,
            samples: 0,
        };
        offline.begin_take(loads)?;
        Ok(offline)
    }

    /// Puts the brush down and takes up another one, with what it carried when it was put down.
    ///
    /// # Errors
    /// [`PaintRefusal`] where the painting refuses it.
    pub fn take_up(
        &mut self,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
    ) -> Result<(), PaintRefusal> {
        self.model = BrushModel::new(file.clone(), depth_share);
        self.sequencer.define_brush(brush, file);
        self.brush = brush.to_owned();
        self.me = Origin {
            source: name_hash(brush),
            epoch: self.me.epoch + 1,
        };
        self.next = 0;
        self.begin_take(Vec::new())
    }

    /// Begins another take with the brush in hand; its strokes take the next of `loads` in turn.
    ///
    /// # Errors
    /// [`PaintRefusal`] where a load is wrong.
    pub fn begin_take(&mut self, loads: Vec<Mixture>) -> Result<(), PaintRefusal> {
        self.command(Command::Take {
            brush: self.brush.clone(),
            device: self.player.source,
            device_epoch: self.player.epoch,
            loads,
            again: false,
        })
    }

    /// Name of the brush in hand.
    #[must_use]
    pub fn brush(&self) -> &str {
        &self.brush
    }

    /// Does a command now.
    ///
    /// # Errors
    /// [`PaintRefusal`] where the painting refuses it.
    pub fn command(&mut self, command: Command) -> Result<(), PaintRefusal> {
        self.sequencer.ask(command)?;
        let scene = self.sequencer.painting_mut().scene();
        self.model.set_scene(scene);
        self.model.tune(scene.tuning(&self.brush));
        Ok(())
    }

    /// Follows one sample.
    ///
    /// # Errors
    /// [`PaintRefusal`] where the painting refuses its state.
    pub fn sample(&mut self, event_ns: u64, sample: &StylusSample) -> Result<(), PaintRefusal> {
        let number = self.samples;
        self.samples += 1;
        if sample.fault().is_some() {
            return Ok(());
        }
        let Some(state) = self.model.state(self.player, number, event_ns, sample) else {
            return Ok(());
        };
        let header = Header {
            version: maulstick_types::brush::BrushState::VERSION,
            schema: 0,
            source: self.me.source,
            epoch: self.me.epoch,
            flags: Flags::REPLAY,
            length: 0,
            seq: self.next,
            event_ns,
            sent_ns: event_ns,
        };
        self.next += 1;
        // Offline no command waits for a state.
        let (_, painted) = self.sequencer.state(&self.brush, &header, &state);
        self.sequencer.drain_journal();
        painted
    }

    /// The painting, done.
    #[must_use]
    pub fn into_painting(self) -> Painting {
        let mut painting = self.sequencer.into_painting();
        painting.commit();
        painting
    }

    /// The sequencer.
    pub fn sequencer_mut(&mut self) -> &mut Sequencer {
        &mut self.sequencer
    }

    /// The painting.
    pub fn painting_mut(&mut self) -> &mut Painting {
        self.sequencer.painting_mut()
    }
}
