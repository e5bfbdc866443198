//! Painting by a script, a step after the other.

use std::time::Instant;

use indicatif::ProgressBar;
use maulstick_appearance::light::changes_colour;
use maulstick_painting::Sequencer;
use maulstick_painting::edits::{EditEntry, common};
use maulstick_rig::UserError;
use maulstick_session::{Autosave, Offline};
use maulstick_types::stylus::StylusSample;
use maulstick_types::values::BrushName;
use maulstick_types::{Edit, Mixture};

use maulstick_painting_setup::lamp::changed;
use maulstick_painting_setup::refused;

use crate::duration::time_ns;
use crate::{Act, Script};

/// Time before a take or a stroke, ns: strokes of two are never one.
const PAUSE_NS: u64 = 1_000_000_000;

/// A painting that follows a script.
pub struct ScriptRunner<'a> {
    /// Brush and paint.
    pub offline: Offline,
    autosave: &'a mut Option<Autosave>,
    begun: Instant,
    bar: ProgressBar,
    /// Duration of the takes, strokes and waits so far, ns.
    painted_ns: u64,
    /// Number of steps done.
    done: u64,
}

impl<'a> ScriptRunner<'a> {
    /// A runner over brush and paint; what is painted goes to the document of `autosave`, if there is one, and `bar` shows
    /// how far it is.
    pub fn new(offline: Offline, autosave: &'a mut Option<Autosave>, bar: ProgressBar) -> Self {
        Self {
            offline,
            autosave,
            begun: Instant::now(),
            bar,
            painted_ns: 0,
            done: 0,
        }
    }

    /// Does the steps of a script, in order.
    ///
    /// # Errors
    /// A [`UserError`] with file and line of the refused step; those before it are done.
    pub fn follow_script(&mut self, script: Script) -> Result<(), UserError> {
        self.bar.inc_length(script.steps.len() as u64);
        let done = script.steps.into_iter().try_for_each(|(place, act)| {
            let done = self.act(act).map_err(|fault| fault.at(place));
            self.done += 1;
            self.show(self.painted_ns);
            done
        });
        self.bar.finish_and_clear();
        done
    }

    /// Shows how far it is: each millisecond of takes and waits counts, and each step.
    fn show(&self, painted_ns: u64) {
        self.bar.set_position(painted_ns / 1_000_000 + self.done);
    }

    fn act(&mut self, act: Act) -> Result<(), UserError> {
        let done = match act {
            Act::Brush(name, file, share) => self.offline.take_up(&name, *file, share),
            Act::Edit(edit) => {
                let brush = BrushName::new(self.offline.brush())?;
                let edit = (EditEntry::find(&edit)?.for_brush)(&edit, &brush)?;
                self.offline.edit(edit).map(drop)
            }
            Act::Take(take, loads) => {
                let samples = take.samples.iter();
                let samples: Vec<_> = samples.map(|s| (s.time_ns, s.sample.clone())).collect();
                return self.follow(&samples, loads);
            }
            Act::Stroke(stroke) => {
                let canvas = &self.offline.painting_mut().scene().surfaces[0];
                let size_mm = canvas
                    .cells
                    .map(|cells| 1e3 * canvas.cell_m * f64::from(cells));
                return self.follow(&stroke.samples(size_mm), Vec::new());
            }
            Act::Ground(file) => {
                let edit = file.embed(self.offline.painting_mut())?;
                return self.apply_embedded(edit);
            }
            Act::Tooth(picture) => {
                let edit = picture.embed(self.offline.painting_mut())?;
                return self.apply_embedded(edit);
            }
            Act::Wait(ticks) => {
                self.wait(ticks);
                Ok(())
            }
            Act::Light(change) => {
                let before = self.offline.painting_mut().scene().light.clone();
                let light = changed(&change, &before)?;
                let relit = if change.exposure.is_none() && changes_colour(&light, &before) {
                    common::relight_exposed(light)
                } else {
                    common::relight(light)
                };
                self.offline.edit(relit).map(drop)
            }
            Act::Undo(times) => return self.take_back(times),
        };
        done.map_err(refused)?;
        self.keep();
        Ok(())
    }

    /// Applies an edit that names a picture which the painting has just been given.
    fn apply_embedded(&mut self, edit: Edit) -> Result<(), UserError> {
        if let Some(autosave) = self.autosave {
            // The document has the picture before the journal names it.
            autosave.settle(self.offline.sequencer_mut());
        }
        self.offline.edit(edit).map_err(refused)?;
        self.keep();
        Ok(())
    }

    fn take_back(&mut self, times: u32) -> Result<(), UserError> {
        let painting = self.offline.painting_mut();
        painting.commit();
        let (there, _) = painting.history_depth();
        if there < times as usize {
            let (what, help) = match there {
                0 => (
                    "there is nothing yet to take back".to_owned(),
                    "a load, a stroke, a film, a drying, another ground or tooth can be taken back"
                        .to_owned(),
                ),
                _ => (
                    format!("{times} steps cannot be undone: only {there} can"),
                    format!("{{ undo = {there} }} undoes all of them"),
                ),
            };
            return Err(UserError::usage(what).help(help));
        }
        for _ in 0..times {
            self.offline.edit(common::undo()).map_err(refused)?;
        }
        self.keep();
        Ok(())
    }

    fn wait(&mut self, ticks: u32) {
        let Self {
            offline,
            autosave,
            begun,
            painted_ns,
            ..
        } = self;
        offline.wait(ticks, |sequencer| {
            turn(autosave, *begun, sequencer);
        });
        *painted_ns += time_ns(ticks);
    }

    /// Follows samples, each with its time, ns; their strokes take the next of `loads` in turn.
    fn follow(
        &mut self,
        samples: &[(u64, StylusSample)],
        loads: Vec<Mixture>,
    ) -> Result<(), UserError> {
        self.offline.begin_take(loads).map_err(refused)?;
        // The start does not matter to the painting; a live one has the clock's time here.
        let (start_ns, first_ns) = (PAUSE_NS + self.painted_ns, samples[0].0);
        let timed: Vec<_> = samples
            .iter()
            .map(|(time_ns, sample)| (start_ns + time_ns - first_ns, sample))
            .collect();
        let Self {
            offline,
            autosave,
            begun,
            bar,
            painted_ns,
            done,
        } = self;
        let followed = offline.follow(&timed, |sequencer, number| {
            if number % 16 == 0 {
                let painted_ns = *painted_ns + samples[number].0 - first_ns;
                bar.set_position(painted_ns / 1_000_000 + *done);
            }
            turn(autosave, *begun, sequencer);
        });
        followed.map_err(refused)?;
        self.painted_ns += samples[samples.len() - 1].0 - first_ns + PAUSE_NS;
        Ok(())
    }

    fn keep(&mut self) {
        turn(self.autosave, self.begun, self.offline.sequencer_mut());
    }
}

/// Saves new records to the document, if there is one.
fn turn(autosave: &mut Option<Autosave>, begun: Instant, sequencer: &mut Sequencer) {
    if let Some(autosave) = autosave {
        autosave.turn(sequencer, begun.elapsed().as_nanos() as u64);
    }
}
