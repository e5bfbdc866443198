//! The picture of the canvas as a texture, and where on the desk a point of it is.

use eframe::egui::{Color32, ColorImage, Context, Pos2, Rect, TextureHandle, TextureOptions, Vec2};
use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::paint::TILE;
use maulstick_types::scene::Surface;

use crate::frames::Shown;

/// What lies around the canvas.
pub const DESK_COLOUR: Color32 = Color32::from_gray(60);

/// The canvas as it is shown.
#[derive(Default)]
pub struct Canvas {
    texture: Option<TextureHandle>,
    cells: [u32; 2],
    level: u32,
    epoch: u32,
}

impl Canvas {
    /// Takes in tiles; those of another size, level or start of the paint node begin a new picture.
    pub fn update(&mut self, context: &Context, shown: &Shown) {
        if shown.cells.contains(&0) {
            return;
        }
        let other = (self.cells, self.level, self.epoch) != (shown.cells, shown.level, shown.epoch);
        if self.texture.is_none() || other {
            let same_size = self.cells == shown.cells;
            (self.cells, self.level, self.epoch) = (shown.cells, shown.level, shown.epoch);
            // A paint node that started anew paints over the picture that is on the screen.
            if self.texture.is_none() || !same_size {
                let size = shown.cells.map(|cells| cells as usize);
                let image = ColorImage::filled(size, DESK_COLOUR);
                self.texture = Some(context.load_texture("canvas", image, TextureOptions::LINEAR));
            }
        }
        let Some(texture) = &mut self.texture else {
            return;
        };
        for tile in &shown.tiles {
            let left = tile.x as usize * TILE;
            let bottom = tile.y as usize * TILE;
            let [width, height] = shown.cells.map(|cells| cells as usize);
            if left >= width || bottom >= height {
                continue;
            }
            let size = [TILE.min(width - left), TILE.min(height - bottom)];
            // Tiles go upward from the lowest row, pictures downward from the highest.
            let mut pixels = Vec::with_capacity(size[0] * size[1]);
            for row in (0..size[1]).rev() {
                pixels.extend_from_slice(&tile.pixels[row * TILE..][..size[0]]);
            }
            let top = height - bottom - size[1];
            texture.set_partial(
                [left, top],
                ColorImage::new(size, pixels),
                TextureOptions::LINEAR,
            );
        }
    }

    /// The texture, once there is a picture.
    #[must_use]
    pub fn texture(&self) -> Option<&TextureHandle> {
        self.texture.as_ref()
    }
}

impl std::fmt::Debug for Canvas {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Canvas")
            .field("cells", &self.cells)
            .finish_non_exhaustive()
    }
}

/// The largest rectangle of the canvas's proportions in `area`, with a margin.
#[must_use]
pub fn fit(area: Rect, cells: [u32; 2]) -> Rect {
    const MARGIN: f32 = 16.0;
    let area = area.shrink(MARGIN);
    let size = Vec2::new(cells[0].max(1) as f32, cells[1].max(1) as f32);
    let scale = (area.width() / size.x)
        .min(area.height() / size.y)
        .max(1e-3);
    Rect::from_center_size(area.center(), size * scale)
}

/// The level of detail for a canvas of `cells` shown in `rect` with `pixels_per_point`.
#[must_use]
pub fn level(cells: [u32; 2], rect: Rect, pixels_per_point: f32) -> u32 {
    let ratio = cells[0] as f32 / (rect.width() * pixels_per_point).max(1.0);
    if ratio > 1.0 {
        ratio.log2().floor() as u32
    } else {
        0
    }
}

/// The point of the desk under a point of the window, m.
#[must_use]
pub fn to_desk(pointer: Pos2, rect: Rect, surface: &Surface) -> DVec3 {
    let across = f64::from((pointer.x - rect.min.x) / rect.width());
    let up = f64::from((rect.max.y - pointer.y) / rect.height());
    let size = surface.cells.map(|cells| f64::from(cells) * surface.cell_m);
    let local = DVec3::new(across * size[0], up * size[1], 0.0) * surface.zoom;
    Rigid::from(&surface.pose).point(local)
}

#[cfg(test)]
mod tests {
    use maulstick_paint::PaintingSetup;

    use super::*;

    #[test]
    fn the_corners_of_the_picture_are_those_of_the_canvas() {
        let scene = PaintingSetup::default().scene();
        let rect = fit(
            Rect::from_min_size(Pos2::ZERO, Vec2::new(900.0, 700.0)),
            [1024, 1024],
        );
        assert!((rect.width() - rect.height()).abs() < 1e-3);
        let corner = to_desk(rect.left_bottom(), rect, &scene.surfaces[0]);
        assert!((corner - DVec3::new(-0.128, -0.128, 0.0)).length() < 1e-6);
        let middle = to_desk(rect.center(), rect, &scene.surfaces[0]);
        assert!(middle.length() < 1e-6);
    }

    #[test]
    fn a_small_picture_takes_a_coarser_level() {
        let rect = |side: f32| Rect::from_min_size(Pos2::ZERO, Vec2::splat(side));
        assert_eq!(level([1024; 2], rect(1024.0), 1.0), 0);
        assert_eq!(level([1024; 2], rect(500.0), 1.0), 1);
        assert_eq!(level([1024; 2], rect(500.0), 2.0), 0);
        assert_eq!(level([4096; 2], rect(500.0), 1.0), 3);
    }
}
