//! Pass that lights an atlas: unlit colour, gloss and height into linear light of the display's gamut, in the
//! cells of the atlas.

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::wgpu;
use maulstick_optics::gamut::{FOR_COLOUR, Gamut, GamutMapping, HALVINGS, KNEE};
use maulstick_optics::light::environment::{SHARPEST, STEPS};
use maulstick_optics::light::gloss::ROUGHNESS;
use maulstick_optics::light::shadow::{LEAST_DENOMINATOR, TAPS};
use maulstick_optics::light::{AMBIENT, DIMMING, Lamp, SURFACE, Surroundings, sky};

pub(crate) mod environment;

use crate::render::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};

/// Unlit linear colour and gloss.
pub(crate) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Height, m.
pub(crate) const HEIGHT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Lit linear colour within the gamut.
pub(crate) const LIT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The lamp, its shadows and the sky as the shader takes them.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LampUniform {
    toward: [f32; 3],
    intensity: f32,
    upper: [f32; 3],
    relief: f32,
    mirror: [f32; 2],
    peak: f32,
    graze: f32,
    cell_m: f32,
    /// Of the shadows: cells that a metre is high, and 1/w; c and l_z.
    rise: f32,
    sharpness: f32,
    softness: f32,
    along: [f32; 2],
    _pad: [f32; 2],
    colour: [f32; 3],
    _pad2: f32,
    albedo: [f32; 3],
    /// 1 where the gloss mirrors the environment map, 0 in an even room.
    mapped: f32,
    cells: [[i32; 4]; TAPS],
    /// Weight, s·c, s·l_z.
    runs: [[f32; 4]; TAPS],
    ways: [[f32; 4]; sky::DIRECTIONS],
    /// Column, row, steepness.
    sky: [[f32; 4]; sky::TAPS],
}

impl LampUniform {
    /// A lamp and what hides it over cells of side `cell_m`.
    #[must_use]
    pub(crate) fn new(lamp: &Lamp, surroundings: &Surroundings, cell_m: f32) -> Self {
        let Surroundings { shadows, sky, .. } = surroundings;
        let place = |i: usize| {
            let tap = sky.taps[i / sky::RINGS][i % sky::RINGS];
            let [x, y] = tap.cell.map(|v| v as f32);
            [x, y, tap.steepness, 0.0]
        };
        Self {
            toward: lamp.toward,
            intensity: lamp.intensity,
            upper: lamp.upper,
            relief: lamp.relief,
            mirror: lamp.mirror,
            peak: lamp.peak,
            graze: lamp.graze,
            cell_m,
            rise: shadows.rise,
            sharpness: shadows.sharpness,
            softness: lamp.softness,
            along: shadows.toward,
            _pad: [0.0; 2],
            colour: lamp.colour,
            _pad2: 0.0,
            albedo: lamp.albedo,
            mapped: f32::from(u8::from(lamp.environment.is_some())),
            cells: shadows.taps.map(|tap| {
                let [[x, y], [x2, y2]] = tap.cells;
                [x, y, x2, y2]
            }),
            runs: shadows
                .taps
                .map(|tap| [tap.weight, tap.run[0], tap.run[1], 0.0]),
            ways: sky.toward.map(|[x, y]| [x, y, 0.0, 0.0]),
            sky: std::array::from_fn(place),
        }
    }
}

/// Cells of a surface that an atlas holds, as the shader takes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct WindowUniform {
    low: [i32; 2],
    last: [i32; 2],
}

impl WindowUniform {
    /// The window of the cells of `held`.
    #[must_use]
    pub(crate) fn new(held: &CellRect) -> Self {
        let low = held.from.map(|at| at as i32);
        Self {
            low,
            last: [0, 1].map(|i| low[i] + held.size[i] as i32 - 1),
        }
    }
}

/// Rows of a matrix, each of them padded.
type Rows = [[f32; 4]; 3];

/// The gamut as the shader takes it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct GamutUniform {
    from_working: Rows,
    to_cones: Rows,
    from_cones: Rows,
    to_lab: Rows,
    from_lab: Rows,
}

impl GamutUniform {
    fn new(gamut: &Gamut) -> Self {
        let rows = |m: &[[f32; 3]; 3]| m.map(|[x, y, z]| [x, y, z, 0.0]);
        Self {
            from_working: rows(&gamut.from_working),
            to_cones: rows(&gamut.to_cones),
            from_cones: rows(&gamut.from_cones),
            to_lab: rows(&gamut.to_lab),
            from_lab: rows(&gamut.from_lab),
        }
    }
}

/// A rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellRect {
    /// Lowest column and row.
    pub from: [u32; 2],
    /// Cells across and up.
    pub size: [u32; 2],
}

impl CellRect {
    /// This rectangle and the cells around it that its slopes, shadows and occlusion change, within `held`: they reach
    /// `shade` cells to the lower and to the higher sides.
    #[must_use]
    pub fn with_border(&self, shade: [[u32; 2]; 2], held: &Self) -> Self {
        let [low, high] = shade.map(|side| side.map(|reach| reach.max(1)));
        let from = [0, 1].map(|i| self.from[i].saturating_sub(low[i]).max(held.from[i]));
        let size = [0, 1].map(|i| {
            let end = self.from[i] + self.size[i] + high[i];
            end.min(held.from[i] + held.size[i]).saturating_sub(from[i])
        });
        Self { from, size }
    }

