//! The painter's view.
//!
//! | module | holds |
//! | --- | --- |
//! | [`app`] | the window |
//! | [`studio`], [`hearing`] | what is known of the rig, and how it is heard |
//! | [`orders`], [`courier`] | what is asked of the rig, and who carries it there |
//! | [`shell`], [`panels`], [`rack`], [`toasts`], [`keys`] | what lies over the desk |
//! | [`files`] | files in the window: new, open, save, export, what is dropped |
//! | [`reference`] | a picture to paint after, and the mixtures of its colours |
//! | [`first_run`] | the line of help of a new painter |
//! | [`held`], [`rows`], [`tables`], [`thumbnails`] | what panels are made of: values in the hand, rows, files, small pictures |
//! | [`habits`] | what is remembered |
//! | [`task`] | work beside the window |
//! | [`habits`], [`presets`], [`paint_sets`] | what is remembered |
//! | [`brush_choice`], [`loading`] | the brush in the hand, and what it takes up |
//! | [`wells`] | what lies in the palette's wells |
//! | [`gallery`], [`swatches`] | brushes and paints as they look |
//! | [`row`] | rows of a panel |
//! | [`work`] | what a panel works with |
//! | [`stage`] | the desk in the window |
//! | [`view`] | the desk from above: its points in the window, and the way back |
//! | [`visible`] | what of a surface is in the view |
//! | [`frames`], [`pulling`] | the threads that pull frames, and what they ask next |
//! | [`surface`], [`sheet`] | a surface on the graphics device, and its pictures |
//! | [`light_surface`], [`show_surface`] | the passes that it goes through |
//! | [`backdrop`] | desk and surfaces as pixels of the window |
//! | [`felt`] | the newest samples of each device: who paints, and the force |
//! | [`watch`] | what became of the other processes |
//! | [`follow`] | the brushes as they are now: newest sample, newest bend |
//! | [`coat`] | the paint on them |
//! | [`brush_shape`] | ferrule, handle and shadows |
//! | [`brushes`], [`draw_head`], [`draw_handle`], [`cast_shadow`] | how it is drawn |
//! | [`sight`] | how it is seen and lit |
//! | [`tint`] | its colours, for displays other than sRGB |
//! | [`portrait`] | a brush as a picture |
//! | [`progress`] | how far long work is |
//! | [`presented`] | frames that are completed, and what they hold |
//! | [`gpu`] | the graphics device |
//! | [`offscreen`] | the desk without a window |
//! | [`lost`] | what happens where that is lost |
//! | [`mouse`] | the mouse as a stylus |
//! | [`hand`], [`lifting`], [`wave`] | the other hand, the cleaning key, a wave of the brush |
//! | [`glide`], [`well_names`] | the palette on its way, and what its wells hold |

pub mod app;
pub mod backdrop;
pub mod brush_choice;
pub mod brush_shape;
pub mod brushes;
pub mod cast_shadow;
pub mod coat;
pub mod courier;
pub mod draw_handle;
pub mod draw_head;
pub mod felt;
pub mod files;
pub mod first_run;
pub mod follow;
pub mod frames;
pub mod gallery;
pub mod glide;
pub mod gpu;
pub mod habits;
pub mod hand;
pub mod hearing;
pub mod held;
pub mod keys;
pub mod landing;
pub mod lifting;
pub mod light_surface;
pub mod loading;
pub mod lost;
pub mod mouse;
pub mod offscreen;
pub mod orders;
pub mod paint_sets;
pub mod panels;
pub mod portrait;
pub mod presented;
pub mod presets;
pub mod progress;
pub mod pulling;
pub mod rack;
pub mod reference;
pub mod row;
pub mod rows;
pub mod sheet;
pub mod shell;
pub mod show_surface;
pub mod sight;
pub mod stage;
pub mod studio;
pub mod surface;
pub mod swatches;
pub mod tables;
pub mod task;
pub mod thumbnails;
pub mod tint;
pub mod toasts;
pub mod view;
pub mod visible;
pub mod watch;
pub mod wave;
pub mod well_names;
pub mod wells;
pub mod work;

#[cfg(test)]
pub(crate) mod shell_bench;

#[cfg(test)]
pub(crate) mod testing;

#[cfg(test)]
pub(crate) mod workbench;

use maulstick_optics::PaintLibrary;
use maulstick_paint::picture::Export;
use maulstick_rig::{Fault, Member};

/// Shows the window until it is closed; `mouse` is the name of the mouse as a device, `export` says
/// what the display is, `library` what paints there are.
///
/// # Errors
/// A [`Fault`] where there is no display or no GPU driver.
pub fn run(
    mut member: Member,
    mouse: &str,
    export: &Export,
    library: PaintLibrary,
) -> Result<(), Fault> {
    let mut app = app::App::new(&member, mouse, library)?;
    let export = export.clone();
    let viewport = eframe::egui::ViewportBuilder::default()
        .with_title(format!("Maulstick · {}", member.config.rig.name))
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
            member.ready()?;
            Ok(Box::new(app.with_member(member)))
        }),
    );
    match result {
        Ok(()) => lost.check(),
        Err(eframe::Error::AppCreation(error)) => Err(Fault::failure(format!(
            "the window cannot be opened: {error}"
        ))),
        Err(error) if begun.get() => Err(Fault::failure(format!("the window ended: {error}"))),
        Err(error) => Err(unopened(&error)),
    }
}

/// Why there is no window, and what to do; another attempt would end the same way.
fn unopened(error: &eframe::Error) -> Fault {
    match error {
        eframe::Error::Wgpu(error) => {
            Fault::usage(format!("no graphics device draws the window: {error}")).help(
                "install a Vulkan or OpenGL driver (mesa-vulkan-drivers, or that of the graphics card); \
                 without a window: `maulstick up --headless`",
            )
        }
        _ => {
            let said = |name: &str| match std::env::var(name) {
                Ok(value) => format!("{name}={value}"),
                Err(_) => format!("{name} is not set"),
            };
            Fault::usage("the display of the window is not there")
                .at(format!("{}, {}", said("DISPLAY"), said("WAYLAND_DISPLAY")))
                .help("set one of them; without a window: `maulstick up --headless`")
        }
    }
}
