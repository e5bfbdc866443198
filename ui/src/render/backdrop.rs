//! Desk and surfaces as pixels of the window, redrawn only where they have changed.
//!
//! A brush moves in every frame, the painting only under it. Without a graphics card the saved time goes to the
//! paint.

use eframe::egui::{PaintCallbackInfo, Shape};
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, wgpu};

use crate::render::gpu::{Filterable, Gpu, Pass, texture_binding};
use crate::render::show_surface::PixelRect;
use crate::render::surface::{Laid, Passes};
use crate::tracing::projection::Projector;
use crate::view::camera::View;

/// The backdrop, and the pass that copies it into the window.
#[derive(Debug)]
pub struct Backdrop {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    drawn: Option<Drawn>,
}

#[derive(Debug)]
struct Drawn {
    size: [u32; 2],
    /// Number of surfaces in it.
    surfaces: usize,
    view: wgpu::TextureView,
    bound: wgpu::BindGroup,
}

impl Backdrop {
    /// An empty backdrop.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let layout = gpu.layout("show_desk", &[texture_binding(Filterable::No)]);
        let shader = gpu.shader("show_desk", include_str!("shaders/show_desk.wgsl"));
        let pipeline = gpu.pipeline(&Pass {
            name: "show_desk",
            layout: &layout,
            shader: &shader,
            vertex: "cover",
            fragment: "copy",
            constants: &[],
            target: gpu.target,
            blend: None,
        });
        Self {
            layout,
            pipeline,
            drawn: None,
        }
    }

    /// Draws what has changed of the surfaces in a view of `size` pixels, from the lowest; returns
    /// how many pixels that were.
    pub fn update(&mut self, gpu: &Gpu, passes: &Passes, size: [u32; 2], laid: &[Laid]) -> u64 {
        self.update_with(gpu, passes, size, (laid, None))
    }

    /// As [`update`](Self::update), with what a projector throws on the lowest surface.
    pub(crate) fn update_with(
        &mut self,
        gpu: &Gpu,
        passes: &Passes,
        size: [u32; 2],
        (laid, projector): (&[Laid], Option<&Projector>),
    ) -> u64 {
        if laid.is_empty() {
            self.drawn = None;
            return 0;
        }
        let same = |drawn: &Drawn| (drawn.size, drawn.surfaces) == (size, laid.len());
        let mut changed = laid
            .iter()
            .fold(PixelRect::NOTHING, |all, laid| all.with(&laid.changed));
        if !self.drawn.as_ref().is_some_and(same) {
            self.drawn = Some(self.bare(gpu, size, laid.len()));
            changed = PixelRect::EVERYTHING;
        }
        let (Some(drawn), Some((from, extent))) = (&self.drawn, changed.within(size)) else {
            return 0;
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("backdrop"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &drawn.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Load,
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_scissor_rect(from[0], from[1], extent[0], extent[1]);
            for (i, laid) in laid.iter().enumerate() {
                if i == 0 {
                    passes.show.fill(&mut pass, &laid.bound);
                }
                passes.show.lay(&mut pass, &laid.bound);
                if let (0, Some(projector)) = (i, projector) {
                    projector.draw(&mut pass);
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        u64::from(extent[0]) * u64::from(extent[1])
    }

    /// The picture before anything is drawn in it.
    fn bare(&self, gpu: &Gpu, size: [u32; 2], surfaces: usize) -> Drawn {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = gpu.texture("backdrop", size.map(|n| n.max(1)), gpu.target, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let resource = wgpu::BindingResource::TextureView(&view);
        Drawn {
            size,
            surfaces,
            bound: gpu.bind(&self.layout, &[resource]),
            view,
        }
    }

    /// A shape of the window that fills the view; `None` before there is a surface.
    #[must_use]
    pub fn shape(&self, view: &View) -> Option<Shape> {
        let copy = Copy {
            pipeline: self.pipeline.clone(),
            bound: self.drawn.as_ref()?.bound.clone(),
        };
        Some(egui_wgpu::Callback::new_paint_callback(view.area, copy).into())
    }

    /// Its pixels, for passes that read the ground they draw on; `None` before there is a surface.
    #[must_use]
    pub fn pixels(&self) -> Option<&wgpu::TextureView> {
        self.drawn.as_ref().map(|drawn| &drawn.view)
    }
}

/// A copy into the window.
struct Copy {
    pipeline: wgpu::RenderPipeline,
    bound: wgpu::BindGroup,
}

impl Copy {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bound, &[]);
        pass.draw(0..4, 0..1);
    }
}

impl CallbackTrait for Copy {
    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        self.draw(pass);
    }
}

#[cfg(test)]
mod tests {
    use maulstick_appearance::picture::Export;

    use super::*;
    use crate::render::gpu::testing::{draw, gpu, read, target};
    use crate::render::surface::SurfaceView;
    use crate::render::surface::tests::{CELLS, lamp, look, shown, surface, tile, tiles};

    #[test]
    fn a_changed_tile_alone_is_drawn_anew_and_the_rest_stays() {
        let gpu = gpu();
        let (passes, surface) = (Passes::new(&gpu, &Export::default()), surface());
        let size = [200u32, 140];
        let look = look(&surface, size.map(|side| side as f32), 1.2);
        // Once as it comes, once all at the end.
        let bare = || {
            let mut tiles = tiles();
            tiles.iter_mut().for_each(|tile| tile.colour.fill(0x35));
            shown(tiles, 0, false)
        };
        let events = || shown(vec![tile(1, 0)], 0, false);
        let mut view = SurfaceView::default();
        let turn = |view: &mut SurfaceView, backdrop: &mut Backdrop| {
            view.light(&gpu, &passes, &lamp(), 2.5e-4);
            let laid = [view
                .lay(&gpu, &passes, &surface, &look, 1.0)
                .expect("a picture")];
            backdrop.update(&gpu, &passes, size, &laid)
        };
        let mut backdrop = Backdrop::new(&gpu);
        view.update(&gpu, &passes, &bare());
        assert_eq!(turn(&mut view, &mut backdrop), 200 * 140);
        assert_eq!(turn(&mut view, &mut backdrop), 0, "nothing has changed");
        view.update(&gpu, &passes, &events());
        let drawn = turn(&mut view, &mut backdrop);
        // A tile, and what its shadow may reach away from the lamp.
        let side = |reach: f32| (64.0 + reach + 1.0) * 1.2 + 8.0;
        let tile_pixels = side(16.0) * side(16.0);
        assert!(
            drawn > 0 && (drawn as f32) < tile_pixels,
            "{drawn} {tile_pixels}"
        );
        let pixels = |backdrop: &Backdrop| {
            let target = target(&gpu, size);
            let copy = Copy {
                pipeline: backdrop.pipeline.clone(),
                bound: backdrop.drawn.as_ref().expect("drawn").bound.clone(),
            };
            draw(&gpu, &target, wgpu::Color::RED, |pass| copy.draw(pass));
            read(&gpu, &target)
        };
        let by_parts = pixels(&backdrop);
        let mut whole = SurfaceView::default();
        whole.update(&gpu, &passes, &bare());
        whole.update(&gpu, &passes, &events());
        let mut backdrop = Backdrop::new(&gpu);
        turn(&mut whole, &mut backdrop);
        assert!(by_parts == pixels(&backdrop), "the same pixels in one go");
        let mut old = SurfaceView::default();
        old.update(&gpu, &passes, &bare());
        let mut backdrop = Backdrop::new(&gpu);
        turn(&mut old, &mut backdrop);
        assert!(by_parts != pixels(&backdrop), "a fault would pass");
        assert_eq!(
            by_parts[..4],
            [60, 60, 60, 255],
            "the desk, {CELLS:?} cells on it"
        );
    }
}
