//! The desk without a window: shapes drawn into a picture, as eframe draws them into a window.

use eframe::egui::{Context, Pos2, Rect, Shape, Ui, Vec2};
use eframe::egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor, wgpu};

use crate::render::gpu::Gpu;
use crate::view::camera::DESK_COLOUR;

/// A picture to draw into, on a graphics device of its own.
pub struct Offscreen {
    gpu: Gpu,
    adapter: String,
    renderer: Renderer,
    context: Context,
    target: wgpu::Texture,
    view: wgpu::TextureView,
    size: [u32; 2],
}

/// A picture that cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum OffscreenError {
    /// No driver.
    #[error("no Vulkan driver: {0}")]
    Driver(#[from] wgpu::RequestAdapterError),
    /// No device.
    #[error("no graphics device: {0}")]
    Device(#[from] wgpu::RequestDeviceError),
    /// The device is lost.
    #[error("the graphics device is lost: {0}")]
    Lost(#[from] wgpu::PollError),
}

impl Offscreen {
    /// A picture of `size` pixels.
    ///
    /// # Errors
    /// [`OffscreenError`] where there is no Vulkan driver or it gives no device.
    pub fn new(size: [u32; 2]) -> Result<Self, OffscreenError> {
        let mut instance = wgpu::InstanceDescriptor::new_without_display_handle();
        instance.backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(instance);
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let limits = wgpu::Limits {
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let asked = wgpu::DeviceDescriptor {
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&asked))?;
        // As most windows, it encodes by itself as little as possible.
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let gpu = Gpu {
            device,
            queue,
            target: format,
        };
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let target = gpu.texture("offscreen", size, format, usage);
        Ok(Self {
            adapter: adapter.get_info().name,
            renderer: Renderer::new(&gpu.device, format, RendererOptions::default()),
            context: Context::default(),
            view: target.create_view(&wgpu::TextureViewDescriptor::default()),
            target,
            gpu,
            size,
        })
    }

    /// The device that draws.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Name of its adapter.
    #[must_use]
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// The whole picture, one point a pixel.
    #[must_use]
    pub fn area(&self) -> Rect {
        Rect::from_min_size(Pos2::ZERO, Vec2::from(self.size.map(|side| side as f32)))
    }

    /// Draws shapes over a bare desk and waits until they are drawn.
    ///
    /// # Errors
    /// [`OffscreenError`] where the device is lost.
    pub fn draw(&mut self, shapes: Vec<Shape>) -> Result<(), OffscreenError> {
        let area = self.area();
        let input = eframe::egui::RawInput {
            screen_rect: Some(area),
            ..Default::default()
        };
        let shapes = std::cell::RefCell::new(shapes);
        let output = self.context.run_ui(input, |ui: &mut Ui| {
            ui.painter().with_clip_rect(area).extend(shapes.take());
        });
        let Gpu { device, queue, .. } = &self.gpu;
        let deltas = output.textures_delta.set.iter();
        deltas.for_each(|(id, deltas)| {
            for delta in deltas {
                self.renderer.update_texture(device, queue, *id, delta);
            }
        });
        let jobs = self.context.tessellate(output.shapes, 1.0);
        let screen = ScreenDescriptor {
            size_in_pixels: self.size,
            pixels_per_point: 1.0,
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut buffers = self
            .renderer
            .update_buffers(device, queue, &mut encoder, &jobs, &screen);
        {
            let [r, g, b, a] = DESK_COLOUR.to_normalized_gamma_f32().map(f64::from);
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("offscreen"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            self.renderer
                .render(&mut pass.forget_lifetime(), &jobs, &screen);
        }
        buffers.push(encoder.finish());
        queue.submit(buffers);
        let free = output.textures_delta.free.iter();
        free.for_each(|id| self.renderer.free_texture(id));
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(drop)
            .map_err(OffscreenError::from)
    }

    /// Target texture.
    #[must_use]
    pub fn target(&self) -> &wgpu::Texture {
        &self.target
    }
}