    /// Its rectangles in toroidal textures of `size` texels: at most four, as long as it is no larger than they are.
    #[must_use]
    pub fn on_torus(&self, size: [u32; 2]) -> Vec<Self> {
        let parts = |i: usize| {
            let from = self.from[i] % size[i];
            let before = self.size[i].min(size[i] - from);
            [(from, before), (0, self.size[i] - before)]
        };
        let (columns, rows) = (parts(0), parts(1));
        let all = rows.iter().flat_map(|(y, up)| {
            columns.iter().map(move |(x, across)| Self {
                from: [*x, *y],
                size: [*across, *up],
            })
        });
        all.filter(|part| !part.size.contains(&0)).collect()
    }

    /// The smallest rectangle around this one and another.
    fn with(&self, other: &Self) -> Self {
        let from = [0, 1].map(|i| self.from[i].min(other.from[i]));
        let size = [0, 1].map(|i| {
            let ends = [self, other].map(|rect| rect.from[i] + rect.size[i]);
            ends[0].max(ends[1]) - from[i]
        });
        Self { from, size }
    }

    fn cells(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Fewer rectangles over the same cells: two are one where that has no more cells than both together,
/// for neighbours overlap in their borders.
#[must_use]
pub(crate) fn joined(areas: Vec<CellRect>) -> Vec<CellRect> {
    let mut joined: Vec<CellRect> = Vec::with_capacity(areas.len());
    for mut area in areas {
        while let Some(place) = joined.iter().position(|other| {
            let both = area.with(other);
            both.cells() <= area.cells() + other.cells()
        }) {
            area = area.with(&joined.swap_remove(place));
        }
        joined.push(area);
    }
    joined
}

#[derive(Debug)]
pub(crate) struct LightSurface {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    gamut: wgpu::Buffer,
}

impl LightSurface {
    /// The pass on a device, into a gamut.
    #[must_use]
    pub(crate) fn new(gpu: &Gpu, gamut: &Gamut) -> Self {
        let texel = texture_binding(Filterable::No);
        let layout = gpu.layout(
            "light_surface",
            &[UNIFORM, texel, texel, UNIFORM, UNIFORM, texel],
        );
        let shader = gpu.shader("light_surface", include_str!("shaders/light_surface.wgsl"));
        let pipeline = gpu.pipeline(&Pass {
            name: "light_surface",
            layout: &layout,
            shader: &shader,
            vertex: "cover",
            fragment: "light",
            constants: &[
                ("ambient", f64::from(AMBIENT)),
                ("surface", f64::from(SURFACE)),
                ("dimming", f64::from(DIMMING)),
                ("sharpest", f64::from(SHARPEST)),
                ("steps", STEPS as f64),
                ("smoothest", f64::from(ROUGHNESS[0])),
                ("roughest", f64::from(ROUGHNESS[1])),
                ("least", f64::from(LEAST_DENOMINATOR)),
                ("knee", f64::from(KNEE)),
                ("for_colour", f64::from(FOR_COLOUR)),
                ("halvings", f64::from(HALVINGS)),
                (
                    "soft",
                    f64::from(u8::from(gamut.mapping == GamutMapping::Soft)),
                ),
            ],
            target: LIT,
            blend: None,
        });
        let uniform = gpu.uniform::<GamutUniform>("gamut");
        let gamut = GamutUniform::new(gamut);
        gpu.queue
            .write_buffer(&uniform, 0, bytemuck::bytes_of(&gamut));
        Self {
            layout,
            pipeline,
            gamut: uniform,
        }
    }

    /// Binds a [`LampUniform`] and a [`WindowUniform`]; the colours and the heights of an atlas, and an environment.
    #[must_use]
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        [lamp, window]: [&wgpu::Buffer; 2],
        [colours, heights, environment]: [&wgpu::TextureView; 3],
    ) -> wgpu::BindGroup {
        let resources = [
            lamp.as_entire_binding(),
            wgpu::BindingResource::TextureView(colours),
            wgpu::BindingResource::TextureView(heights),
            self.gamut.as_entire_binding(),
            window.as_entire_binding(),
            wgpu::BindingResource::TextureView(environment),
        ];
        gpu.bind(&self.layout, &resources)
    }

    /// Lights the texels of `areas`; the others stay as they are.
    pub(crate) fn run(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        lit: &wgpu::TextureView,
        bound: &wgpu::BindGroup,
        areas: &[CellRect],
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("light_surface"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: lit,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bound, &[]);
        for area in areas.iter().filter(|area| !area.size.contains(&0)) {
            pass.set_scissor_rect(area.from[0], area.from[1], area.size[0], area.size[1]);
            pass.draw(0..3, 0..1);
        }
    }
}

#[cfg(test)]
mod tests;
