//! Entry of a paint model in the registry: all that the rest of a rig asks of a model. Each model exports one.
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
    /// Its name in `rig.toml`, in the scene and in a document.
    pub name: &'static str,
    /// Makes one that runs on the processor.
    pub make: fn() -> Box<dyn PaintModel>,
    /// Makes one on a graphics device, if a device computes it.
    #[cfg(feature = "device")]
    pub make_on: Option<maulstick_gpu::MakeModel>,
    /// How its paint is shown, and written as a solid.
    pub shown: &'static dyn ShowPaint,
    /// Rheology of its paint, as the hand feels it.
    pub rheology: Rheology,
    /// Its part where the choice of a model is left to the rig.
    pub auto: Option<AutoRole>,
    /// Panels that it adds to the sheet of effects.
    pub panels: &'static [SheetPanel],
}

/// Part of a model where the choice is left to the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AutoRole {
    /// A painting begins with it.
    First,
    /// It is proposed where painting falls behind.
    Lighter,
}

/// A panel of the sheet of effects that one model alone has.
#[derive(Clone, Copy, Debug)]
pub struct SheetPanel {
    /// The effect.
    pub name: &'static str,
    /// What is done.
    pub words: &'static str,
    /// Draws it: its size and the side of its cells, mm; a pixel a cell.
    pub draw: fn([f64; 2], f64) -> Result<Picture, SheetError>,
}

/// A panel that cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// Its brush is rejected.
    #[error(transparent)]
    Brush(#[from] maulstick_brush::BrushError),
    /// It has more cells than a surface.
    #[error("the figure has too many cells for one surface: choose larger cells")]
    TooLarge,
}

impl ModelEntry {
    /// A model on the processor whose counts are shown as films.
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
