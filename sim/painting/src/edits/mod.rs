//! Edits: all changes of a painting besides its brushes' strokes, each in its own file.
//!
//! A file has the struct, whose doc comment is its help, its form as a step of a script and as a command, its effect on
//! the painting, and its words. On the wire and in the journal it is an [`Edit`] with its name. A number or text with a
//! range is a type of [`values`](maulstick_types::values), so a parsed edit is valid.
//!
//! A new edit is its file, a line in the list below, and its widget.

mod applied;
pub mod common;
mod form;
mod read;
mod registry;
#[cfg(feature = "cli")]
pub mod versions;
pub mod words;

pub mod brush;
pub mod history;
pub mod layer;
pub mod surface;

pub use applied::Applied;
pub use brush::{Clean, Handle, Load, LoadFrom, Reshape, Tune};
#[cfg(feature = "cli")]
pub use form::CommandForm;
pub use form::{Form, StepForm};
pub use history::{Branch, Forget, GoTo, Keep, Redo, ReturnTo, Undo};
pub use layer::{Dry, Finish, LayerRef, NameLayer, Opacity, StopDrying, Varnish, Wet};
pub use registry::{EditEntry, entries, read};
pub use surface::{
    Convert, Exposure, Fill, FillPaint, Flip, Ground, GroundSource, LightChange, Piles, Place,
    Relight, Scrape, Size, Tooth, Wells,
};

use std::fmt::Debug;

use maulstick_types::values::{BrushName, ValueError};
use maulstick_types::{Edit, Mixture};

use crate::error::EditError;
use crate::painting::Painting;

/// Passes the list of all edits to a macro.
#[macro_export]
macro_rules! for_each_edit {
    ($with:ident) => {
        $with! {
            Load, LoadFrom, Clean, Reshape, Tune, Handle,
            Dry, StopDrying, Wet, Varnish, Opacity, NameLayer,
            Place, Relight, Ground, Tooth, Size, Piles, Fill, Scrape, Wells, Convert, Flip,
            Undo, Redo, Keep, ReturnTo, Branch, Forget, GoTo
        }
    };
}

impl Painting {
    /// Applies an edit.
    ///
    /// # Errors
    /// [`EditError`] with the reason of a refusal; the painting is then unchanged.
    pub fn apply(&mut self, edit: impl Into<Edit>) -> Result<Applied, EditError> {
        read(&edit.into())?.apply(self)
    }
}

/// An edit as the painting carries it out.
pub trait PaintingEdit: Debug {
    /// Changes a painting, which is unchanged on a refusal.
    ///
    /// # Errors
    /// [`EditError`] with the reason of a refusal.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError>;

    /// The edit in the words of a log.
    fn log_words(&self) -> String;

    /// Words that introduce its result on the command line; `None` if it has none.
    fn reply(&self) -> Option<&'static str> {
        None
    }

    /// True if it takes the newest step back. A stroke that still waits to be painted is dropped instead.
    fn is_undo(&self) -> bool {
        false
    }

    /// The edit that takes back the newest step of a brush alone, if this one may mean that.
    fn undo_of(&self, _brush: &BrushName) -> Option<Edit> {
        None
    }

    /// The brush that a script's edit is for, which is the one in hand.
    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        None
    }

    /// The mixtures of paints that it names.
    fn mixtures_mut(&mut self) -> Vec<&mut Mixture> {
        Vec::new()
    }

    /// Checks names of the libraries, as far as no painting is needed.
    ///
    /// # Errors
    /// [`EditError`] for an unknown one.
    fn check_names(&self) -> Result<(), EditError> {
        Ok(())
    }

    /// Checks that all that a painter wrote has an effect.
    ///
    /// # Errors
    /// [`ValueError::Idle`].
    fn check_idle(&self) -> Result<(), ValueError> {
        Ok(())
    }
}
