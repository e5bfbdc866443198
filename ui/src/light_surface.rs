//! Lights a surface: unlit colour, gloss and height into linear colour, in cells of its own.

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::wgpu;
use maulstick_optics::light::{AMBIENT, Lamp, SHARPNESS};

use crate::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};

/// Unlit linear colour and gloss.
pub const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Height, m.
pub const HEIGHT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Lit linear colour within the gamut.
pub const LIT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The lamp as the shader takes it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LampUniform {
    toward: [f32; 3],
    intensity: f32,
    half: [f32; 3],
    peak: f32,
    flat: f32,
    cell_m: f32,
    _pad: [f32; 2],
}

impl LampUniform {
    /// A lamp over cells of side `cell_m`.
    #[must_use]
    pub fn new(lamp: &Lamp, cell_m: f32) -> Self {
        Self {
            toward: lamp.toward,
            intensity: lamp.intensity,
            half: lamp.half,
            peak: lamp.peak,
            flat: lamp.flat,
            cell_m,
            _pad: [0.0; 2],
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
    /// This rectangle and the cells around it, whose slopes it changes, within a surface of `cells`.
    #[must_use]
    pub fn with_border(&self, cells: [u32; 2]) -> Self {
        let from = self.from.map(|at| at.saturating_sub(1));
        let size = [0, 1].map(|i| {
            let end = (self.from[i] + self.size[i] + 1).min(cells[i]);
            end.saturating_sub(from[i])
        });
        Self { from, size }
    }
}

/// The pass.
#[derive(Debug)]
pub struct LightSurface {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl LightSurface {
    /// The pass on a device.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        let texel = texture_binding(Filterable::No);
        let layout = gpu.layout("light_surface", &[UNIFORM, texel, texel]);
        let shader = gpu.shader("light_surface", include_str!("shaders/light_surface.wgsl"));
        let pipeline = gpu.pipeline(&Pass {
            name: "light_surface",
            layout: &layout,
            shader: &shader,
            vertex: "cover",
            fragment: "light",
            constants: &[
                ("ambient", f64::from(AMBIENT)),
                ("sharpness", f64::from(SHARPNESS)),
            ],
            target: LIT,
            blend: None,
        });
        Self { layout, pipeline }
    }

    /// Binds a [`LampUniform`], the colours and the heights of a surface.
    #[must_use]
    pub fn bind(
        &self,
        gpu: &Gpu,
        lamp: &wgpu::Buffer,
        colours: &wgpu::TextureView,
        heights: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let resources = [
            lamp.as_entire_binding(),
            wgpu::BindingResource::TextureView(colours),
            wgpu::BindingResource::TextureView(heights),
        ];
        gpu.bind(&self.layout, &resources)
    }

    /// Lights the cells of `areas`; the others stay as they are.
    pub fn run(
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
mod tests {
    use half::f16;
    use maulstick_optics::colour::clamp_chromaticity;
    use maulstick_optics::light::{HeightField, lit};
    use rand_pcg::Pcg32;
    use rand_pcg::rand_core::Rng as _;

    use super::*;
    use crate::gpu::testing::{gpu, read};

    const SIDE: usize = 64;
    const CELL_M: f32 = 2.5e-4;
    /// Half the step of a half float near 2, and what reordered sums may differ by.
    const TOLERANCE: f32 = 2e-3;

    /// A rough surface of random colours, some outside the gamut.
    struct Rough {
        texels: Vec<[f32; 4]>,
        heights: Vec<f32>,
    }

    impl Rough {
        fn new(seed: u64) -> Self {
            let mut random = Pcg32::new(seed, 1);
            let mut unit = || random.next_u32() as f32 / 4_294_967_296.0;
            let mut texel = || [1.2 * unit() - 0.1, unit(), 1.2 * unit() - 0.1, unit()];
            let half = |v: f32| f16::from_f32(v).to_f32();
            Self {
                texels: (0..SIDE * SIDE).map(|_| texel().map(half)).collect(),
                heights: (0..SIDE * SIDE).map(|_| 1.5e-4 * unit()).collect(),
            }
        }

        fn expected(&self, lamp: &Lamp) -> Vec<[f32; 3]> {
            let field = HeightField {
                heights: &self.heights,
                cells: [SIDE, SIDE],
                cell_m: CELL_M,
            };
            let pixel = |(i, [r, g, b, gloss]): (usize, &[f32; 4])| {
                let slope = field.slope(i % SIDE, i / SIDE);
                clamp_chromaticity(lit([*r, *g, *b], *gloss, slope, lamp))
            };
            self.texels.iter().enumerate().map(pixel).collect()
        }

        fn on_device(&self, lamp: &Lamp) -> Vec<[f32; 3]> {
            let gpu = gpu();
            let pass = LightSurface::new(&gpu);
            let texture = |format, usage| {
                gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d {
                        width: SIDE as u32,
                        height: SIDE as u32,
                        depth_or_array_layers: 1,
                    },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage,
                    view_formats: &[],
                })
            };
            let input = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
            let output = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
            let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
            let (colours, heights) = (texture(COLOUR, input), texture(HEIGHT, input));
            let halves = self.texels.iter().flatten().map(|v| f16::from_f32(*v));
            let halves: Vec<u8> = halves.flat_map(f16::to_le_bytes).collect();
            let floats: Vec<u8> = self.heights.iter().flat_map(|h| h.to_le_bytes()).collect();
            for (texture, bytes) in [(&colours, halves), (&heights, floats)] {
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some((bytes.len() / SIDE) as u32),
                    rows_per_image: None,
                };
                gpu.queue
                    .write_texture(texture.as_image_copy(), &bytes, layout, texture.size());
            }
            let uniform = gpu.uniform::<LampUniform>("lamp");
            let lamp = LampUniform::new(lamp, CELL_M);
            gpu.queue
                .write_buffer(&uniform, 0, bytemuck::bytes_of(&lamp));
            let bound = pass.bind(&gpu, &uniform, &view(&colours), &view(&heights));
            let target = texture(LIT, output);
            let whole = CellRect {
                from: [0; 2],
                size: [SIDE as u32; 2],
            };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            pass.run(&mut encoder, &view(&target), &bound, &[whole]);
            gpu.queue.submit([encoder.finish()]);
            let bytes = read(&gpu, &target);
            let halves = bytes
                .chunks_exact(2)
                .map(|b| f16::from_le_bytes([b[0], b[1]]));
            let halves: Vec<f32> = halves.map(f16::to_f32).collect();
            halves.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect()
        }
    }

    fn farthest(one: &[[f32; 3]], two: &[[f32; 3]]) -> f32 {
        assert_eq!(one.len(), two.len());
        let pairs = one.iter().flatten().zip(two.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn the_shader_lights_as_the_export_does() {
        let rough = Rough::new(7);
        for (toward, intensity) in [([-0.5, 0.5, 0.7], 1.0), ([0.9, -0.1, 0.2], 0.6)] {
            let lamp = Lamp::new(toward, intensity);
            let (shown, expected) = (rough.on_device(&lamp), rough.expected(&lamp));
            let off = farthest(&shown, &expected);
            println!("greatest difference {off:.1e}");
            assert!(off < TOLERANCE, "{off}");
            assert!(
                expected.iter().flatten().any(|v| *v > 1.0),
                "highlights are compared"
            );
            let elsewhere = Lamp::new([toward[0] + 0.02, toward[1], toward[2]], intensity);
            let fault = farthest(&shown, &rough.expected(&elsewhere));
            assert!(fault > TOLERANCE, "a fault would pass: {fault}");
        }
    }

    #[test]
    fn a_changed_tile_is_lit_with_the_cells_around_it() {
        let cells = [150, 70];
        let tile = |x: u32, y: u32| {
            let size = [64.min(cells[0] - 64 * x), 64.min(cells[1] - 64 * y)];
            let from = [64 * x, 64 * y];
            CellRect { from, size }.with_border(cells)
        };
        let rect = |from, size| CellRect { from, size };
        assert_eq!(tile(0, 0), rect([0, 0], [65, 65]));
        assert_eq!(tile(1, 0), rect([63, 0], [66, 65]));
        assert_eq!(tile(2, 1), rect([127, 63], [23, 7]));
    }
}
