//! Pass that draws the desk and the lit surfaces on it.

use bytemuck::{Pod, Zeroable};
use eframe::egui::Pos2;
use eframe::egui_wgpu::wgpu;
use half::f16;
use maulstick_brush::palette_place::corner_radii;
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::icc::Profile;
use maulstick_types::scene::{CANVAS, Surface};
use wgpu::util::DeviceExt as _;

use crate::render::gpu::{CUBE, Filterable, Gpu, Pass, UNIFORM, texture_binding};
use crate::render::light_surface::CellRect;
use crate::view::camera::{DESK_COLOUR, View, corners};

/// Reach of the shadow of the palette's board, points, and its darkness.
const SHADE: f32 = 14.0;
const SHADED: f32 = 0.45;

/// Placement of a surface in the view, as the shader takes it: pixels, from the view's upper left; corner and sides are
/// homogeneous.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Place {
    corner: [f32; 2],
    right: [f32; 2],
    up: [f32; 2],
    view: [f32; 2],
    spread: [f32; 2],
    shade: [f32; 2],
    depth: [f32; 4],
    radii: [f32; 4],
    sides: [f32; 2],
    pad: [f32; 2],
    detail: Region,
    base: Region,
}

/// Region of a surface that an atlas shows, in cells of its level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Region {
    /// The surface's sides.
    pub extent: [f32; 2],
    /// The same in whole cells, as many as show all of the surface.
    pub texels: [f32; 2],
    /// Texels of the atlas, a torus.
    pub size: [f32; 2],
    /// The least cells that may be shown.
    pub low: [f32; 2],
    /// The greatest, the end of the last of them.
    pub high: [f32; 2],
    /// Nothing.
    pub pad: [f32; 2],
}

impl Place {
    /// The place of a surface whose detail and base show these regions; a base of no extent shows
    /// nothing.
    #[must_use]
    pub fn of(
        surface: &Surface,
        view: &View,
        pixels_per_point: f32,
        [detail, base]: [Region; 2],
    ) -> Self {
        let ([corner, right, up], depth) = view.quad(surface).pixels(pixels_per_point);
        let sides = Self::pixels(surface, view, pixels_per_point);
        // Below one texel a pixel the sampler's own interpolation is all there is to do.
        let minified = (0..2).any(|i| detail.extent[i] > 1.01 * sides[i]);
        let shade = match surface.id {
            CANVAS => [0.0; 2],
            _ => [SHADE * pixels_per_point, SHADED],
        };
        let pixels_per_m = view.scale * f64::from(pixels_per_point) * surface.zoom;
        let spread = sides.map(|side| if minified { 0.25 / side.max(1.0) } else { 0.0 });
        Self {
            corner,
            right,
            up,
            view: (view.area.size() * pixels_per_point).into(),
            spread,
            shade,
            depth,
            sides,
            pad: [0.0; 2],
            radii: corner_radii(surface).map(|radius_m| (radius_m * pixels_per_m) as f32),
            detail,
            base,
        }
    }

    /// The pixels of the view that cells of an atlas touch, with those that their filtered edges reach; `extent` is the
    /// surface's at the atlas's level.
    #[must_use]
    pub fn covered(&self, area: &CellRect, extent: [f32; 2]) -> PixelRect {
        const REACH: f32 = 3.0;
        let mut rect = PixelRect::NOTHING;
        for corner in 0..4u32 {
            let [across, up] = [0, 1].map(|i| {
                let end = area.from[i] + ((corner >> i) & 1) * area.size[i];
                end as f32 / extent[i].max(1e-6)
            });
            let depth = self.depth[0] + across * self.depth[1] + up * self.depth[2];
            if depth <= 0.0 {
                return PixelRect::EVERYTHING;
            }
            let pixel =
                [0, 1].map(|i| (self.corner[i] + across * self.right[i] + up * self.up[i]) / depth);
            let around = PixelRect {
                from: pixel.map(|at| (at - REACH).floor().max(0.0) as u32),
                to: pixel.map(|at| (at + REACH).ceil().max(0.0) as u32),
            };
            rect = rect.with(&around);
        }
        rect
    }

    /// Pixels of the surface's sides, across and up.
    #[must_use]
    pub fn pixels(surface: &Surface, view: &View, pixels_per_point: f32) -> [f32; 2] {
        let at: [Pos2; 4] = corners(surface).map(|corner| view.to_window(corner));
        [at[1], at[2]].map(|end| (end - at[0]).length() * pixels_per_point)
    }
}

/// A rectangle of pixels, from the upper left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column and row.
    pub from: [u32; 2],
    /// One past the last.
    pub to: [u32; 2],
}

impl PixelRect {
    /// No pixel.
    pub const NOTHING: Self = Self {
        from: [u32::MAX; 2],
        to: [0; 2],
    };

    /// All pixels.
    pub const EVERYTHING: Self = Self {
        from: [0; 2],
        to: [u32::MAX; 2],
    };

