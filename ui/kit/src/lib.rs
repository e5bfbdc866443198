//! Parts of panels and dialogs: rows, notifications, swatches, and languages.
//!
//! | module | content |
//! | --- | --- |
//! | [`rows`] | rows of a panel: a word and a control |
//! | [`pending`] | a value that the rig has not confirmed yet |
//! | [`arrow_keys`] | arrow keys on a field that has the keyboard |
//! | [`notifications`] | messages to the painter |
//! | [`swatches`] | colour patches of paints |
//! | [`display_transform`] | sRGB to the colours of the display |
//! | [`language`] | languages, and the English sentences that are their keys |
//! | [`units`] | millimetres or inches |
//! | [`background_task`] | work on a thread beside the window |
//!
//! A part gets the values that it shows, and returns the painter's changes; it depends on neither rig nor settings.
//!
//! ```
//! use eframe::egui::{Context, RawInput};
//! use maulstick_types::values::FilmThickness;
//! use maulstick_ui_kit::rows::{Number, Sliders};
//!
//! let number = Number::of::<FilmThickness>("Thickness", 1);
//! let (context, mut sliders) = (Context::default(), Sliders::default());
//! let _ = context.run_ui(RawInput::default(), |ui| {
//!     let change = sliders.row(ui, &number, 12.0);
//!     assert_eq!((change.shown, change.settled), (12.0, None));
//! });
//! ```

#[macro_use]
pub mod language;

pub mod arrow_keys;
pub mod background_task;
pub mod display_transform;
pub mod notifications;
pub mod pending;
pub mod rows;
pub mod swatches;
pub mod units;
