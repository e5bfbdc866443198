//! Lights a surface: unlit colour, gloss and height into linear light of the display's gamut, in cells
//! of its own.

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::wgpu;
use maulstick_optics::gamut::{FOR_COLOUR, Gamut, GamutMapping, HALVINGS, KNEE};
use maulstick_optics::light::shadow::{LEAST, Shadows, TAPS};
use maulstick_optics::light::{AMBIENT, Lamp, SHARPNESS, SURFACE};

use crate::gpu::{Filterable, Gpu, Pass, UNIFORM, texture_binding};

/// Unlit linear colour and gloss.
pub const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Height, m.
pub const HEIGHT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Lit linear colour within the gamut.
pub const LIT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The lamp and its shadows as the shader takes them.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LampUniform {
    toward: [f32; 3],
    intensity: f32,
    half: [f32; 3],
    relief: f32,
    peak: [f32; 2],
    flat: [f32; 2],
    cell_m: f32,
    /// Of the shadows: cells that a metre is high, and 1/w; c and l_z.
    rise: f32,
    sharpness: f32,
    _pad: f32,
    along: [f32; 2],
    _pad2: [f32; 2],
    colour: [f32; 3],
    _pad3: f32,
    cells: [[i32; 4]; TAPS],
    /// Weight, s·c, s·l_z.
    runs: [[f32; 4]; TAPS],
}

