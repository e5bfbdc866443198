//! Small pictures of paintings in lists of files, read one after the other beside the window, from the files' last
//! displayed tiles.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::{
    Color32, ColorImage, Context, Pos2, Rect, StrokeKind, TextureHandle, TextureOptions, Ui, pos2,
};
use maulstick_appearance::display::DisplayTile;
use maulstick_document::shown_tiles;
use maulstick_optics::colour::srgb_encode;
use maulstick_types::paint::TILE;
use maulstick_types::scene::Surface;
use maulstick_ui_kit::background_task::BackgroundTask;

use maulstick_client::thumbnails::Picture;

/// Pixels of the longer side.
const SIDE: u32 = 96;
/// Greatest number of cached pictures.
const KEPT: usize = 64;

/// State of a picture.
enum Known {
    /// It is to be read, or being read.
    Coming,
    /// The file has none.
    Missing,
    Here(TextureHandle),
}

/// The pictures of a list.
#[derive(Default)]
pub(crate) struct Pictures {
    known: BTreeMap<PathBuf, Known>,
    /// Known paths, the oldest first.
    order: VecDeque<PathBuf>,
    /// Paths to be read; the one that came into sight last comes first.
    wanted: Vec<PathBuf>,
    reading: Option<(PathBuf, BackgroundTask<Option<Picture>>)>,
}

impl std::fmt::Debug for Pictures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Pictures").field(&self.known.len()).finish()
    }
}

impl Pictures {
    /// Stores the picture that was read, and starts reading the next.
    pub(crate) fn take_in(&mut self, context: &Context) {
        if let Some((path, task)) = &self.reading
            && let Poll::Ready(read) = task.poll()
        {
            let known = match read.flatten() {
                Some(picture) => Known::Here(texture(context, &picture)),
                None => Known::Missing,
            };
            if let Some(own) = self.known.get_mut(path) {
                *own = known;
            }
            self.reading = None;
        }
        if self.reading.is_none()
            && let Some(path) = self.wanted.pop()
        {
            let file = path.clone();
            let task = BackgroundTask::start(context, "pictures", move || read(&file));
            self.reading = Some((path, task));
        }
    }

    /// The picture of a painting, if loaded; otherwise it is requested.
    fn of(&mut self, path: &Path) -> Option<&TextureHandle> {
        if !self.known.contains_key(path) {
            while self.order.len() >= KEPT {
                if let Some(oldest) = self.order.pop_front() {
                    self.known.remove(&oldest);
                    self.wanted.retain(|wanted| *wanted != oldest);
                }
            }
            self.known.insert(path.to_owned(), Known::Coming);
            self.order.push_back(path.to_owned());
            self.wanted.push(path.to_owned());
        }
        match self.known.get(path) {
            Some(Known::Here(texture)) => Some(texture),
            _ => None,
        }
    }

    /// Draws the picture of a painting into a place, if it is here.
    pub(crate) fn draw(&mut self, ui: &Ui, place: Rect, path: &Path) {
        if !ui.is_rect_visible(place) {
            return;
        }
        let line = ui.visuals().widgets.noninteractive.bg_stroke;
        let Some(texture) = self.of(path) else {
            ui.painter()
                .rect_stroke(place, 2.0, line, StrokeKind::Inside);
            return;
        };
        let size = texture.size_vec2();
        let fitting = size * (place.size() / size).min_elem();
        let at = Rect::from_center_size(place.center(), fitting);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        ui.painter().image(texture.id(), at, whole, Color32::WHITE);
    }
}

fn texture(context: &Context, picture: &Picture) -> TextureHandle {
    let image = ColorImage::from_rgb(picture.size, &picture.rgb);
    context.load_texture("painting", image, TextureOptions::LINEAR)
}

/// Mean colours of a canvas over the pixels of a picture.
struct Sums {
    size: [usize; 2],
    /// Red, green, blue in linear light, and their number; rows from the top.
    sums: Vec<[f32; 4]>,
}

impl Sums {
    fn of(cells: [u32; 2]) -> Self {
        let longer = cells[0].max(cells[1]).max(1);
        let size = cells.map(|side| {
            if longer > SIDE {
                (side * SIDE).div_ceil(longer).max(1) as usize
            } else {
                side.max(1) as usize
            }
        });
        Self {
            size,
            sums: vec![[0.0; 4]; size[0] * size[1]],
        }
    }

