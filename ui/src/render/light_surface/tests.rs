use half::f16;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::light::{EnvironmentMap, Facet, HeightField, LampSetup, Spot, lit};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

use super::environment::EnvironmentTexture;
use super::*;
use crate::render::gpu::testing::{gpu, read};

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
        self.faulty(lamp, gamut, |facet| facet)
    }

    /// As the export would light it if it saw the relief otherwise.
    fn faulty(&self, lamp: &Lamp, gamut: &Gamut, fault: impl Fn(Facet) -> Facet) -> Vec<[f32; 3]> {
        let field = HeightField {
            heights: &self.heights,
            cells: [SIDE, SIDE],
            cell_m: CELL_M,
        };
        let surroundings = Surroundings::new(lamp, CELL_M);
        let pixel = |(i, [r, g, b, gloss]): (usize, &[f32; 4])| {
            let mut facet = [Facet::LEVEL];
            surroundings.row(&field, [i % SIDE, i / SIDE], &mut facet);
            let spot = Spot {
                unlit: [*r, *g, *b],
                gloss: *gloss,
                facet: fault(facet[0]),
            };
            gamut.map(lit(&spot, lamp))
        };
        self.texels.iter().enumerate().map(pixel).collect()
    }

    /// As the shader lights it where the lower left cell is `from`.
    fn on_device(&self, lamp: &Lamp, gamut: &Gamut, from: [u32; 2]) -> Vec<[f32; 3]> {
        let gpu = gpu();
        let pass = LightSurface::new(&gpu, gamut);
        let texture = |format, usage| gpu.texture("lit", [SIDE as u32; 2], format, usage);
        let input = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let output = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (colours, heights) = (texture(COLOUR, input), texture(HEIGHT, input));
        let (cells, rise) = (on_torus(&self.texels, from), on_torus(&self.heights, from));
        let halves = cells.iter().flatten().map(|v| f16::from_f32(*v));
        let halves: Vec<u8> = halves.flat_map(f16::to_le_bytes).collect();
        let floats: Vec<u8> = rise.iter().flat_map(|h| h.to_le_bytes()).collect();
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
        let around = lamp.environment.as_ref();
        let lamp = LampUniform::new(lamp, &Surroundings::new(lamp, CELL_M), CELL_M);
        gpu.queue
            .write_buffer(&uniform, 0, bytemuck::bytes_of(&lamp));
        let window = gpu.uniform::<WindowUniform>("window");
        let held = CellRect {
            from,
            size: [SIDE as u32; 2],
        };
        let within = WindowUniform::new(&held);
        gpu.queue
            .write_buffer(&window, 0, bytemuck::bytes_of(&within));
        let mut environment = EnvironmentTexture::new(&gpu);
        environment.take(&gpu, around);
        let textures = [view(&colours), view(&heights), environment.view()];
        let bound = pass.bind(&gpu, [&uniform, &window], textures.each_ref());
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
        let lit: Vec<_> = halves.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect();
        on_torus(&lit, from.map(|at| SIDE as u32 - at % SIDE as u32))
    }
}

/// Cells from `from` on, each in its place on a torus.
fn on_torus<T: Copy>(cells: &[T], from: [u32; 2]) -> Vec<T> {
    let [x, y] = from.map(|at| at as usize % SIDE);
    let place = |at: usize, off: usize| (at + SIDE - off) % SIDE;
    (0..SIDE * SIDE)
        .map(|i| cells[place(i / SIDE, y) * SIDE + place(i % SIDE, x)])
        .collect()
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
        environment: None,
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
        let expected = rough.expected(&own, gamut);
        let shown = rough.on_device(&own, gamut, [0; 2]);
        // A window that continues at the other side of its textures has the same picture.
        let moved = rough.on_device(&own, gamut, [3 * SIDE as u32 + 20, 61]);
        assert_eq!(farthest(&shown, &moved), 0.0);
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
        let mut faults = vec![
            rough.expected(&lamp(moved, exposure, softness), gamut),
            rough.expected(&softer(0.2), gamut),
            rough.expected(&own, &mapped),
            rough.faulty(&own, gamut, |facet| Facet { open: 1.0, ..facet }),
        ];
        // Straight above, nothing mirrors the lamp more than a level surface.
        if own.mirror != [0.0; 2] {
            faults.push(rough.faulty(&own, gamut, |facet| Facet {
                spread: [0.0; 3],
                ..facet
            }));
        }
        let faults: Vec<f32> = faults.iter().map(|fault| farthest(&shown, fault)).collect();
        assert!(
            faults.iter().all(|fault| *fault > TOLERANCE),
            "a fault would pass: {faults:?}"
        );
    }
}

