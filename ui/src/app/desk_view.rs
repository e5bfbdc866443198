//! The displayed desk: its place in the window, and its renderer.

use std::sync::Arc;

use eframe::egui::{Context, Painter, Rect, Ui};
use eframe::egui_wgpu::RenderState;
use maulstick_appearance::picture::Export;
use maulstick_brush::palette_place::Side;
use maulstick_bus::typed::random_epoch;
use maulstick_types::scene::Surface;
use maulstick_types::{Origin, name_hash};
use maulstick_ui_kit::display_transform::DisplayTransform;

use crate::app::connection::Connection;
use crate::app::studio::Studio;
use crate::render::frame_reports::Presenter;
use crate::render::scene::{SceneRenderer, Seen, Source};
use crate::rig::state::RigState;
use crate::tracing::TracingPicture;
use crate::view::camera::View;
use crate::view::held_view::{self, HeldView};
use crate::view::palette_slide::PaletteSlide;

/// View of the desk.
#[derive(Default)]
pub(super) struct DeskView {
    /// Place of the desk in the window; `None` until the canvas is known.
    pub(super) view: Option<View>,
    /// Side of the palette at the last check, and the start of the paint node then.
    pub(super) side: Option<(Side, u64)>,
    pub(super) scene_renderer: SceneRenderer,
    presenter: Option<Presenter>,
    held_view: HeldView,
    palette_slide: PaletteSlide,
    tracing: TracingPicture,
}

impl DeskView {
    /// Starts to pull frames and to draw them, for a window on the display of `export`.
    pub(super) fn begin(
        &mut self,
        context: &Context,
        state: &RenderState,
        export: &Export,
        (connection, rig): (&Connection, &mut RigState),
    ) {
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        let bus = Arc::clone(&connection.bus);
        let presenter = Presenter::new(bus, &connection.topics, me, &state.device);
        self.presenter = presenter
            .inspect_err(|error| tracing::warn!("frames cannot be reported: {error}"))
            .ok();
        let completion = self.presenter.as_ref().map(Presenter::completion);
        let source = Source {
            bus: Arc::clone(&connection.bus),
            topic: connection.topics.frame(),
            wake: connection.wake.clone(),
            stop: connection.stop.clone(),
            completion: completion.unwrap_or_default(),
        };
        rig.tint = Arc::new(DisplayTransform::new(export));
        self.scene_renderer.begin(context, state, export, source);
    }

    /// Places the desk in the window, beside tools of these widths at its left and right side; under a held brush it
    /// stays.
    pub(super) fn place(
        &mut self,
        ui: &Ui,
        studio: &Studio,
        [left, right]: [f32; 2],
        is_held: bool,
    ) {
        let preferences = &studio.preferences;
        let side = if preferences.rack_is_left() {
            Side::Right
        } else {
            Side::Left
        };
        // Beside the palette the desk itself is narrower.
        let mut area: Rect = ui.max_rect();
        let taken = match side {
            Side::Left => {
                area.min.x += left;
                right
            }
            Side::Right => {
                area.max.x -= right;
                left
            }
        };
        let (canvas, palette) = (studio.rig.live.canvas(), studio.rig.live.palette());
        let mut wanted = canvas.and_then(|canvas| View::of(area, canvas, palette, side, taken));
        if preferences.window.mirrored {
            wanted = wanted.map(View::mirrored);
        }
        let pixels_per_point = ui.ctx().pixels_per_point();
        let corner = ui.input(|input| input.viewport().inner_rect.map(|rect| rect.min));
        let frame = held_view::Frame {
            pixels_per_point,
            corner_px: corner.unwrap_or_default() * pixels_per_point,
        };
        self.view = self.held_view.follow(wanted, frame, is_held);
    }

    /// The displayed surfaces: the palette may be moving.
    pub(super) fn surfaces(&mut self, ui: &Ui, rig: &RigState) -> Vec<Surface> {
        let surfaces = rig.live.scene.iter().flat_map(|scene| &scene.surfaces);
        let mut surfaces: Vec<Surface> = surfaces.cloned().collect();
        let now_s = ui.input(|input| input.time);
        if self.palette_slide.show(now_s, &mut surfaces) {
            ui.ctx().request_repaint();
        }
        surfaces
    }

    /// Draws surfaces and brushes.
    pub(super) fn draw(
        &mut self,
        ui: &Ui,
        (view, surfaces): (&View, &[Surface]),
        (connection, studio): (&Connection, &mut Studio),
    ) {
        let seen = Seen {
            view,
            pixels_per_point: ui.ctx().pixels_per_point(),
            tracing: self.tracing.follow(ui.ctx(), &mut studio.context()),
        };
        let (rig, tracker) = (&studio.rig, &connection.tracker);
        let shapes = self.scene_renderer.shapes(rig, surfaces, tracker, &seen);
        ui.painter().extend(shapes);
    }

    /// Reports the frame once it is drawn.
    pub(super) fn report(&mut self, painter: &Painter, view: &View, begun_ns: u64) {
        if let Some(presenter) = &mut self.presenter {
            let holding = self.scene_renderer.holding();
            painter.add(presenter.shape(view.area, begun_ns, holding));
        }
    }
}
