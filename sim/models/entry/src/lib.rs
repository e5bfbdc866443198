//! Entry of a paint model in the registry: the whole interface between a model and the rest of a rig. Each model
//! exports one.
//!
//! With the feature `device` an entry also makes the model on a graphics device.
//!
//! ```
//! use maulstick_model::interface::{PaintModel, Step, StepReport};
//! use maulstick_model::rheology::Rheology;
//! use maulstick_model_entry::ModelEntry;
//!
//! struct Nothing;
//!
//! impl PaintModel for Nothing {
//!     fn name(&self) -> &'static str {
//!         "nothing"
//!     }
//!     fn step(&mut self, _step: &mut Step<'_>) -> StepReport {
//!         StepReport::default()
//!     }
//! }
//!
//! const WATER: Rheology = Rheology { viscosity_m2_s: 1e-6, thinning: 0.0, bears: 0.0, yields: |_| 0.0 };
//! const ENTRY: ModelEntry = ModelEntry::new("nothing", || Box::new(Nothing), WATER);
//! assert_eq!(ENTRY.name, (ENTRY.make)().name());
//! ```

use std::fmt;

use maulstick_appearance::picture::Picture;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_model::interface::PaintModel;
use maulstick_model::rheology::Rheology;

/// Entry of a paint model in the registry.
#[derive(Clone, Copy)]
pub struct ModelEntry {
    /// Name of the model in `rig.toml`, in the scene and in a document.
    pub name: &'static str,
    /// Constructor on the processor.
    pub make: fn() -> Box<dyn PaintModel>,
    /// Constructor on a graphics device, if the model has one.
    #[cfg(feature = "device")]
    pub make_on: Option<maulstick_gpu::MakeModel>,
    /// Display of its paint, and its columns for solids.
    pub shown: &'static dyn ShowPaint,
    /// Rheology of its paint, for the force on the hand.
    pub rheology: Rheology,
    /// Role of the model where the rig chooses one.
    pub auto: Option<AutoRole>,
    /// Additional panels of the sheet of effects.
    pub panels: &'static [SheetPanel],
}

/// Role of a model where the rig chooses one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AutoRole {
    /// A new painting begins with it.
    First,
    /// Proposed where painting falls behind.
    Lighter,
}

/// A panel of the sheet of effects for a single model.
#[derive(Clone, Copy, Debug)]
pub struct SheetPanel {
    /// Name of the effect.
    pub name: &'static str,
    /// Caption: the action shown.
    pub words: &'static str,
    /// Draws the panel; its size and the side of its cells are in mm, and a pixel is a cell.
    pub draw: fn([f64; 2], f64) -> Result<Picture, SheetError>,
}

/// Errors of drawing a panel.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// Its brush is invalid.
    #[error(transparent)]
    Brush(#[from] maulstick_brush::BrushError),
    /// Its cells exceed the limit of a surface.
    #[error("the figure has too many cells for one surface: choose larger cells")]
    TooLarge,
}

impl ModelEntry {
    /// An entry of a model on the processor whose counts are shown as films.
    #[must_use]
    pub const fn new(
        name: &'static str,
        make: fn() -> Box<dyn PaintModel>,
        rheology: Rheology,
    ) -> Self {
        Self {
            name,
            make,
            #[cfg(feature = "device")]
            make_on: None,
            shown: &Counted,
            rheology,
            auto: None,
            panels: &[],
        }
    }
}

impl fmt::Debug for ModelEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ModelEntry").field(&self.name).finish()
    }
}
