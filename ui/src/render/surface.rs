//! A surface on the graphics device: its tiles are uploaded as they arrive, lit, and drawn.

use eframe::egui_wgpu::wgpu;
use maulstick_appearance::picture::Export;
use maulstick_optics::gamut::Gamut;
use maulstick_optics::light::Lamp;
use maulstick_types::scene::Surface;

use maulstick_client::frames::Shown;
use maulstick_client::frames::tile_planner::Part;

use crate::render::gpu::Gpu;
use crate::render::light_surface::LightSurface;
use crate::render::show_surface::{PixelRect, Place, Region, ShowSurface};
use crate::render::tile_atlas::TileAtlas;
use crate::view::camera::View;

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

/// An atlas as it is shown, and the one that replaces it once it is complete.
#[derive(Debug, Default)]
struct Slot {
    shown: Option<TileAtlas>,
    coming: Option<TileAtlas>,
}

impl Slot {
    fn update(&mut self, gpu: &Gpu, pass: &LightSurface, shown: &Shown) {
        let is_new =
            |atlas: &Option<TileAtlas>| atlas.as_ref().is_none_or(|atlas| !atlas.is_of(shown));
        if is_new(&self.coming) {
            self.coming = None;
            if is_new(&self.shown) {
                self.coming = TileAtlas::of(gpu, pass, shown);
                if let (Some(old), Some(_)) = (&mut self.shown, &self.coming) {
                    old.freeze();
                }
            }
        }
        let old = self.shown.as_mut().filter(|atlas| atlas.is_of(shown));
        let Some(atlas) = self.coming.as_mut().or(old) else {
            return;
        };
        atlas.take(gpu, shown);
        let is_whole = !atlas.state().held.is_empty();
        if is_whole && self.coming.is_some() {
            self.shown = self.coming.take();
        }
    }

    fn bytes(&self) -> u64 {
        let atlases = self.shown.iter().chain(&self.coming);
        atlases.map(TileAtlas::bytes).sum()
    }
}

/// The previous placement of a surface.
#[derive(Debug)]
struct Placed {
    /// Numbers of the sheets.
    of: [u64; 2],
    place: Place,
    uniform: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

/// A surface as it is shown: its detail, and its base where that does not reach.
#[derive(Debug, Default)]
pub struct SurfaceView {
    detail: Slot,
    base: Slot,
    placed: Option<Placed>,
}

impl SurfaceView {
    /// Takes in tiles. Those of another atlas begin a new picture, which is shown when it is complete.
    pub fn update(&mut self, gpu: &Gpu, passes: &Passes, shown: &Shown) {
        let slot = match shown.part {
            Part::Detail => &mut self.detail,
            Part::Base => &mut self.base,
        };
        slot.update(gpu, &passes.light, shown);
    }

    /// Bytes of all textures.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.detail.bytes() + self.base.bytes()
    }

    /// Lights what has changed, under a lamp in the surface's frame.
    pub fn light(&mut self, gpu: &Gpu, passes: &Passes, lamp: &Lamp, cell_m: f64) {
        for atlas in [&mut self.detail.shown, &mut self.base.shown]
            .into_iter()
            .flatten()
        {
            atlas.light(gpu, &passes.light, lamp, cell_m);
        }
    }

