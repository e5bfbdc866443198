//! Part of a surface at one level of detail, on the graphics device.
//!
//! The textures are a torus: tile (x, y) lies at (x, y) modulo their size, so the part may move without a copy.
//! Row 0 is the lowest.

use eframe::egui_wgpu::wgpu;
use maulstick_client::frames::tile_planner::AtlasState;
use maulstick_client::frames::tiles::TileRect;
use maulstick_client::frames::{Shown, ShownTile};
use maulstick_optics::light::shadow::REACH;
use maulstick_optics::light::{Lamp, Surroundings};
use maulstick_types::paint::TILE;

use crate::render::gpu::Gpu;
use crate::render::light_surface::environment::EnvironmentTexture;
use crate::render::light_surface::{
    COLOUR, CellRect, HEIGHT, LIT, LampUniform, LightSurface, WindowUniform, joined,
};
use crate::render::show_surface::Region;
use crate::view::visible_tiles::cells_of;

/// Number of changed areas from which the whole atlas is lit at once.
const MANY: usize = 64;
/// Cells at an edge beyond which there are no heights yet: their slopes and shadows are not whole.
const RIM: u32 = REACH + 1;
/// Bytes of a texel: of unlit colour and height, and of lit colour.
const UNLIT_BYTES: u64 = 8 + 4;
const LIT_BYTES: u64 = 8;

/// Input of the lighting pass.
#[derive(Debug)]
struct Unlit {
    colour: wgpu::Texture,
    height: wgpu::Texture,
    lamp: wgpu::Buffer,
    window: wgpu::Buffer,
    environment: EnvironmentTexture,
    under: Option<LampUniform>,
    within: Option<WindowUniform>,
    bound: wgpu::BindGroup,
}

#[derive(Debug)]
pub(crate) struct TileAtlas {
    state: AtlasState,
    /// Cells of the whole surface at its level.
    cells: [u32; 2],
    /// Texels.
    size: [u32; 2],
    unlit: Option<Unlit>,
    /// Lit colours.
    pub lit: wgpu::TextureView,
    /// Areas that are not lit yet, and those that are lit but not shown yet, in cells.
    stale: Vec<CellRect>,
    fresh: Vec<CellRect>,
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

impl TileAtlas {
    /// An empty atlas as a reply describes it; `None` if the device cannot have one so large.
    #[must_use]
    pub(crate) fn of(gpu: &Gpu, pass: &LightSurface, shown: &Shown) -> Option<Self> {
        let most = gpu.device.limits().max_texture_dimension_2d;
        let size = shown
            .atlas
            .room
            .map(|tiles| tiles.saturating_mul(TILE as u32));
        if size.iter().any(|side| !(1..=most).contains(side)) || shown.cells.contains(&0) {
            return None;
        }
        let texture = |name: &str, format: wgpu::TextureFormat, usage: wgpu::TextureUsages| {
            let usage = usage | wgpu::TextureUsages::TEXTURE_BINDING;
            gpu.texture(name, size, format, usage)
        };
        let colour = texture("colour", COLOUR, wgpu::TextureUsages::COPY_DST);
        let height = texture("height", HEIGHT, wgpu::TextureUsages::COPY_DST);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let lit = view(&texture("lit", LIT, usage));
        let lamp = gpu.uniform::<LampUniform>("lamp");
        let window = gpu.uniform::<WindowUniform>("window");
        let environment = EnvironmentTexture::new(gpu);
        let textures = [view(&colour), view(&height), environment.view()];
        let bound = pass.bind(gpu, [&lamp, &window], textures.each_ref());
        Some(Self {
            state: AtlasState {
                held: TileRect::NONE,
                ..shown.atlas
            },
            cells: shown.cells,
            size,
            unlit: Some(Unlit {
                colour,
                height,
                lamp,
                window,
                environment,
                under: None,
                within: None,
                bound,
            }),
            lit,
            stale: Vec::new(),
            fresh: Vec::new(),
        })
    }

    /// Its number, level, room, and the tiles that are whole.
    #[must_use]
    pub(crate) fn state(&self) -> &AtlasState {
        &self.state
    }

    /// True if a reply is about this atlas.
    #[must_use]
    pub(crate) fn is_of(&self, shown: &Shown) -> bool {
        (self.state.number, self.cells) == (shown.atlas.number, shown.cells)
    }

    /// Bytes of its textures.
    #[must_use]
    pub(crate) fn bytes(&self) -> u64 {
        let texel = LIT_BYTES + self.unlit.as_ref().map_or(0, |_| UNLIT_BYTES);
        u64::from(self.size[0]) * u64::from(self.size[1]) * texel
    }

