//! Edits: all that changes a painting besides its brushes' strokes, one struct in one file each.
//!
//! The same struct is what a panel builds, what the wire and the journal carry, what a step of a script and a command
//! line are parsed into; the painting applies it. Its doc comment is its help. A number or text that has a range is a
//! type of [`values`](crate::values), so what decodes is valid.
//!
//! A new edit is its file here and a line in the list below, its `Apply` in the painting, and its widget.

mod form;
mod read;

pub mod brush;
pub mod history;
pub mod layer;
pub mod surface;

pub use brush::{Clean, Handle, Load, LoadFrom, Tune};
#[cfg(feature = "cli")]
pub use form::CommandForm;
pub use form::{Form, StepForm};
pub use history::{Branch, Forget, GoTo, Keep, Redo, ReturnTo, Undo};
pub use layer::{Dry, LayerRef, NameLayer, Opacity, StopDrying, Wet};
pub use surface::{
    Convert, Exposure, Fill, FillPaint, Ground, GroundSource, LightChange, Piles, Place, Relight,
    Scrape, Size, Tooth, Wells,
};

/// Hands the list of all edits to a macro.
#[macro_export]
macro_rules! for_each_edit {
    ($with:ident) => {
        $with! {
            Load, LoadFrom, Clean, Tune, Handle,
            Dry, StopDrying, Wet, Opacity, NameLayer,
            Place, Relight, Ground, Tooth, Size, Piles, Fill, Scrape, Wells,
            Undo, Redo, Keep, ReturnTo, Branch, Forget, GoTo,
            Convert
        }
    };
}

macro_rules! edit_enum {
    ($($edit:ident),*) => {
        crate::wire::define::wire_enum! {
            /// An edit of a painting.
            #[allow(clippy::large_enum_variant, reason = "a light is large; edits are few")]
            pub enum Edit {
                $(
                    #[doc = concat!("See [`", stringify!($edit), "`].")]
                    $edit($edit),
                )*
            }
        }

        $(
            impl From<$edit> for Edit {
                fn from(edit: $edit) -> Self {
                    Self::$edit(edit)
                }
            }

            impl From<$edit> for crate::command::Command {
                fn from(edit: $edit) -> Self {
                    Self::Edit(Edit::$edit(edit))
                }
            }
        )*

        impl Edit {
            /// The brush that a script's edit is for, which is the one in hand.
            pub fn brush_mut(&mut self) -> Option<&mut crate::values::BrushName> {
                match self {
                    $( Self::$edit(edit) => edit.brush_mut(), )*
                }
            }

            /// The mixtures of paints that it names.
            pub fn mixtures_mut(&mut self) -> Vec<&mut crate::Mixture> {
                match self {
                    $( Self::$edit(edit) => edit.mixtures_mut(), )*
                }
            }

            /// Checks that all that a painter wrote has an effect.
            ///
            /// # Errors
            /// [`ValueError::Idle`](crate::values::ValueError::Idle).
            pub fn check_idle(&self) -> Result<(), crate::values::ValueError> {
                match self {
                    $( Self::$edit(edit) => edit.check_idle(), )*
                }
            }
        }

        /// Example of each edit, in the order of the list.
        ///
        /// # Errors
        /// None, if they are in range.
        pub fn examples() -> Result<Vec<Edit>, crate::values::ValueError> {
            Ok(vec![$( $edit::example()?.into(), )*])
        }

        /// The forms of all edits on the command line.
        #[cfg(feature = "cli")]
        #[must_use]
        pub fn commands() -> Vec<CommandForm> {
            let all = [$( $edit::COMMAND, )*];
            all.into_iter().flatten().collect()
        }
    };
}

for_each_edit!(edit_enum);
