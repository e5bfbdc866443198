//! A script: a day at the easel, a step after the other.
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
//! `canvas_mm = [200, 160]` before the steps says how large a new canvas is. A step has one key that says what is done, and perhaps others that say how. Paths count from the
//! script's folder. All of it is read before anything is painted.
//!
//! | module | holds |
//! | --- | --- |
//! | `entries` | keys and what they hold, each with its line |
//! | `steps` | which steps there are, and what keys each has |
//! | `acts` | what each step does |
//! | [`stroke`] | a stroke written as points |

mod acts;
mod entries;
mod steps;
pub mod stroke;
#[cfg(test)]
mod tests;

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_device::Take;
use maulstick_optics::PaintLibrary;
use maulstick_rig::UserError;
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::scene::BrushMode;
use toml::de::DeTable;

use self::entries::Source;
use self::stroke::Stroke;
use crate::duration::time_ns;
use crate::ground::GroundFile;
use crate::lamp::LightChange;
use crate::outputs::UsedFile;
use crate::tooth::ToothPicture;

/// Action of a step.
#[derive(Clone, Debug)]
pub enum Act {
    /// Takes up a brush: its name, its file, the share of its head that full pressure presses in.
    Brush(String, Box<BrushFile>, f64),
    /// Loads the brush; with two mixtures a half of its width with each.
    Load(Mixture, Option<Mixture>),
    /// Takes all paint off the brush.
    Clean,
    /// Sets the handling of the brush: mode, flow of the marker, most paint, m.
    Handle(BrushMode, f64, f64),
    /// Lays a film of what the brush carries over the canvas, m.
    FillWith(f64),
    /// Follows a take; its strokes load these mixtures in turn.
    Take(Take, Vec<Mixture>),
    /// Paints a stroke with what the brush has.
    Stroke(Stroke),
    /// Gives the canvas another ground.
    Ground(GroundFile),
    /// Gives the canvas the tooth of a picture.
    Tooth(ToothPicture),
    /// Lets time go by, in sixtieths of a second.
    Wait(u32),
    /// Changes the light.
    Light(LightChange),
    /// Takes so many steps back.
    Undo(u32),
    /// Anything else.
    Command(Command),
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

/// Advice of the painting for a running rig, and the step that does the same.
const ADVICE: [(&str, &str); 3] = [
    ("`maulstick dry --stop`", "{ stop_drying = true }"),
    (
        "`maulstick dry --over 90s`",
        "{ dry = 1.0, over = \"90s\" }",
    ),
    ("`maulstick dry`", "{ dry = 1.0 }"),
];

/// A refusal of a step: its help names steps in the place of commands to a running rig.
#[must_use]
pub fn in_steps(fault: UserError) -> UserError {
    let Some(mut help) = fault.help.clone() else {
        return fault;
    };
    for (command, step) in ADVICE {
        help = help.replace(command, step);
    }
    if let Some((before, rest)) = help.split_once("`maulstick opacity ")
        && let Some((layer, after)) = rest.split_once(" 1`")
    {
        help = format!("{before}{{ opacity = 1.0, layer = {layer} }}{after}");
    }
    fault.help(help)
}

impl Script {
    /// Reads a script, its takes, brushes and pictures.
    ///
    /// # Errors
    /// A [`UserError`] with file and line, and what to do.
    pub fn read(path: &Path, library: &PaintLibrary) -> Result<Self, UserError> {
        let text = std::fs::read_to_string(path).map_err(|error| {
            let fault = UserError::reading(path, &error);
            match path
                .extension()
                .is_some_and(|extension| extension == "mcap")
            {
                true => fault.help("a take is painted without `--script`: `maulstick render TAKE`"),
                false => fault,
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
        for step in steps::listed(source, file.get_ref())? {
            let act = steps::act(&step, library)?;
            script.files.extend(acts::file_of(&step)?);
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
