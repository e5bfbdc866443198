//! The painter's view.
//!
//! | module | holds |
//! | --- | --- |
//! | [`app`] | the window |
//! | [`view`] | the desk from above: its points in the window, and the way back |
//! | [`frames`] | the threads that pull frames |
//! | [`surface`] | a surface on the graphics device |
//! | [`light_surface`], [`show_surface`] | the passes that it goes through |
//! | [`backdrop`] | desk and surfaces as pixels of the window |
//! | [`follow`] | the brushes as they are now: newest sample, newest bend |
//! | [`brush_shape`] | ferrule, handle and shadow |
//! | [`brushes`], [`draw_head`], [`draw_brush`] | how it is drawn |
//! | [`tint`] | its colours, for displays other than sRGB |
//! | [`portrait`] | a brush as a picture |
//! | [`progress`] | how far long work is |
//! | [`gpu`] | the graphics device |
//! | [`mouse`] | the mouse as a stylus |

pub mod app;
pub mod backdrop;
pub mod brush_shape;
pub mod brushes;
pub mod draw_brush;
pub mod draw_head;
pub mod follow;
pub mod frames;
pub mod gpu;
pub mod light_surface;
pub mod mouse;
pub mod portrait;
pub mod progress;
pub mod show_surface;
pub mod surface;
pub mod tint;
pub mod view;

use maulstick_paint::picture::Export;
use maulstick_rig::{Fault, Member};

/// Shows the window until it is closed; `mouse` is the name of the mouse as a device, `export` says
/// what the display is.
///
/// # Errors
/// A [`Fault`] where there is no display or no GPU driver.
pub fn run(mut member: Member, mouse: &str, export: &Export) -> Result<(), Fault> {
    let mut app = app::App::new(&member, mouse)?;
    let export = export.clone();
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
            let state = creation
                .wgpu_render_state
                .as_ref()
                .ok_or("no graphics device")?;
            app.begin(&creation.egui_ctx, state, &export);
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