    /// The smallest rectangle around this one and another.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            from: [0, 1].map(|i| self.from[i].min(other.from[i])),
            to: [0, 1].map(|i| self.to[i].max(other.to[i])),
        }
    }

    /// Its part in a picture of `size`: corner and size; `None` if that is empty.
    #[must_use]
    pub fn within(&self, size: [u32; 2]) -> Option<([u32; 2], [u32; 2])> {
        let to = [0, 1].map(|i| self.to[i].min(size[i]));
        let inside = (0..2).all(|i| self.from[i] < to[i]);
        inside.then(|| (self.from, [0, 1].map(|i| to[i] - self.from[i])))
    }
}

/// Nodes of the side of a profile's cube: with the steps of eight bits between them the error is below
/// half a step for the curves of displays.
const CUBE_SIDE: usize = 33;

/// A cube of colours, red fastest.
fn cube_texture(gpu: &Gpu, colours: &[[f32; 3]]) -> wgpu::TextureView {
    let side = (1..=CUBE_SIDE)
        .find(|side| side * side * side >= colours.len())
        .unwrap_or(CUBE_SIDE) as u32;
    let texel = |[r, g, b]: &[f32; 3]| [*r, *g, *b, 1.0].map(f16::from_f32);
    let halves = colours.iter().flat_map(texel);
    let bytes: Vec<u8> = halves.flat_map(f16::to_le_bytes).collect();
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("profile"),
            size: wgpu::Extent3d {
                width: side,
                height: side,
                depth_or_array_layers: side,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &bytes,
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Passes that draw a surface.
#[derive(Clone, Debug)]
pub struct ShowSurface {
    layout: wgpu::BindGroupLayout,
    fill: wgpu::RenderPipeline,
    show: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    torus: wgpu::Sampler,
    cube: wgpu::TextureView,
}

impl ShowSurface {
    /// The passes on a device, for a display with this profile.
    #[must_use]
    pub fn new(gpu: &Gpu, profile: &Profile) -> Self {
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let texture = texture_binding(Filterable::Yes);
        let bindings = [UNIFORM, texture, sampler, CUBE, texture, sampler];
        let layout = gpu.layout("show_surface", &bindings);
        let shader = gpu.shader("show_surface", include_str!("shaders/show_surface.wgsl"));
        let encoded = f64::from(DESK_COLOUR.r()) / 255.0;
        let grey = if gpu.target.is_srgb() {
            srgb_decode(encoded)
        } else {
            encoded
        };
        let cube = profile.cube(CUBE_SIDE);
        let foreign = ("foreign", f64::from(u8::from(cube.is_some())));
        let pipeline = |vertex: &'static str, fragment: &'static str, blend| {
            gpu.pipeline(&Pass {
                name: "show_surface",
                layout: &layout,
                shader: &shader,
                vertex,
                fragment,
                constants: &[gpu.encoding(), ("grey", grey), foreign],
                target: gpu.target,
                blend,
            })
        };
        let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        let sampler = |mode| {
            gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("show_surface"),
                address_mode_u: mode,
                address_mode_v: mode,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            })
        };
        Self {
            fill: pipeline("cover", "fill", None),
            show: pipeline("lay", "show", Some(over)),
            layout,
            sampler: sampler(wgpu::AddressMode::ClampToEdge),
            torus: sampler(wgpu::AddressMode::Repeat),
            cube: cube_texture(gpu, &cube.unwrap_or_else(|| vec![[0.0; 3]])),
        }
    }

    /// Binds a [`Place`] and the lit sheets: detail and base.
    #[must_use]
    pub fn bind(
        &self,
        gpu: &Gpu,
        place: &wgpu::Buffer,
        [detail, base]: [&wgpu::TextureView; 2],
    ) -> wgpu::BindGroup {
        let resources = [
            place.as_entire_binding(),
            wgpu::BindingResource::TextureView(detail),
            wgpu::BindingResource::Sampler(&self.sampler),
            wgpu::BindingResource::TextureView(&self.cube),
            wgpu::BindingResource::TextureView(base),
            wgpu::BindingResource::Sampler(&self.torus),
        ];
        gpu.bind(&self.layout, &resources)
    }

    /// Draws the desk under the lowest surface.
    pub fn fill(&self, pass: &mut wgpu::RenderPass<'_>, lowest: &wgpu::BindGroup) {
        pass.set_pipeline(&self.fill);
        pass.set_bind_group(0, lowest, &[]);
        pass.draw(0..4, 0..1);
    }

    /// Draws a surface over what is drawn.
    pub fn lay(&self, pass: &mut wgpu::RenderPass<'_>, bound: &wgpu::BindGroup) {
        pass.set_pipeline(&self.show);
        pass.set_bind_group(0, bound, &[]);
        pass.draw(0..4, 0..1);
    }
}