    fn add(&mut self, canvas: &Surface, level: u32, [x, y]: [u32; 2], tile: &DisplayTile) {
        let [across, up] = self.size;
        for row in 0..TILE {
            for column in 0..TILE {
                // The middle of a point, in halves of a cell.
                let middle = |tile: u32, at: usize| {
                    (2 * (u64::from(tile) * TILE as u64 + at as u64) + 1) << level
                };
                let at = [middle(x, column), middle(y, row)];
                let cells = canvas.cells.map(|side| 2 * u64::from(side));
                if at[0] >= cells[0] || at[1] >= cells[1] {
                    continue;
                }
                let pixel =
                    |axis: usize| (at[axis] * self.size[axis] as u64 / cells[axis]) as usize;
                let sum = &mut self.sums[(up - 1 - pixel(1)) * across + pixel(0)];
                for (sum, plane) in sum.iter_mut().zip(&tile.rgb) {
                    *sum += plane[row * TILE + column];
                }
                sum[3] += 1.0;
            }
        }
    }

    fn picture(&self, ground: [f32; 3]) -> Option<Picture> {
        let byte =
            |linear: f32| (srgb_encode(f64::from(linear).clamp(0.0, 1.0)) * 255.0).round() as u8;
        let pixel = |sum: &[f32; 4]| {
            if sum[3] > 0.0 {
                [0, 1, 2].map(|i| byte(sum[i] / sum[3]))
            } else {
                ground.map(byte)
            }
        };
        Picture::new(self.size, self.sums.iter().flat_map(pixel).collect())
    }
}

/// Linear light of bare canvas, roughly; its tooth is too small to be seen.
fn ground(name: &str) -> [f32; 3] {
    match name {
        "grey" => [0.2; 3],
        "black" => [0.02; 3],
        _ => [0.85; 3],
    }
}

