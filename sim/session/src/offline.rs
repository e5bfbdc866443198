//! The same brush and the same paint in one process, without a bus: what `maulstick render` runs.
//! The messages that would have crossed the bus are handed on directly, so the painting is the
//! same, byte for byte.

use std::sync::mpsc;

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_canvas::EditError;
use maulstick_num::fork_join::with_cores_beyond;
use maulstick_painting::clock::TICKS_A_SECOND;
use maulstick_painting::{Applied, Painting, Sequencer};
use maulstick_types::brush::BrushState;
use maulstick_types::edits::Edit;
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Header, Message as _, Mixture, Origin, name_hash};

use crate::ticker::Ticker;

/// So many states the brush may be ahead of the paint.
const AHEAD: usize = 256;

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
    /// Samples that were too fast for the brushes that were put down.
    too_fast_before: u64,
    ticker: Ticker,
}

impl Offline {
    /// A brush called `brush` over a painting; each stroke takes the next of `loads` in turn.
    ///
    /// # Errors
    /// [`EditError`] where a load is wrong.
    pub fn new(
        painting: Painting,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
        loads: Vec<Mixture>,
    ) -> Result<Self, EditError> {
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
    ) -> Result<Self, EditError> {
        let mut model = BrushModel::new(file.clone(), depth_share);
        model.set_scene(sequencer.painting().scene());
        sequencer.define_brush(brush, file)?;
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
            too_fast_before: 0,
            ticker: Ticker::default(),
        };
        offline.begin_take(loads)?;
        Ok(offline)
    }

    /// Puts the brush down and takes up another one, with what it carried when it was put down.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub fn take_up(
        &mut self,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
    ) -> Result<(), EditError> {
        self.sequencer.define_brush(brush, file.clone())?;
        self.too_fast_before = self.too_fast();
        self.model = BrushModel::new(file, depth_share);
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
    /// [`EditError`] where a load is wrong.
    pub fn begin_take(&mut self, loads: Vec<Mixture>) -> Result<(), EditError> {
        self.ticker.pause();
        let player = [self.player.source, self.player.epoch];
        self.sequencer.begin_own_take(&self.brush, player, loads)?;
        self.follow_scene();
        Ok(())
    }

    /// Samples so far that were faster than a hand (`maulstick_brush::speed_limit`): the brush began anew at each.
    #[must_use]
    pub fn too_fast(&self) -> u64 {
        self.too_fast_before + self.model.too_fast()
    }

    /// Name of the brush in hand.
    #[must_use]
    pub fn brush(&self) -> &str {
        &self.brush
    }

    /// Applies an edit now.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub fn edit(&mut self, edit: impl Into<Edit>) -> Result<Applied, EditError> {
        let applied = self.sequencer.edit(edit)?;
        self.follow_scene();
        Ok(applied)
    }

    /// Has the brush follow what the scene says of it.
    fn follow_scene(&mut self) {
        let scene = self.sequencer.painting_mut().scene();
        self.model.set_scene(scene);
        self.model.tune(scene.tuning(&self.brush));
        self.model.soak(scene.wetness(&self.brush));
    }

    /// Lets so many sixtieths of a second go by, in which nobody paints. `each` is told after each second of it where
    /// something dries; else nothing happens.
    pub fn wait(&mut self, ticks: u32, mut each: impl FnMut(&mut Sequencer)) {
        let mut left = ticks;
        while left > 0 && self.sequencer.painting().is_drying() {
            let ticks = left.min(TICKS_A_SECOND);
            (0..ticks).for_each(|_| self.sequencer.tick());
            left -= ticks;
            self.sequencer.drain_journal();
            each(&mut self.sequencer);
        }
    }

    /// Follows one sample.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses its state.
    pub fn sample(&mut self, event_ns: u64, sample: &StylusSample) -> Result<(), EditError> {
        self.follow(&[(event_ns, sample)], |_, _| {})
    }

    /// Follows samples, each with its time, ns. The brush is bent on a thread of its own, ahead of the
    /// paint. `each` is told after which sample the painting is.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses a state.
    pub fn follow(
        &mut self,
        samples: &[(u64, &StylusSample)],
        mut each: impl FnMut(&mut Sequencer, usize),
    ) -> Result<(), EditError> {
        let first = self.samples;
        self.samples += samples.len() as u64;
        let (player, model) = (self.player, &mut self.model);
        let mut bend = move |(number, &(event_ns, sample)): (usize, &(u64, &StylusSample))| {
            let fits = sample.fault().is_none();
            let serial = first + number as u64;
            let state = fits.then(|| model.state(player, serial, event_ns, sample));
            // As the brush node sends them.
            let messages = state.flatten().map_or_else(Vec::new, |state| {
                state.messages(Flags::REPLAY, Flags::NONE, Flags::NONE)
            });
            let messages = messages.into_iter();
            messages.map(move |(flags, state)| (number, event_ns, flags, state))
        };
        let (sequencer, brush, me, next) =
            (&mut self.sequencer, &self.brush, self.me, &mut self.next);
        let ticker = &mut self.ticker;
        let mut paint = |(number, event_ns, flags, state): (usize, u64, Flags, BrushState)| {
            let header = Header {
                version: BrushState::VERSION,
                schema: 0,
                source: me.source,
                epoch: me.epoch,
                flags,
                length: 0,
                seq: *next,
                event_ns,
                sent_ns: event_ns,
            };
            *next += 1;
            // However long a gap is, time passes only for what dries.
            let ticks = ticker.look(event_ns, u64::MAX);
            let _ = (0..ticks).try_for_each(|_| {
                sequencer.tick();
                sequencer.painting().is_drying().then_some(())
            });
            // Offline no command waits for a state.
            let (_, painted) = sequencer.state(brush, &header, &state);
            sequencer.drain_journal();
            if !flags.has(Flags::CONTINUES) {
                each(sequencer, number);
            }
            painted
        };
        if let [_] = samples {
            return samples
                .iter()
                .enumerate()
                .flat_map(bend)
                .try_for_each(paint);
        }
        std::thread::scope(|scope| {
            let (bent, states) = mpsc::sync_channel(AHEAD);
            scope.spawn(move || {
                for state in samples.iter().enumerate().flat_map(&mut bend) {
                    // The painter has given up: what is wrong is said there.
                    if bent.send(state).is_err() {
                        return;
                    }
                }
            });
            // The brush takes one core already.
            with_cores_beyond(1, || states.into_iter().try_for_each(&mut paint))
        })
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
