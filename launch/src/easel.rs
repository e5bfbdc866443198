//! An easel: a painting at which a script is followed, a step after the other.

use std::sync::Arc;
use std::time::Instant;

use indicatif::ProgressBar;
use maulstick_appearance::light::changes_colour;
use maulstick_canvas::assets::IMAGE;
use maulstick_canvas::store::TileStore;
use maulstick_painting::Sequencer;
use maulstick_rig::UserError;
use maulstick_session::{Autosave, Offline};
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, CANVAS};
use maulstick_types::stylus::StylusSample;

use crate::duration::time_ns;
use crate::ground::GroundFile;
use crate::performance::refused;
use crate::script::{Act, Script};
use crate::tooth::ToothPicture;

/// Time before a take or a stroke, ns: strokes of two are never one.
const PAUSE_NS: u64 = 1_000_000_000;

/// A painting at which a script is followed.
pub struct Easel<'a> {
    /// Brush and paint.
    pub offline: Offline,
    autosave: &'a mut Option<Autosave>,
    begun: Instant,
    bar: ProgressBar,
    /// Time of the takes, strokes and waits so far, ns.
    painted_ns: u64,
    /// Steps done.
    done: u64,
}

impl<'a> Easel<'a> {
    /// An easel; what is painted goes to the document of `autosave`, if there is one, and `bar` shows how far
    /// it is.
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

    /// Does the steps of a script, in their order.
    ///
    /// # Errors
    /// A [`UserError`] with file and line of the step that the painting refuses; those before it are done.
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
        let brush = self.offline.brush().to_owned();
        let done = match act {
            Act::Brush(name, file, share) => self.offline.take_up(&name, *file, share),
            Act::Load(mixture, None) => self.offline.command(Command::Load { brush, mixture }),
            Act::Load(left, Some(right)) => {
                let command = Command::LoadBeside { brush, left, right };
                self.offline.command(command)
            }
            Act::Handle(mode, flow, most_m) => {
                let handling = BrushHandling {
                    brush,
                    mode,
                    flow,
                    most_m,
                };
                self.offline.command(Command::Handle { handling })
            }
            Act::FillWith(thickness_m) => self.offline.command(Command::FillWith {
                surface: CANVAS,
                brush,
                thickness_m,
            }),
            Act::Clean => self.offline.command(Command::Clean { brush }),
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
            Act::Ground(file) => return self.prime(file),
            Act::Tooth(picture) => return self.weave(&picture),
            Act::Wait(ticks) => {
                self.wait(ticks);
                Ok(())
            }
            Act::Light(change) => {
                let before = self.offline.painting_mut().scene().light.clone();
                let light = change.on(&before)?;
                let expose = change.exposure.is_none() && changes_colour(&light, &before);
                self.offline.command(Command::Relight { light, expose })
            }
            Act::Undo(times) => return self.take_back(times),
            Act::Command(command) => self.offline.command(command),
        };
        done.map_err(refused)?;
        self.keep();
        Ok(())
    }

    fn prime(&mut self, file: GroundFile) -> Result<(), UserError> {
        let surface = CANVAS;
        let painting = self.offline.painting_mut();
        let cells = painting.store(CANVAS).map_or([1, 1], TileStore::cells);
        let command = match file.picture(cells)? {
            Some(bytes) => {
                let ground = format!("{IMAGE}{}", self.embed(bytes)?);
                Command::Ground { surface, ground }
            }
            None => match file {
                GroundFile::Spectrum(spectrum) => Command::GroundSpectrum { surface, spectrum },
                GroundFile::Named(ground) | GroundFile::Picture(_, ground) => {
                    Command::Ground { surface, ground }
                }
            },
        };
        self.offline.command(command).map_err(refused)?;
        self.keep();
        Ok(())
    }

    fn weave(&mut self, picture: &ToothPicture) -> Result<(), UserError> {
        let canvas = &self.offline.painting_mut().scene().surfaces[0];
        let (cells, cell_m) = (canvas.cells, canvas.cell_m);
        let hash = self.embed(picture.png(cells, cell_m)?)?;
        let command = Command::Tooth {
            surface: CANVAS,
            tooth: picture.name(hash, cells, cell_m),
            seed: 1,
        };
        self.offline.command(command).map_err(refused)?;
        self.keep();
        Ok(())
    }

    /// Takes a picture into the painting, and returns its hash.
    fn embed(&mut self, bytes: Arc<[u8]>) -> Result<String, UserError> {
        let painting = self.offline.painting_mut();
        let hash = painting.embed(bytes).map_err(refused)?;
        if let Some(autosave) = self.autosave {
            // The document has the picture before the journal names it.
            autosave.settle(self.offline.sequencer_mut());
        }
        Ok(hash)
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
                    format!("{times} steps cannot be taken back: {there} can be"),
                    format!("{{ undo = {there} }} takes all of them back"),
                ),
            };
            return Err(UserError::usage(what).help(help));
        }
        for _ in 0..times {
            let undo = Command::Undo { brush: None };
            self.offline.command(undo).map_err(refused)?;
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

/// Hands what is new to the document, if there is one.
fn turn(autosave: &mut Option<Autosave>, begun: Instant, sequencer: &mut Sequencer) {
    if let Some(autosave) = autosave {
        autosave.turn(sequencer, begun.elapsed().as_nanos() as u64);
    }
}
