//! The same brush and the same paint in one process, without a bus, for `maulstick render`. Messages are passed
//! directly, so the painting is the same, byte for byte.

use std::sync::mpsc;

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_num::fork_join::with_cores_beyond;
use maulstick_painting::clock::TICKS_A_SECOND;
use maulstick_painting::{Applied, EditError, Painting, Sequencer};
use maulstick_types::Edit;
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Header, Message as _, Mixture, Origin, name_hash};

use crate::ticker::Ticker;

/// Greatest number of states by which the brush may be ahead of the paint.
const STATES_AHEAD_MAX: usize = 256;

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
        Self::resume(Sequencer::new(painting), brush, file, depth_share, loads)
    }

    /// [`new`](Self::new) with a painting that continues at its sequencer's state.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn resume(
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

    /// Puts the brush down and takes up another one, with its last load; the take before has ended.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub fn take_up(
        &mut self,
        brush: &str,
        file: BrushFile,
        depth_share: f64,
    ) -> Result<(), EditError> {
        self.end_take()?;
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

    /// Begins another take with the brush in hand, brought into shape; its strokes take the next of `loads` in turn. The take before has ended.
    ///
    /// # Errors
    /// [`EditError`] where a load is wrong, or as [`end_take`](Self::end_take).
    pub fn begin_take(&mut self, loads: Vec<Mixture>) -> Result<(), EditError> {
        self.end_take()?;
        self.ticker.pause();
        let player = [self.player.source, self.player.epoch];
        self.sequencer.begin_own_take(&self.brush, player, loads)?;
        self.update_scene();
        self.model.straighten();
        Ok(())
    }

    /// Number of samples faster than a hand (`maulstick_brush::speed_limit`), at each of which the brush restarted.
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
        self.update_scene();
        Ok(applied)
    }

    /// Updates the brush from the scene.
    fn update_scene(&mut self) {
        let scene = self.sequencer.painting_mut().scene();
        self.model.set_scene(scene);
        self.model.tune(scene.tuning(&self.brush));
        self.model.soak(scene.wetness(&self.brush));
        self.model.take_set(scene.set(&self.brush));
    }

    /// Lets `ticks` sixtieths of a second pass without painting. `each` is called after each second during a drying;
    /// otherwise nothing happens.
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

    /// Follows one sample of a take.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses its state.
    pub fn sample(&mut self, event_ns: u64, sample: &StylusSample) -> Result<(), EditError> {
        self.follow_samples(Flags::NONE, &[(event_ns, sample)], |_, _| {})
    }

    /// Ends a take whose samples came one by one: a pen that still waits to be set down is.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses its state.
    pub fn end_take(&mut self) -> Result<(), EditError> {
        let (player, samples) = (self.player, self.samples);
        let (model, mut painter) = self.halves();
        let state = model.finish_take(player, samples.saturating_sub(1));
        let mut messages = state.map_or_else(Vec::new, messages).into_iter();
        messages.try_for_each(|(flags, state)| {
            let event_ns = state.solves.last().map_or(0, |last| last.event_ns);
            painter.paint(event_ns, flags, &state)
        })
    }

    /// Follows the samples of a take to its end, each with its time, ns. The brush is bent on a thread of its own, ahead of
    /// the paint. `each` gets the number of the sample after which the painting is.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses a state.
    pub fn follow(
        &mut self,
        samples: &[(u64, &StylusSample)],
        each: impl FnMut(&mut Sequencer, usize),
    ) -> Result<(), EditError> {
        self.follow_samples(Flags::LAST, samples, each)
    }

    /// Follows samples; the last of them has the flags `last`.
    fn follow_samples(
        &mut self,
        last: Flags,
        samples: &[(u64, &StylusSample)],
        mut each: impl FnMut(&mut Sequencer, usize),
    ) -> Result<(), EditError> {
        let (player, first, count) = (self.player, self.samples, samples.len());
        self.samples += count as u64;
        let (model, mut painter) = self.halves();
        let mut bend = move |(number, &(event_ns, sample)): (usize, &(u64, &StylusSample))| {
            let flags = if number + 1 == count {
                last
            } else {
                Flags::NONE
            };
            let serial = first + number as u64;
            let state = model.state_in_take(player, serial, event_ns, sample, flags);
            let messages = state.map_or_else(Vec::new, messages).into_iter();
            messages.map(move |(flags, state)| (number, event_ns, flags, state))
        };
        let mut paint = |(number, event_ns, flags, state): (usize, u64, Flags, BrushState)| {
            let painted = painter.paint(event_ns, flags, &state);
            if !flags.has(Flags::CONTINUES) {
                each(painter.sequencer, number);
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
            let (bent, states) = mpsc::sync_channel(STATES_AHEAD_MAX);
            scope.spawn(move || {
                for state in samples.iter().enumerate().flat_map(&mut bend) {
                    // The painter has stopped, and reports its error.
                    if bent.send(state).is_err() {
                        return;
                    }
                }
            });
            // The brush takes one core already.
            with_cores_beyond(1, || states.into_iter().try_for_each(&mut paint))
        })
    }

    /// The brush, and the half that paints.
    fn halves(&mut self) -> (&mut BrushModel, Painter<'_>) {
        let painter = Painter {
            sequencer: &mut self.sequencer,
            brush: &self.brush,
            me: self.me,
            next: &mut self.next,
            ticker: &mut self.ticker,
        };
        (&mut self.model, painter)
    }

    /// The painting, done. A take whose samples came one by one has [ended](Self::end_take) before.
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