/// The picture of a painting; `None` if it was never displayed, is open in a window, or cannot be read.
fn read(path: &Path) -> Option<Picture> {
    let mut all: Option<(Sums, [f32; 3])> = None;
    let read = shown_tiles(path, SIDE, |canvas, level, id, planes| {
        let (sums, _) = all.get_or_insert_with(|| (Sums::of(canvas.cells), ground(&canvas.ground)));
        if let Some(tile) = DisplayTile::from_bytes(planes) {
            sums.add(canvas, level, [id.x, id.y], &tile);
        }
    });
    read.inspect_err(|error| tracing::debug!("no picture of {}: {error}", path.display()))
        .ok()?;
    let (sums, ground) = all?;
    sums.picture(ground)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use egui_kittest::Harness;
    use maulstick_canvas::tile::TileId;
    use maulstick_document::rows::shown_number;
    use maulstick_document::{Access, Checkpoint, Document, DocumentSettings, ShownTile};
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::edits::{Fill, FillPaint};
    use maulstick_painting::{Painting, PaintingSetup, Sequencer};
    use maulstick_types::Mixture;
    use maulstick_types::scene::CANVAS;
    use maulstick_types::values::FilmThickness;

    use super::*;
    use crate::test_support::overlay_bench::until;

    /// A tile of one colour.
    fn even(rgb: [f32; 3]) -> Vec<u8> {
        let plane = |value: f32| vec![value; TILE * TILE];
        let tile = DisplayTile {
            rgb: rgb.map(plane),
            gloss: plane(0.0),
            wetness: plane(0.0),
            height: plane(0.0),
        };
        tile.to_bytes()
    }

    /// A painting of 300 × 200 cells, all painted and displayed at this level: its lowest row of tiles in red, the rest
    /// in blue. The displayed versions are older than the painted ones by `older`.
    fn painted(path: &Path, level: u32, older: u64) {
        let settings = DocumentSettings::new(path, Access::Paint);
        let (document, _) = Document::open(&settings).expect("begun");
        let setup = PaintingSetup {
            cells: [300, 200],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let pager = Arc::clone(document.pager());
        let mut painting = Painting::paged(&setup, library, pager).expect("a painting");
        let fill = Fill {
            paint: FillPaint::Mixture {
                mixture: Mixture::pure("Bone Black"),
            },
            thickness: FilmThickness::new(4e-5).expect("in range"),
            surface: CANVAS,
        };
        painting.apply(fill).expect("laid");
        let mut newest: BTreeMap<TileId, u64> = BTreeMap::new();
        for (id, version) in painting.store(CANVAS).expect("a canvas").iter() {
            let above = TileId {
                x: id.x >> level,
                y: id.y >> level,
            };
            let own = newest.entry(above).or_default();
            *own = (*own).max(version.number);
        }
        let mut kept = Sequencer::new(painting);
        document.write_checkpoint(Checkpoint::of(&mut kept, 0));
        document.flush();
        for (id, version) in newest {
            let rgb = match id.y {
                0 => [0.6, 0.0, 0.0],
                _ => [0.0, 0.0, 0.6],
            };
            document.tile_cache().put(ShownTile {
                place: shown_number(CANVAS, level, id),
                version: version - older,
                look: 7,
                bytes: even(rgb),
            });
        }
        document.write_checkpoint(Checkpoint::of(&mut kept, 0));
        document.flush();
        document.close().expect("closed");
    }

    #[test]
    fn a_painting_looks_as_it_was_displayed_at_whatever_level() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        for level in [0, 1] {
            std::fs::remove_file(&path).ok();
            painted(&path, level, 0);
            let before = std::fs::read(&path).expect("there");
            let picture = read(&path).expect("a picture");
            assert_eq!(picture.size, [96, 64]);
            let pixel = |x: usize, y: usize| &picture.rgb[3 * (96 * y + x)..][..3];
            let [red, blue] = [[203, 0, 0], [0, 0, 203]];
            let lower = 64 - (64 << level) * 64 / 200;
            for x in [0, 50, 95] {
                assert_eq!(pixel(x, 63), red, "the lowest row, level {level}");
                assert_eq!(pixel(x, lower + 2), red, "level {level}");
                assert_eq!(pixel(x, lower - 2), blue, "level {level}");
                assert_eq!(pixel(x, 0), blue, "level {level}");
            }
            assert!(std::fs::read(&path).expect("there") == before);
            let names = std::fs::read_dir(folder.path()).expect("a folder");
            assert_eq!(names.count(), 1, "nothing lies beside it");
        }
    }

    #[test]
    fn what_was_painted_since_and_what_cannot_be_read_shows_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        painted(&path, 1, 1);
        assert_eq!(read(&path), None, "it was painted after it was displayed");
        std::fs::remove_file(&path).expect("removed");
        painted(&path, 1, 0);
        let settings = DocumentSettings::new(&path, Access::Paint);
        let (document, _) = Document::open(&settings).expect("opened");
        assert_eq!(read(&path), None, "it is open");
        document.close().expect("closed");
        assert!(read(&path).is_some());
        let bytes = std::fs::read(&path).expect("there");
        std::fs::write(&path, &bytes[..bytes.len() / 3]).expect("cut short");
        assert_eq!(read(&path), None);
        std::fs::write(&path, "no painting at all").expect("written");
        assert_eq!(read(&path), None);
        assert_eq!(read(&folder.path().join("none.maul")), None);
        assert_eq!(read(folder.path()), None);
    }

    #[test]
    fn pictures_come_one_after_the_other_and_no_more_than_a_few_are_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        painted(&path, 0, 0);
        let own = path.clone();
        let mut harness = Harness::new_ui_state(
            move |ui, pictures: &mut Pictures| {
                pictures.take_in(ui.ctx());
                let place = Rect::from_min_size(ui.min_rect().min, [40.0, 30.0].into());
                pictures.draw(ui, place, &own);
            },
            Pictures::default(),
        );
        until(&mut harness, |harness| {
            let known = &harness.state().known;
            matches!(known.get(&path), Some(Known::Here(_)))
        });
        for number in 0..2 * KEPT {
            harness
                .state_mut()
                .of(&folder.path().join(format!("{number}.maul")));
        }
        until(&mut harness, |harness| harness.state().wanted.is_empty());
        assert!(harness.state().known.len() <= KEPT);
    }
}