    /// Places the surface in the view; `None` until there is a picture.
    #[must_use]
    pub fn lay(
        &mut self,
        gpu: &Gpu,
        passes: &Passes,
        surface: &Surface,
        view: &View,
        pixels_per_point: f32,
    ) -> Option<Laid> {
        let (fine, coarse) = (self.detail.shown.as_mut(), self.base.shown.as_mut());
        let region = |atlas: &Option<&mut TileAtlas>| {
            let region = atlas.as_ref().map(|atlas| atlas.region(surface.cells));
            region.unwrap_or_default()
        };
        let number =
            |atlas: &Option<&mut TileAtlas>| atlas.as_ref().map_or(0, |s| s.state().number);
        let of = [number(&fine), number(&coarse)];
        // A base without a detail is one.
        let regions = match (&fine, &coarse) {
            (None, _) => [region(&coarse), Region::default()],
            _ => [region(&fine), region(&coarse)],
        };
        let mut atlases: Vec<&mut TileAtlas> = fine.into_iter().chain(coarse).collect();
        let place = Place::of(surface, view, pixels_per_point, regions);
        let mut fresh = PixelRect::NOTHING;
        for atlas in &mut atlases {
            let extent = atlas.region(surface.cells).extent;
            for area in atlas.fresh() {
                fresh = fresh.with(&place.covered(&area, extent));
            }
        }
        let lit = [atlases.first()?, atlases.last()?].map(|atlas| &atlas.lit);
        if let Some(placed) = self.placed.as_ref().filter(|placed| placed.of == of) {
            let mut changed = fresh;
            if placed.place != place {
                changed = PixelRect::EVERYTHING;
                gpu.queue
                    .write_buffer(&placed.uniform, 0, bytemuck::bytes_of(&place));
            }
            let bound = placed.bound.clone();
            if let Some(placed) = &mut self.placed {
                placed.place = place;
            }
            return Some(Laid { bound, changed });
        }
        let uniform = gpu.uniform::<Place>("place");
        gpu.queue
            .write_buffer(&uniform, 0, bytemuck::bytes_of(&place));
        let bound = passes.show.bind(gpu, &uniform, lit);
        self.placed = Some(Placed {
            of,
            place,
            uniform,
            bound: bound.clone(),
        });
        Some(Laid {
            bound,
            changed: PixelRect::EVERYTHING,
        })
    }
}

/// A surface in its place, ready to be shown.
#[derive(Debug)]
pub struct Laid {
    /// For [`ShowSurface::lay`].
    pub bound: wgpu::BindGroup,
    /// Pixels that differ from those of the previous placement.
    pub changed: PixelRect,
}

#[cfg(test)]
mod pan_zoom_tests;

#[cfg(test)]
pub(crate) mod tests {
    use eframe::egui::{Rect, pos2, vec2};
    use glam::{DVec2, DVec3};
    use maulstick_appearance::display::DisplayTile;
    use maulstick_canvas::planes::TILE_CELLS;
    use maulstick_optics::colour::RgbSpace;
    use maulstick_optics::gamut::GamutMapping;
    use maulstick_optics::icc::Profile;
    use maulstick_optics::light::{Facet, HeightField, LampSetup, Spot, Surroundings, lit};
    use maulstick_painting::PaintingSetup;
    use maulstick_types::paint::TILE;

    use super::*;
    use crate::render::gpu::testing::{draw, gpu, read, target};
    use crate::view::camera::corners;
    use maulstick_client::frames::tile_planner::AtlasState;
    use maulstick_client::frames::tiles::TileRect;
    use maulstick_client::frames::{ShownTile, texels};

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
        let room = [3 - level, 2 - level];
        let held = if more {
            TileRect::NONE
        } else {
            TileRect::up_to(room)
        };
        Shown {
            atlas: AtlasState {
                number: u64::from(level) + 1,
                level,
                room,
                held,
                wet: false,
            },
            cells: CELLS.map(|cells| cells >> level),
            tiles,
            ..Shown::default()
        }
    }

    /// A view of `size` points, `scale` of them a cell.
    pub(crate) fn look(surface: &Surface, size: [f32; 2], scale: f32) -> View {
        let [low, _, _, high] = corners(surface).map(DVec3::truncate);
        View {
            area: Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1])),
            middle: 0.5 * (low + high),
            scale: f64::from(scale) / surface.cell_m,
            mirrored: false,
            room: DVec2::ONE,
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
        let laid = view
            .lay(gpu, passes, &surface, &look, 1.0)
            .expect("a picture");
        draw(gpu, &target, wgpu::Color::RED, |pass| {
            passes.show.fill(pass, &laid.bound);
            passes.show.lay(pass, &laid.bound);
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
        let surroundings = Surroundings::new(lamp, 2.5e-4);
        let gamut = Gamut::new(export.gamut, export.profile.from_working());
        let pixel = |i: usize| {
            let (x, y) = (i % width, rows - 1 - i / width);
            let mut facet = [Facet::LEVEL];
            surroundings.row(&field, [x, y], &mut facet);
            let spot = Spot {
                unlit: colour(x, y),
                gloss: 1.0,
                facet: facet[0],
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
        let level = |view: &SurfaceView| view.detail.shown.as_ref().map(|s| s.state().level);
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
