//! The painter's view.
//!
//! | module | holds |
//! | --- | --- |
//! | [`app`] | the window, its actions, and the overlay: rack, panels, dialogs, help |
//! | `input` | keys, mouse and gestures |
//! | [`rig`] | state of the rig, and requests to it |
//! | [`view`] | the desk seen from above |
//! | [`render`] | drawing of desk, surfaces and brushes |
//! | `language` | languages, and the English sentences that are their keys |
//! | `motions` | takes that are put on the canvas |
//! | `matching` | from a colour to mixtures of paints |
//! | `panels` | the panels, a folder each |
//! | `dialogs` | files in the window: new, open, save, export, dropped files |
//! | `reference` | a picture to paint after, and the mixtures of its colours |
//! | `sessions` | recorder and player of sessions |
//! | `settings_page` | the dialog of settings: text size, theme, units, keys |
//! | `widgets` | parts that panels and dialogs are made of |
//! | [`settings`] | settings that outlive the window |
//! | `background_task` | work on a thread beside the window |
//! | `spectrum_file` | spectra from CSV files |

#[macro_use]
mod language;

mod advice;
pub mod app;
mod background_task;
mod dialogs;
mod input;
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

/// Shows the window until it is closed; `pointers` are the names of its mouse and its pen as devices, `export` says
/// what the display is, `library` what paints there are.
///
/// # Errors
/// A [`UserError`] where there is no display or no GPU driver.
pub fn run(
    mut member: NodeHandle,
    pointers: [&str; 2],
    export: &Export,
    library: PaintLibrary,
) -> Result<(), UserError> {
    language::follow_system();
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

/// The reason why no window could be opened, with advice; another attempt would end the same way.
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
            UserError::usage("the display of the window is not there")
                .at(format!("{}, {}", said("DISPLAY"), said("WAYLAND_DISPLAY")))
                .help("set one of them; without a window: `maulstick up --headless`")
        }
    }
}
