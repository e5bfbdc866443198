//! A surface on the graphics device: tiles go up as they come, are lit, and are shown.

use eframe::egui_wgpu::wgpu;
use maulstick_optics::gamut::Gamut;
use maulstick_optics::light::Lamp;
use maulstick_optics::light::shadow::Shadows;
use maulstick_paint::picture::Export;
use maulstick_types::paint::TILE;
use maulstick_types::scene::Surface;

use crate::frames::{Shown, ShownTile};
use crate::gpu::Gpu;
use crate::light_surface::{COLOUR, CellRect, HEIGHT, LIT, LampUniform, LightSurface, joined};
use crate::show_surface::{Detail, PixelRect, Place, ShowSurface};
use crate::view::View;

/// From this many changed areas on, the whole surface is lit in one go.
const MANY: usize = 64;

/// The passes that a surface goes through.
#[derive(Debug)]
pub struct Passes {
    light: LightSurface,
    /// Shows them on the desk.
    pub show: ShowSurface,
}

impl Passes {
    /// The passes on a device, for the display of `export`.
    #[must_use]
    pub fn new(gpu: &Gpu, export: &Export) -> Self {
        let gamut = Gamut::new(export.gamut, export.profile.from_working());
        Self {
            light: LightSurface::new(gpu, &gamut),
            show: ShowSurface::new(gpu, &export.profile),
        }
    }
}

/// The textures of a surface at one level of detail. Row 0 is the lowest.
#[derive(Debug)]
struct Sheet {
    detail: Detail,
    epoch: u32,
    colour: wgpu::Texture,
    height: wgpu::Texture,
    lit: wgpu::TextureView,
    lamp: wgpu::Buffer,
    under: Option<LampUniform>,
    lighting: wgpu::BindGroup,
    place: wgpu::Buffer,
    placed: Option<Place>,
    showing: wgpu::BindGroup,
    /// Areas that are not lit yet, and those that are lit but not shown yet.
    stale: Vec<CellRect>,
    fresh: Vec<CellRect>,
}

