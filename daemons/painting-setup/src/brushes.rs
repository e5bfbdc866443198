//! Brush files as settings and command lines name them.

use maulstick_brush::BrushFile;
use maulstick_rig::UserError;
use maulstick_rig::config::BrushSection;
use maulstick_types::command::advice::Advice;

/// The brush file of a section, at its size, as [`maulstick_device::brush_file`] has it.
///
/// # Errors
/// A [`UserError`] for an unknown kind or a bad file, with advice on its format.
pub fn brush_file(section: &BrushSection) -> Result<BrushFile, UserError> {
    maulstick_device::brush_file(section).map_err(of_a_brush)
}

/// Error of a brush file, without the advice for settings of a rig, which does not apply.
#[must_use]
pub fn of_a_brush(fault: UserError) -> UserError {
    if fault.advice == Some(Advice::DefaultSettings) {
        return fault.help(
            "docs/brushes.md says what a brush file holds; `maulstick brush list` shows the library",
        );
    }
    fault
}