impl LampUniform {
    /// A lamp and its shadows over cells of side `cell_m`.
    #[must_use]
    pub fn new(lamp: &Lamp, shadows: &Shadows, cell_m: f32) -> Self {
        Self {
            toward: lamp.toward,
            intensity: lamp.intensity,
            half: lamp.half,
            relief: lamp.relief,
            peak: lamp.peak,
            flat: lamp.flat,
            cell_m,
            rise: shadows.rise,
            sharpness: shadows.sharpness,
            _pad: 0.0,
            along: shadows.toward,
            _pad2: [0.0; 2],
            colour: lamp.colour,
            _pad3: 0.0,
            cells: shadows.taps.map(|tap| {
                let [[x, y], [x2, y2]] = tap.cells;
                [x, y, x2, y2]
            }),
            runs: shadows
                .taps
                .map(|tap| [tap.weight, tap.run[0], tap.run[1], 0.0]),
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
    /// This rectangle and the cells around it that its slopes and shadows change, within a surface of
    /// `cells`: shadows reach `shade` cells to the lower and to the higher sides.
    #[must_use]
    pub fn with_border(&self, shade: [[u32; 2]; 2], cells: [u32; 2]) -> Self {
        let [low, high] = shade.map(|side| side.map(|reach| reach.max(1)));
        let from = [0, 1].map(|i| self.from[i].saturating_sub(low[i]));
        let size = [0, 1].map(|i| {
            let end = (self.from[i] + self.size[i] + high[i]).min(cells[i]);
            end.saturating_sub(from[i])
        });
        Self { from, size }
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
pub fn joined(areas: Vec<CellRect>) -> Vec<CellRect> {
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

/// The pass.
#[derive(Debug)]
pub struct LightSurface {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    gamut: wgpu::Buffer,
}

impl LightSurface {
    /// The pass on a device, into a gamut.
    #[must_use]
    pub fn new(gpu: &Gpu, gamut: &Gamut) -> Self {
        let texel = texture_binding(Filterable::No);
        let layout = gpu.layout("light_surface", &[UNIFORM, texel, texel, UNIFORM]);
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
                ("sharp", f64::from(SHARPNESS[0])),
                ("broad", f64::from(SHARPNESS[1])),
                ("least", f64::from(LEAST)),
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
            self.gamut.as_entire_binding(),
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
    use maulstick_optics::colour::RgbSpace;
    use maulstick_optics::light::{HeightField, LampSetup, Spot, lit};
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
                heights: (0..SIDE * SIDE).map(|_| 4e-4 * unit()).collect(),
            }
        }

        fn expected(&self, lamp: &Lamp, gamut: &Gamut) -> Vec<[f32; 3]> {
            let field = HeightField {
                heights: &self.heights,
                cells: [SIDE, SIDE],
                cell_m: CELL_M,
            };
            let shadows = Shadows::new(lamp, CELL_M);
            let pixel = |(i, [r, g, b, gloss]): (usize, &[f32; 4])| {
                let mut seen = [1.0];
                shadows.row(&field, [i % SIDE, i / SIDE], &mut seen);
                let spot = Spot {
                    unlit: [*r, *g, *b],
                    gloss: *gloss,
                    slope: field.slope(i % SIDE, i / SIDE),
                    seen: seen[0],
                };
                gamut.map(lit(&spot, lamp))
            };
            self.texels.iter().enumerate().map(pixel).collect()
        }

        fn on_device(&self, lamp: &Lamp, gamut: &Gamut) -> Vec<[f32; 3]> {
            let gpu = gpu();
            let pass = LightSurface::new(&gpu, gamut);
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
            let lamp = LampUniform::new(lamp, &Shadows::new(lamp, CELL_M), CELL_M);
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

    fn lamp(toward: [f64; 3], exposure: f64, softness: f64) -> Lamp {
        Lamp::new(&LampSetup {
            toward,
            intensity: 1.0,
            exposure,
            relief: 1.3,
            softness,
            colour: [1.3, 0.9, 0.4],
        })
    }

    #[test]
    fn the_shader_lights_as_the_export_does() {
        let rough = Rough::new(7);
        let soft = |space: RgbSpace| Gamut::new(GamutMapping::Soft, &space.from_working());
        let [srgb, wide] = [RgbSpace::Srgb, RgbSpace::DisplayP3].map(soft);
        let clamp = Gamut {
            mapping: GamutMapping::Clamp,
            ..srgb
        };
        for (toward, exposure, softness, gamut) in [
            ([-0.5, 0.5, 0.7], 1.0, 0.1, &srgb),
            ([0.9, -0.1, 0.3], 0.6, 0.04, &wide),
            ([0.1, 0.3, 0.3], 1.4, 0.02, &clamp),
            ([0.0, 0.0, 1.0], 1.0, 0.6, &wide),
        ] {
            let own = lamp(toward, exposure, softness);
            let (shown, expected) = (rough.on_device(&own, gamut), rough.expected(&own, gamut));
            let off = farthest(&shown, &expected);
            println!("greatest difference {off:.1e}");
            assert!(off < TOLERANCE, "{off}");
            assert!(
                expected.iter().flatten().any(|v| *v > 0.999),
                "highlights are compared"
            );
            let moved = [toward[0] + 0.02, toward[1], toward[2]];
            let softer = |by: f64| lamp(toward, exposure, softness + by);
            let mapped = match gamut.mapping {
                GamutMapping::Soft => clamp,
                GamutMapping::Clamp => srgb,
            };
            let faults = [
                rough.expected(&lamp(moved, exposure, softness), gamut),
                rough.expected(&softer(0.2), gamut),
                rough.expected(&own, &mapped),
            ];
            let faults = faults.map(|fault| farthest(&shown, &fault));
            assert!(
                faults.iter().all(|fault| *fault > TOLERANCE),
                "a fault would pass: {faults:?}"
            );
        }
    }

    #[test]
    fn a_changed_tile_is_lit_with_the_cells_around_it() {
        let cells = [150, 70];
        let tile = |x: u32, y: u32, shade| {
            let size = [64.min(cells[0] - 64 * x), 64.min(cells[1] - 64 * y)];
            let from = [64 * x, 64 * y];
            CellRect { from, size }.with_border(shade, cells)
        };
        let rect = |from, size| CellRect { from, size };
        let none = [[0; 2]; 2];
        assert_eq!(tile(0, 0, none), rect([0, 0], [65, 65]));
        assert_eq!(tile(1, 0, none), rect([63, 0], [66, 65]));
        assert_eq!(tile(2, 1, none), rect([127, 63], [23, 7]));
        // The lamp to the upper left: shadows fall to the right and below.
        let shadows = Shadows::new(&lamp([-1.0, 0.5, 0.5], 1.0, 0.1), CELL_M);
        assert_eq!(shadows.reach(), [[0, 8], [16, 0]]);
    }

    #[test]
    fn areas_that_overlap_much_are_lit_as_one() {
        let rect = |from, size| CellRect { from, size };
        let row = (0..3).map(|x| rect([64 * x, 0], [80, 66])).collect();
        assert_eq!(joined(row), [rect([0, 0], [208, 66])]);
        let apart = vec![rect([0, 0], [80, 66]), rect([64, 64], [80, 66])];
        assert_eq!(joined(apart.clone()), apart);
        let square = [[0, 0], [64, 64], [64, 0], [0, 64]].map(|from| rect(from, [80, 80]));
        assert_eq!(joined(square.to_vec()), [rect([0, 0], [144, 144])]);
    }
}
