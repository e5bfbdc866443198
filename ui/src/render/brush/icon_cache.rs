//! Brush thumbnails as textures of the window, each drawn once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{
    Color32, ColorImage, Context, Id, Rect, TextureHandle, TextureOptions, Ui, Vec2, pos2,
};
use maulstick_brush::BrushFile;
use maulstick_optics::colour::srgb_decode;
use maulstick_rig::UserError;
use maulstick_ui_kit::display_transform::DisplayTransform;

use crate::input::brush_choice::read;
use crate::render::brush::thumbnail::brush_thumbnail;

/// Largest number of cached textures; beyond it, all are dropped and drawn again.
const KEPT: usize = 128;
/// Share of a picture's height that the head takes at most, and of its width.
const HEAD: [f64; 2] = [0.9, 0.5];

/// Cache of a window's brushes.
#[derive(Clone, Default)]
struct Gallery(Arc<Mutex<Kept>>);

#[derive(Default)]
struct Kept {
    textures: BTreeMap<(String, [u32; 2]), TextureHandle>,
    own: BTreeMap<PathBuf, Result<Arc<BrushFile>, UserError>>,
}

fn kept(context: &Context) -> Gallery {
    context.data_mut(|data| {
        data.get_temp_mut_or_default::<Gallery>(Id::unique("gallery"))
            .clone()
    })
}

/// Draws a brush, point downward, into a rectangle of the window; two of one `name` look alike.
pub(crate) fn draw(ui: &Ui, area: Rect, tint: &DisplayTransform, name: &str, file: &BrushFile) {
    let texture = texture(ui.ctx(), area.size(), tint, name, file);
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    ui.painter()
        .image(texture.id(), area, whole, Color32::WHITE);
}

fn texture(
    context: &Context,
    size: Vec2,
    tint: &DisplayTransform,
    name: &str,
    file: &BrushFile,
) -> TextureHandle {
    let pixels = (size * context.pixels_per_point()).round();
    let [width, height] = [pixels.x, pixels.y].map(|side| (side as u32).clamp(1, 512));
    let key = (name.to_owned(), [width, height]);
    let gallery = kept(context);
    let mut kept = gallery.0.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(texture) = kept.textures.get(&key) {
        return texture.clone();
    }
    let thickest = file.head.thickness_mm.unwrap_or(0.0);
    let wide = file.head.width_mm.max(thickest) * 1e-3;
    let scale =
        (HEAD[0] * f64::from(width) / wide).min(HEAD[1] * f64::from(height) / file.length_m());
    let picture = brush_thumbnail(file, width as usize, height as usize, scale);
    let pixels = picture.rgba.chunks_exact(4).map(|pixel| {
        let linear = [0, 1, 2].map(|i| srgb_decode(f64::from(pixel[i]) / 255.0) as f32);
        let [red, green, blue, _] = tint.colour(linear).to_array();
        Color32::from_rgba_unmultiplied(red, green, blue, pixel[3])
    });
    let image = ColorImage::new([picture.width, picture.height], pixels.collect());
    let texture = context.load_texture(name, image, TextureOptions::LINEAR);
    if kept.textures.len() >= KEPT {
        kept.textures.clear();
    }
    kept.textures.insert(key, texture.clone());
    texture
}

/// A brush file of the painter's own, read once.
///
/// # Errors
/// As [`read`].
pub(crate) fn own(context: &Context, path: &Path) -> Result<Arc<BrushFile>, UserError> {
    let gallery = kept(context);
    let mut kept = gallery.0.lock().unwrap_or_else(PoisonError::into_inner);
    let found = kept.own.entry(path.to_owned());
    found.or_insert_with(|| read(path).map(Arc::new)).clone()
}

/// Drops the thumbnail of the painter's own brush file, so that it is read again.
pub(crate) fn forget(context: &Context, path: &Path) {
    let gallery = kept(context);
    let mut kept = gallery.0.lock().unwrap_or_else(PoisonError::into_inner);
    kept.own.remove(path);
}