    /// Keeps the lit picture and frees the rest: another atlas will replace it.
    pub(crate) fn freeze(&mut self) {
        self.unlit = None;
        self.stale.clear();
    }

    /// Takes in tiles, and which of all are whole from now on.
    pub(crate) fn take(&mut self, gpu: &Gpu, shown: &Shown) {
        let before = self.state.held;
        self.state.held = shown.atlas.held;
        for tile in &shown.tiles {
            self.put(gpu, tile);
        }
        for part in self.state.held.without(&before) {
            self.stale.push(cells_of(&part, self.cells));
        }
    }

    fn put(&mut self, gpu: &Gpu, tile: &ShownTile) {
        let Some(unlit) = &self.unlit else {
            return;
        };
        let place = TileRect {
            from: [tile.x, tile.y],
            to: [tile.x.saturating_add(1), tile.y.saturating_add(1)],
        };
        let area = cells_of(&place, self.cells);
        if area.size.contains(&0) {
            return;
        }
        let side = TILE as u32;
        for (texture, texels) in [(&unlit.colour, &tile.colour), (&unlit.height, &tile.height)] {
            let texel = texels.len() / (TILE * TILE);
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture,
                    mip_level: 0,
                    origin: wgpu::Origin3d {
                        x: (tile.x % self.state.room[0]) * side,
                        y: (tile.y % self.state.room[1]) * side,
                        z: 0,
                    },
                    aspect: wgpu::TextureAspect::All,
                },
                texels,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some((TILE * texel) as u32),
                    rows_per_image: None,
                },
                wgpu::Extent3d {
                    width: side,
                    height: side,
                    depth_or_array_layers: 1,
                },
            );
        }
        if self.state.held.holds(&place) {
            self.stale.push(area);
        }
    }

    /// Lights what is stale; everything where the lamp is another. `cell_m` is the side of a cell of
    /// the surface.
    pub(crate) fn light(&mut self, gpu: &Gpu, pass: &LightSurface, lamp: &Lamp, cell_m: f64) {
        let held = cells_of(&self.state.held, self.cells);
        let Some(unlit) = self.unlit.as_mut().filter(|_| !held.size.contains(&0)) else {
            return;
        };
        let texel_m = cell_m * f64::from(1u32 << self.state.level.min(16));
        let surroundings = Surroundings::new(lamp, texel_m as f32);
        let changed = unlit.environment.take(gpu, lamp.environment.as_ref());
        let lamp = LampUniform::new(lamp, &surroundings, texel_m as f32);
        let window = WindowUniform::new(&held);
        if unlit.within != Some(window) {
            gpu.queue
                .write_buffer(&unlit.window, 0, bytemuck::bytes_of(&window));
            unlit.within = Some(window);
        }
        let moved = unlit.under != Some(lamp);
        if moved {
            gpu.queue
                .write_buffer(&unlit.lamp, 0, bytemuck::bytes_of(&lamp));
            unlit.under = Some(lamp);
        }
        if moved || changed || self.stale.len() > MANY {
            self.stale = vec![held];
        }
        if self.stale.is_empty() {
            return;
        }
        let reach = surroundings.reach();
        let areas = self
            .stale
            .drain(..)
            .map(|area| area.with_border(reach, &held));
        let areas = joined(areas.filter(|area| !area.size.contains(&0)).collect());
        let texels: Vec<CellRect> = areas
            .iter()
            .flat_map(|area| area.on_torus(self.size))
            .collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        pass.run(&mut encoder, &self.lit, &unlit.bound, &texels);
        gpu.queue.submit([encoder.finish()]);
        self.fresh.extend(areas);
    }

    /// Cells lit since the last call.
    pub(crate) fn fresh(&mut self) -> Vec<CellRect> {
        std::mem::take(&mut self.fresh)
    }

    /// The cells that may be shown, for a surface of `surface_cells`.
    #[must_use]
    pub(crate) fn region(&self, surface_cells: [u32; 2]) -> Region {
        let held = cells_of(&self.state.held, self.cells);
        let coarse = 1.0 / (1u64 << self.state.level.min(31)) as f32;
        let (mut low, mut high) = ([0.0; 2], [0.0; 2]);
        for i in 0..2 {
            let to = held.from[i] + held.size[i];
            // The surface's own edge is an edge to light, too.
            let rim = |at_edge: bool| if at_edge { 0.0 } else { RIM as f32 };
            low[i] = held.from[i] as f32 + rim(held.from[i] == 0);
            high[i] = to as f32 - rim(to == self.cells[i]);
        }
        Region {
            extent: surface_cells.map(|cells| cells as f32 * coarse),
            texels: self.cells.map(|cells| cells as f32),
            size: self.size.map(|side| side as f32),
            low,
            high,
            pad: [0.0; 2],
        }
    }
}
