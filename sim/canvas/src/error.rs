//! Errors of edits, as data until a person reads them: a reply has the sentence and the advice, and each front end its
//! own words for the advice.

use maulstick_types::brush::BRUSHES_MOST;
use maulstick_types::command::Outcome;
use maulstick_types::command::advice::Advice;
use maulstick_types::limits::CELLS_M;
use maulstick_types::nearest::choice;
use maulstick_types::paint::StepName;
use maulstick_types::scene::LightError;
use maulstick_types::values::ValueError;
use maulstick_types::{EditFault, MixtureError, Region};

use crate::quantum::SLOTS;

/// Error of an edit; the painting is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// An unknown paint.
    #[error("there is no paint called '{name}'{}", .nearest.as_ref().map_or(String::new(), |nearest| format!("; did you mean '{nearest}'?")))]
    NoPaint {
        /// Name of the paint.
        name: String,
        /// The nearest name, if one is near.
        nearest: Option<String>,
    },
    /// An invalid mixture.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// An unreadable line of a paint file.
    #[error("line {line}: {what}")]
    PaintFile {
        /// The line, from 1.
        line: usize,
        /// Fault, as a clause.
        what: String,
    },
    /// One paint more than a painting can have.
    #[error("'{0}' would be paint {count} of this painting", count = SLOTS + 1)]
    TooManyPaints(String),
    /// A paint that the painting does not use.
    #[error("paint '{0}' is not in use in this painting")]
    NoSlot(String),
    /// One brush more than a painting can have.
    #[error("'{0}' would be brush {count} of this painting", count = BRUSHES_MOST + 1)]
    TooManyBrushes(String),
    /// A brush that the rig does not have.
    #[error("there is no brush called '{name}' in this rig")]
    NoBrush {
        /// Requested name.
        name: String,
        /// Known names.
        known: Vec<String>,
    },
    /// A brush without paint.
    #[error("brush '{0}' carries no paint")]
    EmptyBrush(String),
    /// A place without paint.
    #[error("no paint lies {:.1} mm from the left edge and {:.1} mm from the lower edge", at_m[0] * 1e3, at_m[1] * 1e3)]
    NoPaintThere {
        /// Place on the surface, m.
        at_m: [f64; 2],
    },
    /// A brush state with a fault, such as NaN.
    #[error("brush '{brush}' sent an invalid state: {fault}")]
    State {
        /// Name of the brush.
        brush: String,
        /// Fault, as a clause.
        fault: &'static str,
    },
    /// A state of another brush file; the name of the brush.
    #[error("brush '{0}' sent a state of another brush file")]
    Unfit(String),
    /// An unknown surface.
    #[error("there is no surface {0}")]
    NoSurface(u32),
    /// A value out of its range.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// An edit unknown to this program, or one with an unknown field.
    #[error(transparent)]
    Edit(#[from] EditFault),
    /// A refusal of a single kind of edit.
    #[error("{what}")]
    Own {
        /// Fault, as a clause.
        what: &'static str,
        /// Remedy.
        help: &'static str,
    },
    /// A region that contains no cell of its surface.
    #[error("the region {region} holds no cell of the surface")]
    NoCell {
        /// The region.
        region: Region,
        /// Width and height of the surface, mm.
        surface_mm: [f64; 2],
    },
    /// Nothing wet to dry, in this region or at all.
    #[error("nothing is wet{}", within(.0.as_ref()))]
    NothingWet(Option<Region>),
    /// Nothing dry to rewet, in this region or at all.
    #[error("nothing has dried{}", within(.0.as_ref()))]
    NothingDry(Option<Region>),
    /// No room for rewetted paint, in this region or at all.
    #[error("no cell{} has room for more wet paint", within(.0.as_ref()))]
    NoRoom(Option<Region>),
    /// A layer with an opacity, which wet paint cannot have.
    #[error("layer {number} ({name}) has an opacity other than 1, which wet paint cannot have")]
    Veiled {
        /// Number of the layer.
        number: u32,
        /// Name of the brush.
        name: String,
    },
    /// A drying of this surface is in progress.
    #[error("this surface is drying already")]
    Drying,
    /// No drying of this surface is in progress.
    #[error("this surface is not drying")]
    NotDrying,
    /// An unknown dry layer.
    #[error("there is no dry layer {which}")]
    NoLayer {
        /// Requested number or name.
        which: String,
        /// Numbers and names of the existing layers.
        known: Vec<(u32, String)>,
    },
    /// Nothing to undo, of this brush or at all.
    #[error("there is nothing{} to undo", .0.as_ref().map_or(String::new(), |brush| format!(" by brush '{brush}'")))]
    NothingToUndo(Option<String>),
    /// Nothing to redo.
    #[error("there is nothing to redo")]
    NothingToRedo,
    /// A step that is no longer separate.
    #[error("this step is no longer in the history")]
    NoStep,
    /// A step under a later one.
    #[error("'{what}' is covered by a later step{}", .over.as_ref().map_or(String::new(), |over| format!(", '{over}'")))]
    Covered {
        /// Name of the step.
        what: StepName,
        /// Name of the later step.
        over: Option<StepName>,
    },
    /// An unknown version.
    #[error("there is no version called '{name}'")]
    NoVersion {
        /// Requested name.
        name: String,
        /// Known names.
        known: Vec<String>,
    },
    /// A version's name that is taken.
    #[error("there is a version called '{0}' already")]
    VersionTaken(String),
    /// The name reserved for the current painting.
    #[error("'{0}' stands for the current painting and cannot name a version")]
    VersionNow(&'static str),
    /// A well beyond the edge of its surface.
    #[error("well {place} is not wholly on its surface")]
    WellBeside {
        /// Its place, from 1.
        place: usize,
        /// Width and height of the surface, mm.
        surface_mm: [f64; 2],
    },
    /// A light out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A spectrum that is invisible.
    #[error("{0}")]
    Dark(String),
    /// An unknown illuminant.
    #[error("there is no illuminant called '{name}'")]
    NoIlluminant {
        /// Name of the layer.
        name: String,
        /// Known names.
        known: Vec<&'static str>,
    },
    /// An unknown ground.
    #[error("there is no ground called '{name}'")]
    NoGround {
        /// Requested name.
        name: String,
        /// Known names.
        known: Vec<&'static str>,
    },
    /// An unknown paint model.
    #[error("there is no paint model called '{name}'")]
    NoModel {
        /// Requested name.
        name: String,
        /// Known names.
        known: Vec<&'static str>,
    },
    /// A surface that already has this paint model.
    #[error("this surface has the paint model '{0}' already")]
    SameModel(&'static str),
    /// An unknown tooth.
    #[error("there is no tooth called '{name}'")]
    NoTooth {
        /// Requested name.
        name: String,
        /// Known names.
        known: Vec<&'static str>,
    },
    /// An unreadable name of a pictured tooth.
    #[error("'{name}' does not name a tooth: {fault}")]
    ToothName {
        /// Requested name.
        name: String,
        /// Fault, as a clause.
        fault: &'static str,
    },
    /// A text that is not a table of reflectances.
    #[error("not a spectrum of a ground: {0}")]
    Spectrum(String),
    /// Bytes that are not a picture, or a picture of another kind or size.
    #[error("{0}")]
    Picture(String),
    /// A picture that the painting lacks, by its hash.
    #[error("this painting has no picture with the hash {0}")]
    NoPicture(String),
    /// A text that is not a hash.
    #[error("'{0}' is not the hash of a picture")]
    NoHash(String),
    /// A picture of heights instead of colours.
    #[error("a picture of heights cannot be a ground")]
    Heights,
    /// A picture of colours instead of heights.
    #[error("a picture of colours cannot be a tooth")]
    Colours,
    /// A surface of too few or too many cells.
    #[error("a canvas cannot have {}×{} cells", .0[0], .0[1])]
    Cells([u32; 2]),
    /// Cells that are too small or too large, mm.
    #[error("cells cannot be {0} mm wide")]
    CellSize(f64),
    /// A document with inconsistent parts.
    #[error("{0}")]
    Damaged(String),
}

fn within(region: Option<&Region>) -> String {
    region.map_or(String::new(), |region| format!(" in {region}"))
}

impl EditError {
    /// Remedy, for a person.
    #[must_use]
    pub fn advice(&self) -> Advice {
        let say = |help: &str| Advice::say(help);
        let size = |[width, height]: &[f64; 2]| format!("{width:.1}x{height:.1} mm");
        match self {
            Self::NoPaint { .. } => Advice::ListPaints,
            Self::Mixture(_) | Self::PaintFile { .. } => {
                say("write mixtures as \"Cobalt Blue=0.7,Titanium White=0.3\"")
            }
            Self::TooManyPaints(_) => Advice::say(format!(
                "a painting has at most {SLOTS} paints: mix it from those in use"
            )),
            Self::TooManyBrushes(_) => {
                say("paint with one that it has, or give one of them this brush's file")
            }
            Self::NoSlot(_) => say("load a brush with it first"),
            Self::EmptyBrush(_) => say("load it first"),
            Self::NoPaintThere { .. } => say("choose a place with paint, wet or dry"),
            Self::NoBrush { known, .. } => {
                Advice::say(format!("choose one of: {}", known.join(", ")))
            }
            Self::State { .. } => say(
                "restart the brush node, or report the fault of the program that sends the states",
            ),
            Self::Unfit(_) => say("restart the brush node"),
            Self::NoSurface(_) => say("the canvas is 0, the palette 1"),
            Self::Edit(EditFault::Unknown(_)) => say("use a newer version of the program"),
            Self::Edit(EditFault::Fields { .. }) | Self::Value(_) | Self::Light(_) => {
                say("choose a value in range")
            }
            Self::Own { help, .. } => say(help),
            Self::NoCell { surface_mm, .. } => Advice::say(format!(
                "the surface measures {} from its lower left corner",
                size(surface_mm)
            )),
            Self::NothingWet(_) | Self::NothingToUndo(None) => say("paint something first"),
            Self::NothingToUndo(Some(_)) => {
                say("undo the newest step of all brushes, or name another brush")
            }
            Self::NothingDry(_) => Advice::DryFirst,
            Self::NoRoom(_) => say("remove some wet paint first, or dry it"),
            Self::Veiled { number, .. } => Advice::FullOpacity { layer: *number },
            Self::Drying => Advice::StopDrying,
            Self::NotDrying => Advice::BeginDrying,
            Self::NoLayer { known, .. } if known.is_empty() => Advice::DryFirst,
            Self::NoLayer { known, .. } => {
                let known = known
                    .iter()
                    .map(|(number, name)| format!("{number} ({name})"));
                Advice::say(format!(
                    "there are {}",
                    known.collect::<Vec<_>>().join(", ")
                ))
            }
            Self::NoStep => {
                say("choose another one: old steps are merged, and new ones replace undone ones")
            }
            Self::NothingToRedo => say("only what was undone and not painted over can be redone"),
            Self::Covered { .. } => Advice::UndoNewest,
            Self::NoVersion { known, .. } if known.is_empty() => {
                say("this painting has no versions yet: keep one first")
            }
            Self::NoVersion { name, known } => {
                Advice::say(choice(name, known.iter().map(String::as_str)))
            }
            Self::VersionTaken(_) => say("choose another name, or forget that version first"),
            Self::VersionNow(_) => say("choose another name"),
            Self::WellBeside {
                surface_mm: [width, height],
                ..
            } => Advice::say(format!(
                "the surface is {width:.0}×{height:.0} mm: give a middle and a radius within"
            )),
            Self::Dark(_) => say("give a spectrum with more of the visible wavelengths"),
            Self::NoIlluminant { name, known } => Advice::say(format!(
                "{}, and any spectrum from a CSV file",
                choice(name, known.iter().copied())
            )),
            Self::NoGround { name, known }
            | Self::NoModel { name, known }
            | Self::NoTooth { name, known } => Advice::say(choice(name, known.iter().copied())),
            Self::SameModel(_) => say("choose another one"),
            Self::ToothName { .. } => {
                say("write image:HASH@120mm,80um: a picture 120 mm wide, 80 µm deep")
            }
            Self::Spectrum(_) => say(
                "write one row for each wavelength: nm,reflectance, wavelengths rising, reflectances 0 to 1",
            ),
            Self::Picture(_) => {
                say("use a PNG of 8-bit RGB or 16-bit grey with at most 67 million pixels")
            }
            Self::NoPicture(_) => say("import the picture first"),
            Self::NoHash(_) => say("write image: and the 64 digits of its SHA-256"),
            Self::Heights => say("import it as a ground, which keeps its colours"),
            Self::Colours => say("import it as a tooth, which keeps it as 16-bit heights"),
            Self::Cells(_) => say("choose 1 to 65536 cells across and up"),
            Self::CellSize(_) => {
                let [least, most] = [CELLS_M.start(), CELLS_M.end()].map(|m| 1e3 * m);
                Advice::say(format!("choose cells of {least} to {most} mm"))
            }
            Self::Damaged(_) => Advice::Recover,
        }
    }
}

impl From<EditError> for Outcome {
    fn from(error: EditError) -> Self {
        Self::Refused {
            what: error.to_string(),
            advice: error.advice(),
        }
    }
}
