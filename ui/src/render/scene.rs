//! The desk in the window: frames of the surfaces, and the brushes over them.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui::{Context, Shape};
use eframe::egui_wgpu::{RenderState, wgpu};
use maulstick_appearance::lamp::lamp_over;
use maulstick_appearance::picture::Export;
use maulstick_bus::typed::{Refusal, random_epoch};
use maulstick_bus::{Bus, Wake};
use maulstick_rig::Stop;
use maulstick_types::scene::{CANVAS, PALETTE, Surface};
use maulstick_types::{Origin, name_hash};

use maulstick_client::frames::tiles::Wanted;
use maulstick_client::frames::{FrameInbox, FrameSource, pull};
use maulstick_client::state::RigEvent;

use crate::render::backdrop::Backdrop;
use crate::render::brush::renderer::{Below, BrushRenderer};
use crate::render::frame_reports::{Completion, Holding};
use crate::render::gpu::Gpu;
use crate::render::show_surface::PixelRect;
use crate::render::surface::{Laid, Passes, SurfaceView};
use crate::rig::brushes::BrushTracker;
use crate::rig::state::RigState;
use crate::tracing::projection::{Projector, Slide};
use crate::view::camera::View;
use crate::view::visible_tiles::wanted_by;

/// Shortest time between two drawings of the window for frames and samples, of which a device sends up to 1,000 a
/// second; longer if the processor draws, for the paint needs it too.
const REPAINT: Duration = Duration::from_millis(16);
const REPAINT_BY_PROCESSOR: Duration = Duration::from_millis(40);
/// A request without delay is for two frames, the second to settle what the first began.
const ONCE: Duration = Duration::from_nanos(1);
/// A device that takes longer for a frame is not waited for.
const LONGEST_FRAME: Duration = Duration::from_millis(250);
/// The surfaces that are shown, the lowest first.
const SURFACES: [u32; 2] = [CANVAS, PALETTE];

/// Frames of a surface and what they make.
#[derive(Debug, Default)]
struct SurfaceLayer {
    inbox: FrameInbox,
    view: SurfaceView,
}

/// Graphics device and passes.
#[derive(Debug)]
struct Painter {
    gpu: Gpu,
    passes: Passes,
    backdrop: Backdrop,
    projector: Projector,
    brushes: BrushRenderer,
}

/// View and light of the desk.
#[derive(Debug)]
pub(crate) struct Seen<'a> {
    /// Its projection in the window.
    pub view: &'a View,
    /// Pixels of a point.
    pub pixels_per_point: f32,
    /// The picture that is thrown on the canvas, and its strength.
    pub tracing: Option<(Arc<Slide>, f32)>,
}

/// Source of frames, and receiver of their reports.
pub(crate) struct Source {
    pub bus: Arc<dyn Bus>,
    /// The query for frames.
    pub topic: String,
    /// Rings when something has come.
    pub wake: Wake,
    /// When to end.
    pub stop: Stop,
    /// Progress of the device through the window's frames.
    pub completion: Completion,
}

/// The desk in the window.
#[derive(Debug, Default)]
pub(crate) struct SceneRenderer {
    surfaces: [SurfaceLayer; SURFACES.len()],
    painter: Option<Painter>,
    threads: Vec<JoinHandle<()>>,
    /// Brush states in the picture of the canvas.
    holding: Holding,
    /// Topic on which frames are requested.
    topic: String,
}

impl SceneRenderer {
    /// Starts to pull frames and to draw them, for a window on the display of `export`.
    pub(crate) fn begin(
        &mut self,
        context: &Context,
        state: &RenderState,
        export: &Export,
        source: Source,
    ) {
        let gpu = Gpu {
            device: state.device.clone(),
            queue: state.queue.clone(),
            target: state.target_format,
        };
        self.painter = Some(Painter {
            passes: Passes::new(&gpu, export),
            backdrop: Backdrop::new(&gpu),
            projector: Projector::new(&gpu),
            brushes: BrushRenderer::new(&gpu, export),
            gpu,
        });
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        let Source {
            bus,
            topic,
            wake,
            stop,
            completion,
        } = source;
        self.topic.clone_from(&topic);
        for (layer, surface) in self.surfaces.iter().zip(SURFACES) {
            let source = FrameSource {
                bus: Arc::clone(&bus),
                topic: topic.clone(),
                me,
                surface,
            };
            let inbox = layer.inbox.clone();
            let (wake, stop) = (wake.clone(), stop.clone());
            let run = move || pull(&source, &inbox, &wake, &stop);
            self.threads.extend(thread("frames", run));
        }
        let context = context.clone();
        let rest = match state.adapter.get_info().device_type {
            wgpu::DeviceType::Cpu => REPAINT_BY_PROCESSOR,
            _ => REPAINT,
        };
        let run = move || repaint(&wake, &context, &stop, &completion, rest);
        self.threads.extend(thread("repaint", run));
    }

