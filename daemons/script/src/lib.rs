//! A script: steps of painting, one after the other.
//!
//! ```toml
//! step = [
//!     { brush = "filbert", size_mm = 12 },
//!     { load = "Ultramarine Blue=0.6,Titanium White=0.4" },
//!     { take = "sky.mcap" },
//!     { dry = 1.0, layer = "sky" },
//! ]
//! ```
//!
//! `canvas_mm = [200, 160]` before the steps says how large a new canvas is. A step has one key that says what is done, and
//! perhaps others that say how. Paths count from the script's folder. All of it is read before anything is painted.
//!
//! | module | holds |
//! | --- | --- |
//! | `entries` | keys and what they hold, each with its line |
//! | `step` | a step as it is written |
//! | `steps` | kinds of steps, and the keys of each |
//! | `acts` | the action of each step |
//! | `duration` | times of the painting's clock |
//! | [`advice`] | what to do about a refusal, in steps |
//! | [`stroke`] | a stroke written as points |
//! | `script_runner` | [`ScriptRunner`]: a script painted |
//! | [`paintings`] | the bundled paintings |
//!
//! ```
//! use std::path::Path;
//!
//! use maulstick_painting_setup::library;
//! use maulstick_script::{Act, Script};
//!
//! # fn main() -> Result<(), maulstick_rig::UserError> {
//! let text = "step = [ { load = \"Bone Black\" }, { stroke = [[20, 30, 0.3], [60, 34, 0.5]] } ]";
//! let script = Script::parse(text, "day.toml", Path::new(""), &library()?)?;
//! assert!(matches!(script.steps[1].1, Act::Stroke(_)));
//! # Ok(())
//! # }
//! ```

mod acts;
pub mod advice;
mod duration;
mod entries;
pub mod paintings;
mod script_runner;
mod step;
mod steps;
pub mod stroke;
#[cfg(test)]
mod tests;

pub use script_runner::ScriptRunner;

use std::collections::BTreeSet;
use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::SLOTS;
use maulstick_device::Take;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{self, LightChange};
use maulstick_rig::UserError;
use maulstick_rig::files::ending;
use maulstick_types::Edit;
use maulstick_types::Mixture;
use toml::de::DeTable;

use maulstick_painting_setup::outputs::UsedFile;
use maulstick_painting_setup::surface::ground::GroundFile;
use maulstick_painting_setup::surface::tooth::ToothPicture;

use self::entries::Source;
use self::stroke::Stroke;
use crate::duration::time_ns;

/// Action of a step.
#[derive(Clone, Debug)]
pub enum Act {
    /// Applies an edit; that of a brush is for the one in hand.
    Edit(Edit),
    /// Takes up a brush: its name, its file, the depth at full pressure as a share of its head.
    Brush(String, Box<BrushFile>, f64),
    /// Follows a take; its strokes load these mixtures in turn.
    Take(Take, Vec<Mixture>),
    /// Paints a stroke with the brush's load.
    Stroke(Stroke),
    /// Gives the canvas the ground of a picture.
    Ground(GroundFile),
    /// Gives the canvas the tooth of a picture.
    Tooth(ToothPicture),
    /// Lets time go by, in sixtieths of a second.
    Wait(u32),
    /// Changes the light.
    Light(LightChange),
    /// Undoes a number of steps.
    Undo(u32),
}

impl Act {
    /// The mixtures of paints that it names.
    fn mixtures(&self) -> Vec<Mixture> {
        match self {
            Self::Edit(edit) => edits::read(edit).map_or_else(
                |_| Vec::new(),
                |mut edit| {
                    edit.mixtures_mut()
                        .into_iter()
                        .map(|own| own.clone())
                        .collect()
                },
            ),
            Self::Take(_, loads) => loads.clone(),
            _ => Vec::new(),
        }
    }
}

/// A script that is read.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// Its steps, each with its place, file and line.
    pub steps: Vec<(String, Act)>,
    /// Size of a new canvas, mm, if the script says it.
    pub canvas_mm: Option<[f64; 2]>,
    /// The files that they name.
    pub files: Vec<UsedFile>,
}

impl Script {
    /// Reads a script, with its takes, brushes and pictures.
    ///
    /// # Errors
    /// A [`UserError`] with file, line and remedy.
    pub fn read(path: &Path, library: &PaintLibrary) -> Result<Self, UserError> {
        let text = std::fs::read_to_string(path).map_err(|error| {
            let fault = UserError::reading(path, &error);
            if ending(path) == "mcap" {
                fault.help("a take is painted without `--script`: `maulstick render TAKE`")
            } else {
                fault
            }
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, &path.display().to_string(), folder, library)
    }

    /// Reads the text of a script of this name, whose paths count from `folder`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(
        text: &str,
        name: &str,
        folder: &Path,
        library: &PaintLibrary,
    ) -> Result<Self, UserError> {
        let text = text.trim_start_matches('\u{feff}');
        let line_ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        let source = Source {
            line_ends: &line_ends,
            name,
            folder,
        };
        let file = DeTable::parse(text).map_err(|error| source.no_toml(&error))?;
        let mut script = Self {
            canvas_mm: source.canvas_mm(file.get_ref())?,
            ..Self::default()
        };
        let mut paints = BTreeSet::new();
        for step in steps::listed(source, file.get_ref())? {
            let act = steps::act(&step, library)?;
            let parts = act.mixtures().into_iter().flat_map(|own| own.parts);
            paints.extend(parts.map(|part| part.paint));
            if paints.len() > SLOTS {
                let what = format!("with this step the script has {} paints", paints.len());
                let help = format!("a painting has at most {SLOTS}: mix it from those before");
                return Err(UserError::usage(what).help(help).at(step.place()));
            }
            script.files.extend(acts::files_of(&step)?);
            script.steps.push((step.place(), act));
        }
        Ok(script)
    }

    /// Length of all takes, strokes and waits, ns.
    #[must_use]
    pub fn length_ns(&self) -> u64 {
        let lengths = self.steps.iter().map(|(_, act)| match act {
            Act::Take(take, _) => take.length_ns(),
            Act::Stroke(stroke) => (1e9 * stroke.seconds()) as u64,
            Act::Wait(ticks) => time_ns(*ticks),
            _ => 0,
        });
        lengths.sum()
    }
}
