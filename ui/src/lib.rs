//! The painter's view.
//!
//! | module | holds |
//! | --- | --- |
//! | [`app`] | the window, its actions, and the overlay: rack, panels, dialogs, help |
//! | `input` | keys, mouse and gestures |
//! | [`rig`] | state of the rig, and requests to it |
//! | [`view`] | the desk seen from above |
//! | [`render`] | drawing of desk, surfaces and brushes |
//! | `motions` | takes placed on the canvas |
//! | `matching` | from a colour to mixtures of paints |
//! | `panels` | the panels, a folder each |
//! | `dialogs` | files in the window: new, open, save, export, dropped files |
//! | `reference` | a picture to paint after, and the mixtures of its colours |
//! | `sessions` | recorder and player of sessions |
//! | `settings_page` | the dialog of settings: text size, theme, units, keys |
//! | `widgets` | parts of several panels that use the rig; the others are in `maulstick-ui-kit` |
//! | [`settings`] | settings that outlive the window |
//! | `spectrum_file` | spectra from CSV files |
//!
//! # Three parts
//!
//! The state of the rig (plain data filled by a listener), the requests to it (sent on a thread for each node so that
//! the window never waits), and the drawing from the first. A panel reads one, writes the other, and is tested with
//! neither bus nor window.
//!
//! Devices are changed by the functions that `maulstick device` calls, sessions recorded and played by those of
//! `maulstick recording`. A painting is left only once its paint node has sent a status that is newer than the request.
//!
//! # Order and input
//!
//! - A request behind a stroke (dry, undo, load, export) waits until the newest samples of that time are states of a
//!   brush, at most a second without credit, and takes its place right behind them. If the hand has rested for a
//!   second, it goes behind the newest unpainted state. Brush changes do the same, and later strokes wait for them
//!   (`ui/pending`).
//! - Under a held brush the view and surfaces stay; only the free hand moves the canvas. Surfaces move by `Place`
//!   alone; where one may lie is one type for mouse, touch and 6-DOF mouse.
//! - A press counts where it falls, and held keys if they were held before it. A resting pointer is sent once and keeps
//!   its brush. Mouse and pens of the window are devices of `maulstick-window-pen`; a pen is read on its own thread.
//!
//! # Drawing
//!
//! - The window is drawn when a scene, state, frame or answer changes its content. Samples, statuses and credits signal
//!   nothing, and are checked ten times a second while they show work, else every one to three seconds.
//! - A frame is begun on new data, once the device has drawn the last one. `ui/presented` names its brush states.
//!   Brushes are drawn at their newest sample, bent as in their newest state, with shadows of three lights; a dark
//!   ground is lightened so that shadows show.
//! - A surface is two sheets of tiles, each a torus, so a pan copies nothing: a *detail* for the view, and a *base* of
//!   at most 512 cells a side. A sheet has at most two cells a pixel, whatever the canvas. The outer 25 cells of a
//!   detail, whose shadows are incomplete, are not shown. Another level is another sheet, shown once it is whole.
//! - The eye is above the middle of the desk, 2.5 times as high as the view is long. Only the camera is mirrored.
//!
//! # Files, colours, words
//!
//! - Dialogs are the window's own and the desk stays usable; folders and pictures are read on threads. A reference
//!   picture is kept at 2048 pixels a side; a colour of it, the mean of 5×5 pixels, is searched among the palette's
//!   paints under the scene's light. A tracing picture is multiplied over the canvas, below the palette, and stored for
//!   each painting.
//! - History lists thirty steps around the present one; `GoTo` undoes or redoes to one.
//! - `tr!` keys are the English sentences; `languages` has a file for each language, and a test compares them with the
//!   sources.

#[macro_use]
extern crate maulstick_ui_kit;

mod advice;
pub mod app;
mod dialogs;
mod input;
#[cfg(test)]
mod language_tests;
mod matching;
mod motions;
mod panels;
mod reference;
pub mod render;
pub mod rig;
mod sessions;
pub mod settings;
mod settings_page;
mod spectrum_file;
#[cfg(test)]
mod test_support;
pub mod tracing;
pub mod view;
mod widgets;

use maulstick_appearance::picture::Export;
use maulstick_optics::PaintLibrary;
use maulstick_rig::{NodeHandle, UserError};

/// Shows the window until it is closed; `pointers` are the names of its mouse and its pen as devices, `export`
/// describes the display, `library` has the paints.
///
/// # Errors
/// A [`UserError`] where there is no display or no GPU driver.
pub fn run(
    mut member: NodeHandle,
    pointers: [&str; 2],
    export: &Export,
    library: PaintLibrary,
) -> Result<(), UserError> {
    maulstick_ui_kit::language::follow_system();
    let mut app = app::App::new(&member, pointers, library)?;
    let export = export.clone();
    let viewport = eframe::egui::ViewportBuilder::default()
        .with_title("Maulstick")
        .with_app_id("maulstick")
        .with_inner_size(app.size());
    let options = eframe::NativeOptions {
        viewport,
        ..Default::default()
    };
    let lost = app.lost();
    let begun = std::cell::Cell::new(false);
    let result = eframe::run_native(
        "maulstick",
        options,
        Box::new(|creation| {
            begun.set(true);
            let state = creation
                .wgpu_render_state
                .as_ref()
                .ok_or("no graphics device")?;
            app.begin(&creation.egui_ctx, state, &export);
            app.follow_pens(creation);
            member.ready()?;
            Ok(Box::new(app.with_member(member)))
        }),
    );
    match result {
        Ok(()) => lost.check(),
        Err(eframe::Error::AppCreation(error)) => Err(UserError::failure(format!(
            "the window cannot be opened: {error}"
        ))),
        Err(error) if begun.get() => Err(UserError::failure(format!("the window ended: {error}"))),
        Err(error) => Err(unopened(&error)),
    }
}

/// The error of a window that could not be opened, with advice; another attempt would end the same way.
fn unopened(error: &eframe::Error) -> UserError {
    match error {
        eframe::Error::Wgpu(error) => {
            UserError::usage(format!("no graphics device draws the window: {error}")).help(
                "install a Vulkan or OpenGL driver (mesa-vulkan-drivers, or that of the graphics card); \
                 without a window: `maulstick up --headless`",
            )
        }
        _ => {
            let said = |name: &str| match std::env::var(name) {
                Ok(value) => format!("{name}={value}"),
                Err(_) => format!("{name} is not set"),
            };
            UserError::usage("the window has no display")
                .at(format!("{}, {}", said("DISPLAY"), said("WAYLAND_DISPLAY")))
                .help("set one of them; without a window: `maulstick up --headless`")
        }
    }
}