    /// Takes in the frames that have come.
    pub(crate) fn take_in(&mut self, rig: &mut RigState) {
        for layer in &self.surfaces {
            if let Some(error) = layer.inbox.fault() {
                let (topic, reason) = (self.topic.clone(), error.into());
                let refusal = Refusal { topic, reason };
                rig.live.events.push(RigEvent::Refused(refusal));
            }
        }
        let progress = self.surfaces.iter().map(|layer| layer.inbox.progress());
        rig.drawn = progress.fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        let (Some(painter), Some(scene)) = (&self.painter, &rig.live.scene) else {
            return;
        };
        for (layer, id) in self.surfaces.iter_mut().zip(SURFACES) {
            for shown in layer.inbox.take() {
                if id == CANVAS && !shown.holds.is_empty() {
                    self.holding = Holding {
                        journal: shown.journal,
                        holds: shown.holds.clone(),
                    };
                }
                layer.view.update(&painter.gpu, &painter.passes, &shown);
            }
            if let Some(surface) = rig.live.surface(id) {
                let lamp = lamp_over(scene, id);
                let (gpu, passes) = (&painter.gpu, &painter.passes);
                layer.view.light(gpu, passes, &lamp, surface.cell_m);
            }
        }
    }

    /// The desk from the bottom: `surfaces` where they are to be seen, the tracing picture on the canvas, brushes.
    pub(crate) fn shapes(
        &mut self,
        rig: &RigState,
        surfaces: &[Surface],
        tracker: &BrushTracker,
        seen: &Seen<'_>,
    ) -> Vec<Shape> {
        let (view, pixels_per_point) = (seen.view, seen.pixels_per_point);
        let (Some(painter), Some(scene), Some(desk)) =
            (&mut self.painter, &rig.live.scene, &rig.desk)
        else {
            return Vec::new();
        };
        let (mut laid, mut projector_on) = (Vec::<Laid>::new(), false);
        for (layer, id) in self.surfaces.iter_mut().zip(SURFACES) {
            let Some(surface) = surfaces.iter().find(|surface| surface.id == id) else {
                continue;
            };
            let wanted = Wanted {
                wet: id == CANVAS && rig.show_wet,
                ..wanted_by(surface, view, pixels_per_point)
            };
            layer.inbox.want(wanted);
            let (gpu, passes) = (&painter.gpu, &painter.passes);
            let atlases = &mut layer.view;
            let mut own = atlases.lay(gpu, passes, surface, view, pixels_per_point);
            if let (CANVAS, Some(own)) = (id, &mut own) {
                let slide = seen.tracing.as_ref();
                let slide = slide.map(|(slide, strength)| (slide, *strength));
                let projector = &mut painter.projector;
                if projector.throw(gpu, slide, surface, (view, pixels_per_point)) {
                    own.changed = PixelRect::EVERYTHING;
                }
                projector_on = true;
            }
            laid.extend(own);
        }
        let size = view.pixels(pixels_per_point);
        let (gpu, passes) = (&painter.gpu, &painter.passes);
        let shown = (&laid[..], projector_on.then_some(&painter.projector));
        painter.backdrop.update_with(gpu, passes, size, shown);
        let mut shapes: Vec<Shape> = painter.backdrop.shape(view).into_iter().collect();
        for held in tracker.held(desk) {
            if let Some(head) = tracker.head(held.name) {
                let lamp = lamp_over(scene, held.plane.id);
                let brushes = &mut painter.brushes;
                let below = Below {
                    view,
                    pixels_per_point,
                    desk,
                    pixels: painter.backdrop.pixels(),
                };
                shapes.extend(brushes.shapes(&painter.gpu, &held, head, &lamp, &below));
            }
        }
        shapes
    }

    /// Brush states in the picture of the canvas.
    #[must_use]
    pub(crate) fn holding(&self) -> Holding {
        self.holding.clone()
    }

    /// Waits for the threads, which end when they are asked to stop.
    pub(crate) fn end(&mut self) {
        for layer in &self.surfaces {
            layer.inbox.wake();
        }
        for thread in self.threads.drain(..) {
            thread.join().ok();
        }
    }
}

/// Redraws the window when something has arrived, but not too often: no frame is begun within `rest` of the one before,
/// nor before the device has drawn it, or frames would wait for each other. The pause sets the pace of the window:
/// whatever arrives meanwhile is in the next frame.
fn repaint(wake: &Wake, context: &Context, stop: &Stop, completion: &Completion, rest: Duration) {
    while !stop.requested() {
        if wake.wait(Duration::from_millis(200)) {
            completion.wait(LONGEST_FRAME);
            context.request_repaint_after(ONCE);
            std::thread::sleep(rest);
        }
    }
    context.request_repaint();
}

fn thread(name: &str, run: impl FnOnce() + Send + 'static) -> Option<JoinHandle<()>> {
    let thread = std::thread::Builder::new().name(name.into()).spawn(run);
    thread
        .inspect_err(|error| tracing::error!("the thread '{name}' cannot be started: {error}"))
        .ok()
}