impl Sheet {
    fn new(gpu: &Gpu, passes: &Passes, detail: Detail, epoch: u32) -> Self {
        let texture = |name: &str, format: wgpu::TextureFormat, usage: wgpu::TextureUsages| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(name),
                size: wgpu::Extent3d {
                    width: detail.cells[0],
                    height: detail.cells[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let colour = texture("colour", COLOUR, wgpu::TextureUsages::COPY_DST);
        let height = texture("height", HEIGHT, wgpu::TextureUsages::COPY_DST);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let lit = view(&texture("lit", LIT, usage));
        let lamp = gpu.uniform::<LampUniform>("lamp");
        let place = gpu.uniform::<Place>("place");
        Self {
            lighting: passes
                .light
                .bind(gpu, &lamp, &view(&colour), &view(&height)),
            showing: passes.show.bind(gpu, &place, &lit),
            detail,
            epoch,
            colour,
            height,
            lit,
            lamp,
            under: None,
            place,
            placed: None,
            stale: Vec::new(),
            fresh: Vec::new(),
        }
    }

    fn put(&mut self, gpu: &Gpu, tile: &ShownTile) {
        let cells = self.detail.cells;
        let corner = [tile.x, tile.y].map(|at| at.saturating_mul(TILE as u32));
        if corner[0] >= cells[0] || corner[1] >= cells[1] {
            return;
        }
        let size = [0, 1].map(|i| (cells[i] - corner[i]).min(TILE as u32));
        let area = CellRect { from: corner, size };
        for (texture, texels) in [(&self.colour, &tile.colour), (&self.height, &tile.height)] {
            let texel = texels.len() / (TILE * TILE);
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture,
                    mip_level: 0,
                    origin: wgpu::Origin3d {
                        x: corner[0],
                        y: corner[1],
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
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
            );
        }
        self.stale.push(area);
    }

    /// Lights what is stale; everything where the lamp is another.
    fn light(&mut self, gpu: &Gpu, passes: &Passes, lamp: &Lamp, cell_m: f64) {
        let texel_m = cell_m * f64::from(1u32 << self.detail.level);
        let shadows = Shadows::new(lamp, texel_m as f32);
        let lamp = LampUniform::new(lamp, &shadows, texel_m as f32);
        let moved = self.under != Some(lamp);
        if moved {
            gpu.queue
                .write_buffer(&self.lamp, 0, bytemuck::bytes_of(&lamp));
            self.under = Some(lamp);
        }
        if moved || self.stale.len() > MANY {
            self.stale = vec![CellRect {
                from: [0; 2],
                size: self.detail.cells,
            }];
        }
        if self.stale.is_empty() {
            return;
        }
        let reach = shadows.reach();
        for area in &mut self.stale {
            *area = area.with_border(reach, self.detail.cells);
        }
        self.stale = joined(std::mem::take(&mut self.stale));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        passes
            .light
            .run(&mut encoder, &self.lit, &self.lighting, &self.stale);
        gpu.queue.submit([encoder.finish()]);
        self.fresh.append(&mut self.stale);
    }

    /// Lays it at a place in the view: the pixels that are other than before.
    fn lay(&mut self, gpu: &Gpu, place: Place) -> PixelRect {
        let fresh = std::mem::take(&mut self.fresh);
        if self.placed != Some(place) {
            gpu.queue
                .write_buffer(&self.place, 0, bytemuck::bytes_of(&place));
            self.placed = Some(place);
            return PixelRect::EVERYTHING;
        }
        fresh.iter().fold(PixelRect::NOTHING, |all, area| {
            all.with(&place.covered(area, self.detail))
        })
    }
}

/// A surface as it is shown, and the one that will take its place once it has come whole.
#[derive(Debug, Default)]
pub struct SurfaceView {
    shown: Option<Sheet>,
    coming: Option<Sheet>,
}

impl SurfaceView {
    /// Takes in tiles. Those of another size, level or start of the paint node begin a new picture,
    /// which is shown when it is whole.
    pub fn update(&mut self, gpu: &Gpu, passes: &Passes, shown: &Shown) {
        let most = gpu.device.limits().max_texture_dimension_2d;
        if shown.cells.iter().any(|cells| !(1..=most).contains(cells)) || shown.level > 16 {
            return;
        }
        let detail = Detail {
            cells: shown.cells,
            level: shown.level,
        };
        let fits = |sheet: &Sheet| (sheet.detail, sheet.epoch) == (detail, shown.epoch);
        if self.coming.as_ref().is_none_or(|sheet| !fits(sheet)) {
            self.coming = None;
            if self.shown.as_ref().is_none_or(|sheet| !fits(sheet)) {
                self.coming = Some(Sheet::new(gpu, passes, detail, shown.epoch));
            }
        }
        if let Some(sheet) = self.coming.as_mut().or(self.shown.as_mut()) {
            shown.tiles.iter().for_each(|tile| sheet.put(gpu, tile));
        }
        if self.coming.is_some() && !shown.more {
            self.shown = self.coming.take();
        }
    }

    /// Lights what has changed, under a lamp in the surface's frame.
    pub fn light(&mut self, gpu: &Gpu, passes: &Passes, lamp: &Lamp, cell_m: f64) {
        if let Some(sheet) = &mut self.shown {
            sheet.light(gpu, passes, lamp, cell_m);
        }
    }

    /// Lays the surface into the view; none until there is a picture.
    #[must_use]
    pub fn lay(
        &mut self,
        gpu: &Gpu,
        surface: &Surface,
        view: &View,
        pixels_per_point: f32,
    ) -> Option<Laid> {
        let sheet = self.shown.as_mut()?;
        let place = Place::of(surface, view, pixels_per_point, sheet.detail);
        Some(Laid {
            changed: sheet.lay(gpu, place),
            bound: sheet.showing.clone(),
        })
    }
}

/// A surface in its place, ready to be shown.
#[derive(Debug)]
pub struct Laid {
    /// For [`ShowSurface::draw`].
    pub bound: wgpu::BindGroup,
    /// Where it is other than when it was laid before.
    pub changed: PixelRect,
}

#[cfg(test)]
pub(crate) mod tests {
    use eframe::egui::{Rect, pos2, vec2};
    use maulstick_optics::colour::RgbSpace;
    use maulstick_optics::gamut::GamutMapping;
    use maulstick_optics::icc::Profile;
    use maulstick_optics::light::{HeightField, LampSetup, Spot, lit};
    use maulstick_paint::PaintingSetup;
    use maulstick_paint::display::DisplayTile;
    use maulstick_paint::tile::TILE_CELLS;

    use super::*;
    use crate::frames::texels;
    use crate::gpu::testing::{draw, gpu, read, target};

    pub(crate) const CELLS: [u32; 2] = [150, 100];

    fn height(x: usize, y: usize) -> f32 {
        // A ridge that crosses the borders of tiles.
        1e-4 * (1.0 - ((x as f32 - y as f32 - 20.0) / 6.0).abs()).max(0.0)
    }

    fn colour(x: usize, y: usize) -> [f32; 3] {
        [0.7 * x as f32 / 150.0, 0.6 * y as f32 / 100.0, 0.3]
    }

    pub(crate) fn tile(x: u32, y: u32) -> ShownTile {
        let place = |i: usize| (x as usize * TILE + i % TILE, y as usize * TILE + i / TILE);
        let plane = |f: &dyn Fn(usize, usize) -> f32| {
            let value = |i: usize| f(place(i).0, place(i).1);
            (0..TILE_CELLS).map(value).collect::<Vec<f32>>()
        };
        let tile = DisplayTile {
            rgb: [0, 1, 2].map(|c| plane(&|x, y| colour(x, y)[c])),
            gloss: vec![1.0; TILE_CELLS],
            wetness: vec![1.0; TILE_CELLS],
            height: plane(&height),
        };
        let (colour, height) = texels(&tile.to_bytes()).expect("whole");
        ShownTile {
            x,
            y,
            colour,
            height,
        }
    }

    pub(crate) fn surface() -> Surface {
        let mut surface = PaintingSetup::default().scene().surfaces[0].clone();
        surface.cells = CELLS;
        surface
    }

    pub(crate) fn tiles() -> Vec<ShownTile> {
        (0..2)
            .flat_map(|y| (0..3).map(move |x| tile(x, y)))
            .collect()
    }

    pub(crate) fn shown(tiles: Vec<ShownTile>, level: u32, more: bool) -> Shown {
        Shown {
            cells: CELLS.map(|cells| cells >> level),
            level,
            epoch: 1,
            more,
            tiles,
        }
    }

    /// A view of `size` points, `scale` of them a cell.
    pub(crate) fn look(surface: &Surface, size: [f32; 2], scale: f32) -> View {
        View {
            area: Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1])),
            scale: f64::from(scale) / surface.cell_m,
            ..View::fit(Rect::EVERYTHING, std::slice::from_ref(surface)).expect("a view")
        }
    }

    /// Draws a surface at `scale` pixels a cell, `off` pixels from the lower left corner; the rows
    /// of the picture go downward.
    fn drawn(
        gpu: &Gpu,
        view: &mut SurfaceView,
        passes: &Passes,
        scale: f32,
        off: f32,
    ) -> Vec<[u8; 3]> {
        let size = CELLS.map(|cells| cells as f32 * scale + 2.0 * off);
        let surface = surface();
        let look = look(&surface, size, scale);
        let target = target(gpu, size.map(|side| side as u32));
        let laid = view.lay(gpu, &surface, &look, 1.0).expect("a picture");
        let bound = std::iter::once(&laid.bound);
        draw(gpu, &target, wgpu::Color::RED, |pass| {
            passes.show.draw(pass, bound)
        });
        let bytes = read(gpu, &target);
        bytes.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect()
    }

    fn lamp_from(x: f64) -> Lamp {
        Lamp::new(&LampSetup {
            toward: [x, 0.5, 0.5f64.sqrt()],
            ..Default::default()
        })
    }

    pub(crate) fn lamp() -> Lamp {
        lamp_from(-0.5)
    }

    /// The picture of the export, rows going downward.
    fn exported(lamp: &Lamp, export: &Export) -> Vec<[u8; 3]> {
        let [width, rows] = CELLS.map(|cells| cells as usize);
        let heights: Vec<f32> = (0..width * rows)
            .map(|i| height(i % width, i / width))
            .collect();
        let field = HeightField {
            heights: &heights,
            cells: [width, rows],
            cell_m: 2.5e-4,
        };
        let shadows = Shadows::new(lamp, 2.5e-4);
        let gamut = Gamut::new(export.gamut, export.profile.from_working());
        let pixel = |i: usize| {
            let (x, y) = (i % width, rows - 1 - i / width);
            let mut seen = [1.0];
            shadows.row(&field, [x, y], &mut seen);
            let spot = Spot {
                unlit: colour(x, y),
                gloss: 1.0,
                slope: field.slope(x, y),
                seen: seen[0],
            };
            let mut bytes = [0; 3];
            let profile = &export.profile;
            profile.encode(&[gamut.map(lit(&spot, lamp))], &mut bytes);
            bytes
        };
        (0..width * rows).map(pixel).collect()
    }

    #[test]
    fn the_window_shows_the_bytes_of_the_export() {
        let gpu = gpu();
        let to = |profile: Profile, gamut: GamutMapping| Export {
            profile: profile.into(),
            gamut,
        };
        let wide = || Profile::of(RgbSpace::DisplayP3);
        // A profile that is read goes through the cube.
        let read = Profile::read(wide().icc().to_vec()).expect("our own");
        let exports = [
            (Export::default(), 1),
            (to(Profile::of(RgbSpace::Srgb), GamutMapping::Clamp), 1),
            (to(wide(), GamutMapping::Soft), 1),
            (to(read, GamutMapping::Soft), 2),
        ];
        for (export, most) in &exports {
            let passes = Passes::new(&gpu, export);
            let mut view = SurfaceView::default();
            view.update(&gpu, &passes, &shown(tiles(), 0, false));
            view.light(&gpu, &passes, &lamp(), 2.5e-4);
            let window = drawn(&gpu, &mut view, &passes, 1.0, 0.0);
            let differs = |picture: &[[u8; 3]]| {
                let pairs = window.iter().flatten().zip(picture.iter().flatten());
                pairs.map(|(a, b)| a.abs_diff(*b)).max().expect("pixels")
            };
            let off = differs(&exported(&lamp(), export));
            println!("greatest difference {off} of 255");
            assert!(off <= *most, "{off}");
            let mirrored = exported(&lamp_from(0.5), export);
            assert!(differs(&mirrored) > 2, "a fault would pass");
        }
        let [srgb, _, wide, _] = &exports;
        assert!(
            exported(&lamp(), &srgb.0) != exported(&lamp(), &wide.0),
            "the spaces differ"
        );
    }

    #[test]
    fn a_larger_picture_has_soft_cells_and_edges_and_no_seams() {
        let gpu = gpu();
        let passes = Passes::new(&gpu, &Export::default());
        let mut view = SurfaceView::default();
        // A plane without relief whose green grows evenly: magnified it must still do so.
        let mut flat = tiles();
        for tile in &mut flat {
            tile.height.fill(0);
        }
        view.update(&gpu, &passes, &shown(flat, 0, false));
        view.light(&gpu, &passes, &lamp(), 2.5e-4);
        let (scale, off) = (3.0, 8.5);
        let picture = drawn(&gpu, &mut view, &passes, scale, off);
        let width = (CELLS[0] as f32 * scale + 2.0 * off) as usize;
        let height = picture.len() / width;
        let column: Vec<u8> = (0..height)
            .map(|y| picture[y * width + width / 2][1])
            .collect();
        let inside = &column[12..height - 12];
        let falls = |pair: &[u8]| (0..=4).contains(&(i16::from(pair[0]) - i16::from(pair[1])));
        assert!(inside.windows(2).all(falls), "{inside:?}");
        assert!(
            inside[0] > inside[inside.len() - 1] + 50,
            "the upper rows are above"
        );
        // Half a pixel of the surface lies over half a pixel of the desk.
        let row: Vec<u8> = (0..20)
            .map(|x| picture[(height / 2) * width + x][2])
            .collect();
        assert!(
            (row[0], row[7]) == (60, 60) && row[8] > 70 && row[8] < row[9] - 20,
            "{row:?}"
        );
    }

    #[test]
    fn a_new_level_is_shown_when_it_has_come_whole() {
        let gpu = gpu();
        let passes = Passes::new(&gpu, &Export::default());
        let mut view = SurfaceView::default();
        let level = |view: &SurfaceView| view.shown.as_ref().map(|sheet| sheet.detail.level);
        view.update(&gpu, &passes, &shown(tiles(), 0, true));
        assert_eq!(level(&view), None);
        view.update(&gpu, &passes, &shown(tiles(), 0, false));
        assert_eq!(level(&view), Some(0));
        view.update(&gpu, &passes, &shown(vec![tile(0, 0)], 1, true));
        assert_eq!(level(&view), Some(0));
        view.update(
            &gpu,
            &passes,
            &shown(vec![tile(1, 0), tile(9, 9)], 1, false),
        );
        assert_eq!(level(&view), Some(1));
        view.update(&gpu, &passes, &Shown::default());
        assert_eq!(level(&view), Some(1));
    }
}
