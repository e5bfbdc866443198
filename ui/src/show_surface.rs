//! Shows a lit surface where it lies on the desk.

use bytemuck::{Pod, Zeroable};
use eframe::egui::{Pos2, Vec2};
use eframe::egui_wgpu::wgpu;
use maulstick_types::scene::Surface;

use crate::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};
use crate::view::{View, corners};

/// Where a surface is in the view, as the shader takes it: pixels, from the view's upper left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Place {
    corner: [f32; 2],
    right: [f32; 2],
    up: [f32; 2],
    view: [f32; 2],
    share: [f32; 2],
    spread: [f32; 2],
}

/// The cells that a texture has for a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// Texels across and up.
    pub cells: [u32; 2],
    /// Level of detail: 2 to this power cells of the surface a texel, each way.
    pub level: u32,
}

impl Place {
    /// The place of a surface.
    #[must_use]
    pub fn of(surface: &Surface, view: &View, pixels_per_point: f32, detail: Detail) -> Self {
        let at = corners(surface).map(|corner| view.to_window(corner));
        let pixels = |v: Vec2| (v * pixels_per_point).into();
        let (right, up) = (at[1] - at[0], at[2] - at[0]);
        let sides = [right, up].map(|side| side.length() * pixels_per_point);
        let whole = detail.cells.map(|cells| (cells << detail.level) as f32);
        let share = [0, 1].map(|i| (surface.cells[i] as f32 / whole[i].max(1.0)).min(1.0));
        let texels = [0, 1].map(|i| share[i] * detail.cells[i] as f32);
        // Below one texel a pixel the sampler's own interpolation is all there is to do.
        let minified = (0..2).any(|i| texels[i] > 1.01 * sides[i]);
        let spread = sides.map(|side| if minified { 0.25 / side.max(1.0) } else { 0.0 });
        Self {
            corner: pixels(at[0] - view.area.min),
            right: pixels(right),
            up: pixels(up),
            view: pixels(view.area.size()),
            share,
            spread,
        }
    }

    /// Pixels of the surface's sides, across and up.
    #[must_use]
    pub fn pixels(surface: &Surface, view: &View, pixels_per_point: f32) -> [f32; 2] {
        let at: [Pos2; 4] = corners(surface).map(|corner| view.to_window(corner));
        [at[1], at[2]].map(|end| (end - at[0]).length() * pixels_per_point)
    }
}

/// The pass.
#[derive(Clone, Debug)]
pub struct ShowSurface {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
}

impl ShowSurface {
    /// The pass on a device.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let bindings = [UNIFORM, texture_binding(Filterable::Yes), sampler];
        let layout = gpu.layout("show_surface", &bindings);
        let shader = gpu.shader("show_surface", include_str!("shaders/show_surface.wgsl"));
        let pipeline = gpu.pipeline(&Pass {
            name: "show_surface",
            layout: &layout,
            shader: &shader,
            vertex: "lay",
            fragment: "show",
            constants: &gpu.encoding(),
            target: gpu.target,
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("show_surface"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            layout,
            pipeline,
            sampler,
        }
    }

    /// Binds a [`Place`] and the lit surface.
    #[must_use]
    pub fn bind(
        &self,
        gpu: &Gpu,
        place: &wgpu::Buffer,
        lit: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let resources = [
            place.as_entire_binding(),
            wgpu::BindingResource::TextureView(lit),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        gpu.bind(&self.layout, &resources)
    }

    /// Draws into a pass whose viewport is the view.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, bound: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bound, &[]);
        pass.draw(0..4, 0..1);
    }
}
