//! The painter's view.
//!
//! | module | holds |
//! | --- | --- |
//! | [`app`] | the window |
//! | [`canvas`] | the picture of the canvas, and where on the desk a point of it is |
//! | [`frames`] | the thread that pulls frames |
//! | [`mouse`] | the mouse as a stylus |

pub mod app;
pub mod canvas;
pub mod frames;
pub mod mouse;

use maulstick_rig::{Fault, Member};

/// Shows the window until it is closed; `mouse` is the name of the mouse as a device.
///
/// # Errors
/// A [`Fault`] where there is no display or no GPU driver.
pub fn run(mut member: Member, mouse: &str) -> Result<(), Fault> {
    let mut app = app::App::new(&member, mouse)?;
    let viewport = eframe::egui::ViewportBuilder::default()
        .with_title(format!("Maulstick · {}", member.config.rig.name))
        .with_app_id("maulstick")
        .with_inner_size([1100.0, 1000.0]);
    let options = eframe::NativeOptions {
        viewport,
        ..Default::default()
    };
    let result = eframe::run_native(
        "maulstick",
        options,
        Box::new(move |creation| {
            app.begin(&creation.egui_ctx);
            member.ready()?;
            Ok(Box::new(app.with_member(member)))
        }),
    );
    result.map_err(|error| {
        Fault::failure(format!("the window cannot be opened: {error}")).help(
            "set DISPLAY or WAYLAND_DISPLAY, and install a Vulkan driver: mesa-vulkan-drivers",
        )
    })
}
