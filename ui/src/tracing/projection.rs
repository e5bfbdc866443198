//! Pass that throws a picture on a surface: the surface's colours are multiplied by the picture's.

use std::sync::{Arc, Weak};

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::wgpu;
use maulstick_types::scene::Surface;

use crate::reference::picture::Picture;
use crate::render::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};
use crate::view::camera::View;

/// A picture ready to be thrown: encoded sRGB in levels, each half as large as the one before, down to a pixel.
#[derive(Debug)]
pub(crate) struct Slide {
    size: [usize; 2],
    levels: Vec<(usize, Vec<[u8; 4]>)>,
}

impl Slide {
    /// A picture in levels.
    #[must_use]
    pub(crate) fn of(picture: &Picture) -> Self {
        let opaque = |[r, g, b]: &[u8; 3]| [*r, *g, *b, u8::MAX];
        let (mut size, mut pixels) = (
            picture.size,
            picture.rgb().iter().map(opaque).collect::<Vec<_>>(),
        );
        let mut levels = Vec::new();
        while size != [1, 1] {
            let half = size.map(|side| (side / 2).max(1));
            let mut smaller = Vec::with_capacity(half[0] * half[1]);
            for (y, x) in (0..half[1]).flat_map(|y| (0..half[0]).map(move |x| (y, x))) {
                let last = |at: usize, side: usize| at.min(side - 1);
                let four = [0, 1, 2, 3].map(|i| {
                    let (x, y) = (last(2 * x + i % 2, size[0]), last(2 * y + i / 2, size[1]));
                    pixels[y * size[0] + x]
                });
                let mean = |c: usize| (four.iter().map(|p| u32::from(p[c])).sum::<u32>() + 2) / 4;
                smaller.push([0, 1, 2, 3].map(|c| mean(c) as u8));
            }
            levels.push((size[0], std::mem::replace(&mut pixels, smaller)));
            size = half;
        }
        levels.push((1, pixels));
        Self {
            size: picture.size,
            levels,
        }
    }

    fn texture(&self, gpu: &Gpu) -> wgpu::TextureView {
        let [width, height] = self.size.map(|side| side as u32);
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("tracing"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: self.levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (level, (across, pixels)) in self.levels.iter().enumerate() {
            let mut to = texture.as_image_copy();
            to.mip_level = level as u32;
            let rows = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * *across as u32),
                rows_per_image: None,
            };
            let size = wgpu::Extent3d {
                width: *across as u32,
                height: (pixels.len() / across) as u32,
                depth_or_array_layers: 1,
            };
            let bytes = bytemuck::cast_slice(pixels);
            gpu.queue.write_texture(to, bytes, rows, size);
        }
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// Place of the picture in the view, as the shader takes it: pixels, from the view's upper left; corner and sides are
/// homogeneous.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Place {
    corner: [f32; 2],
    right: [f32; 2],
    up: [f32; 2],
    view: [f32; 2],
    depth: [f32; 4],
    strength: f32,
    pad: [f32; 3],
}

impl Place {
    /// A picture of a size in the middle of a surface, as large as it fits.
    fn of(
        (size, strength): ([usize; 2], f32),
        surface: &Surface,
        view: &View,
        pixels_per_point: f32,
    ) -> Self {
        let [across, high] = [0, 1].map(|i| f64::from(surface.cells[i]) / size[i] as f64);
        let fits = across.min(high);
        let [wide, tall] = [fits / across, fits / high];
        let beside = [wide, tall].map(|share| 0.5 * (1.0 - share));
        let picture = view.quad(surface).part(beside, [wide, tall]);
        let ([corner, right, up], depth) = picture.pixels(pixels_per_point);
        Self {
            corner,
            right,
            up,
            view: (view.area.size() * pixels_per_point).into(),
            depth,
            strength,
            pad: [0.0; 3],
        }
    }
}

/// Bindings of the picture that is drawn, and its source and place.
#[derive(Debug)]
struct Thrown {
    slide: Weak<Slide>,
    place: Place,
    uniform: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

/// The projector: the pass, and the picture in it.
#[derive(Debug)]
pub(crate) struct Projector {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    thrown: Option<Thrown>,
}

impl Projector {
    /// A projector without a picture.
    #[must_use]
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let bindings = [UNIFORM, texture_binding(Filterable::Yes), sampler];
        let layout = gpu.layout("show_tracing", &bindings);
        let source = include_str!("../render/shaders/show_tracing.wgsl");
        let shader = gpu.shader("show_tracing", source);
        let part = |src_factor, dst_factor| wgpu::BlendComponent {
            src_factor,
            dst_factor,
            operation: wgpu::BlendOperation::Add,
        };
        let product = wgpu::BlendState {
            color: part(wgpu::BlendFactor::Dst, wgpu::BlendFactor::Zero),
            alpha: part(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One),
        };
        let pipeline = gpu.pipeline(&Pass {
            name: "show_tracing",
            layout: &layout,
            shader: &shader,
            vertex: "lay",
            fragment: "show",
            constants: &[gpu.encoding()],
            target: gpu.target,
            blend: Some(product),
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("show_tracing"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        Self {
            layout,
            pipeline,
            sampler,
            thrown: None,
        }
    }

    /// Throws a picture with its strength on a surface, or none; true if that differs from what was thrown before.
    pub(crate) fn throw(
        &mut self,
        gpu: &Gpu,
        slide: Option<(&Arc<Slide>, f32)>,
        surface: &Surface,
        (view, pixels_per_point): (&View, f32),
    ) -> bool {
        let Some((slide, strength)) = slide else {
            return self.thrown.take().is_some();
        };
        let place = Place::of((slide.size, strength), surface, view, pixels_per_point);
        if let Some(thrown) = &mut self.thrown
            && thrown.slide.ptr_eq(&Arc::downgrade(slide))
        {
            let changes = thrown.place != place;
            if changes {
                thrown.place = place;
                let bytes = bytemuck::bytes_of(&thrown.place);
                gpu.queue.write_buffer(&thrown.uniform, 0, bytes);
            }
            return changes;
        }
        let uniform = gpu.uniform::<Place>("show_tracing");
        gpu.queue
            .write_buffer(&uniform, 0, bytemuck::bytes_of(&place));
        let picture = slide.texture(gpu);
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&picture),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        self.thrown = Some(Thrown {
            slide: Arc::downgrade(slide),
            place,
            bound: gpu.bind(&self.layout, &resources),
            uniform,
        });
        true
    }

    /// Draws the picture over the surface that was drawn last.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(thrown) = &self.thrown {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &thrown.bound, &[]);
            pass.draw(0..4, 0..1);
        }
    }
}