/// A state as the brush node sends it.
fn messages(state: BrushState) -> Vec<(Flags, BrushState)> {
    state.messages(Flags::REPLAY, Flags::NONE, Flags::NONE)
}

/// Painter of the states of the brush in hand.
struct Painter<'a> {
    sequencer: &'a mut Sequencer,
    brush: &'a str,
    me: Origin,
    next: &'a mut u64,
    ticker: &'a mut Ticker,
}

impl Painter<'_> {
    /// Paints a message of the brush.
    fn paint(&mut self, event_ns: u64, flags: Flags, state: &BrushState) -> Result<(), EditError> {
        let header = Header {
            version: BrushState::VERSION,
            schema: 0,
            source: self.me.source,
            epoch: self.me.epoch,
            flags,
            length: 0,
            seq: *self.next,
            event_ns,
            sent_ns: event_ns,
        };
        *self.next += 1;
        // However long a gap is, time passes only for a drying.
        let ticks = self.ticker.look(event_ns, u64::MAX);
        let sequencer = &mut *self.sequencer;
        let _ = (0..ticks).try_for_each(|_| {
            sequencer.tick();
            sequencer.painting().is_drying().then_some(())
        });
        // Offline no command waits for a state.
        let (_, painted) = sequencer.state(self.brush, &header, state);
        sequencer.drain_journal();
        painted
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::PaintingSetup;
    use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose};

    use super::*;

    const MS: u64 = 1_000_000;

    fn offline() -> Offline {
        let setup = PaintingSetup {
            cells: [128, 96],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("built in");
        let painting = Painting::new(&setup, library).expect("valid");
        let file = BrushFile::library("round").expect("built in");
        let loads = vec!["Cobalt Blue".parse().expect("a mixture")];
        Offline::new(painting, "main", file, 0.5, loads).expect("valid")
    }

    fn pen(pressure: f64) -> StylusSample {
        StylusSample {
            pose: StylusPose::Contact {
                point_m: [0.0; 3],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure,
            },
            in_range: true,
            ..StylusSample::away()
        }
    }

    fn covered(offline: &mut Offline) -> u64 {
        offline.painting_mut().report().covered_cells
    }

    /// A take that ends as its pen is set down.
    fn take() -> [(u64, StylusSample); 2] {
        [(1000 * MS, pen(0.0)), (1008 * MS, pen(0.4))]
    }

    #[test]
    fn a_take_that_ends_as_its_pen_is_set_down_has_its_mark() {
        let take = take();
        let mut whole = offline();
        let samples: Vec<(u64, &StylusSample)> = take.iter().map(|(ns, s)| (*ns, s)).collect();
        whole.follow(&samples, |_, _| {}).expect("painted");
        let cells = covered(&mut whole);
        assert!(cells > 0);
        let single = || {
            let mut offline = offline();
            for (ns, sample) in &take {
                offline.sample(*ns, sample).expect("painted");
            }
            assert_eq!(covered(&mut offline), 0, "it waits");
            offline
        };
        let mut ended = single();
        ended.end_take().expect("painted");
        assert_eq!(covered(&mut ended), cells);
        let mut followed = single();
        followed.begin_take(Vec::new()).expect("begun");
        assert_eq!(covered(&mut followed), cells);
    }
}