#[test]
fn the_shader_mirrors_an_environment_as_the_export_does() {
    let rough = Rough::new(8);
    let gamut = Gamut::new(GamutMapping::Clamp, &RgbSpace::Srgb.from_working());
    let striped = EnvironmentMap::of(|[x, y, z]| {
        let stripe = |v: f64, n: f64| (v * n).rem_euclid(1.0);
        [stripe(x, 3.0), stripe(y, 2.0), z]
    });
    let striped = std::sync::Arc::new(striped.expect("light"));
    for map in [EnvironmentMap::room(), striped] {
        let within = |environment| Lamp {
            environment,
            intensity: 0.7,
            ..lamp([-0.5, 0.5, 0.7], 1.0, 0.1)
        };
        let own = within(Some(std::sync::Arc::clone(&map)));
        let shown = rough.on_device(&own, &gamut, [37, 5]);
        let off = farthest(&shown, &rough.expected(&own, &gamut));
        println!("greatest difference {off:.1e}");
        assert!(off < TOLERANCE, "{off}");
        let mirror = map
            .to_bytes()
            .as_chunks::<4>()
            .0
            .iter()
            .rev()
            .flatten()
            .copied()
            .collect::<Vec<_>>();
        let mirror = EnvironmentMap::from_bytes(&mirror).map(std::sync::Arc::new);
        let sharp = |facet: Facet| Facet {
            spread: [0.0; 3],
            ..facet
        };
        let faults = [
            rough.expected(&within(None), &gamut),
            rough.expected(&within(Some(EnvironmentMap::window())), &gamut),
            rough.expected(&within(mirror), &gamut),
            rough.faulty(&own, &gamut, sharp),
        ];
        let faults = faults.map(|fault| farthest(&shown, &fault));
        assert!(faults.iter().all(|fault| *fault > TOLERANCE), "{faults:?}");
    }
}

#[test]
fn a_changed_tile_is_lit_with_the_cells_around_it() {
    let cells = [150, 70];
    let tile = |x: u32, y: u32, shade| {
        let size = [64.min(cells[0] - 64 * x), 64.min(cells[1] - 64 * y)];
        let from = [64 * x, 64 * y];
        let rect = |from, size| CellRect { from, size };
        rect(from, size).with_border(shade, &rect([0; 2], cells))
    };
    let rect = |from, size| CellRect { from, size };
    let none = [[0; 2]; 2];
    assert_eq!(tile(0, 0, none), rect([0, 0], [65, 65]));
    assert_eq!(tile(1, 0, none), rect([63, 0], [66, 65]));
    assert_eq!(tile(2, 1, none), rect([127, 63], [23, 7]));
    let held = rect([128, 64], [64, 128]);
    let in_held = rect([128, 64], [64, 64]).with_border(none, &held);
    assert_eq!(in_held, rect([128, 64], [64, 65]));
    // The lamp to the upper left: shadows fall to the right and below.
    let lamp = lamp([-1.0, 0.5, 0.5], 1.0, 0.1);
    let reach = |cell_m| Surroundings::new(&lamp, cell_m).reach();
    assert_eq!(reach(CELL_M), [[8, 8], [16, 8]]);
    assert_eq!(reach(0.5 * CELL_M), [[16, 16], [24, 16]]);
}

#[test]
fn an_area_on_a_torus_is_at_most_four_rectangles() {
    let rect = |from, size| CellRect { from, size };
    let area = rect([70, 10], [20, 30]);
    assert_eq!(area.on_torus([128, 64]), [area]);
    assert_eq!(
        rect([120, 50], [20, 30]).on_torus([128, 64]),
        [
            rect([120, 50], [8, 14]),
            rect([0, 50], [12, 14]),
            rect([120, 0], [8, 16]),
            rect([0, 0], [12, 16])
        ]
    );
    assert_eq!(
        rect([192, 64], [128, 64]).on_torus([128, 64]),
        [rect([64, 0], [64, 64]), rect([0, 0], [64, 64])]
    );
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
