//! Films of a painting: frames of its canvas under its lamp, reduced by averaging linear light.

mod gif;
mod palette;
mod reduction;

pub use gif::GifFilm;

use std::convert::Infallible;

use maulstick_appearance::bands::{Banded, in_order};
use maulstick_appearance::lamp::lamp_over;
use maulstick_appearance::picture::{Depth, Export, Picture};
use maulstick_optics::colour::SrgbTable;
use maulstick_optics::light::Lamp;
use maulstick_painting::Painting;
use maulstick_painting::picture::lit_drawing;
use maulstick_types::scene::CANVAS;

use reduction::Reduction;

/// Values on which the appearance of all cells depends: hash of the look, lamp, names of ground and tooth, seed.
type Look = (i64, Lamp, [String; 2], u64);

/// A canvas that is drawn repeatedly at a small size; only changed rows of tiles are redrawn.
#[derive(Debug)]
pub struct Film {
    reduction: Reduction,
    look: Option<Look>,
    bands: Vec<DrawnBand>,
}

/// Last drawing of a row of tiles.
#[derive(Clone, Debug, Default)]
struct DrawnBand {
    /// Tile version numbers of this row and of its neighbours, whose relief casts shadows on it.
    versions: Vec<u64>,
    /// Its first row of the frame.
    first: usize,
    /// Its share of the linear light of the frame from that row on.
    light: Vec<[f32; 3]>,
}

/// Size of a canvas in the frames of a film, pixels: `width` across, with the proportions of the canvas, and never
/// larger than it. Encoders of video require even sizes.
#[must_use]
pub fn frame_size(cells: [usize; 2], width: usize, is_even: bool) -> [usize; 2] {
    let across = cells[0].max(1);
    let width = width.clamp(1, across);
    let height = (cells[1] * width + across / 2) / across;
    let size = [width, height.max(1)];
    if is_even {
        size.map(|side| (side & !1).max(2))
    } else {
        size
    }
}

impl Film {
    /// A film of a canvas of `cells`, in frames of `size` pixels, across and down.
    #[must_use]
    pub fn new(cells: [usize; 2], size: [usize; 2]) -> Self {
        Self {
            reduction: Reduction::new(cells, size),
            look: None,
            bands: Vec::new(),
        }
    }

    /// The current canvas, in sRGB; `None` if it has other cells than the film.
    pub fn frame(&mut self, painting: &mut Painting) -> Option<Picture> {
        painting.commit();
        let scene = painting.scene();
        let canvas = scene.surfaces.iter().find(|other| other.id == CANVAS)?;
        let names = [canvas.ground.clone(), canvas.tooth.clone()];
        let (lamp, seed) = (lamp_over(scene, CANVAS), canvas.tooth_seed);
        let look = Some((painting.look().print(), lamp, names, seed));
        let export = Export::default();
        let drawing = lit_drawing(painting, CANVAS, &export)?;
        let banded = drawing.banded();
        if banded.cells() != self.reduction.cells {
            return None;
        }
        if self.look != look {
            self.bands.clear();
            self.look = look;
        }
        let (reduction, bands) = (&self.reduction, &mut self.bands);
        bands.resize_with(banded.bands(), DrawnBand::default);
        let versions = (0..banded.bands()).map(|band| versions(banded, band));
        let changed: Vec<(usize, Vec<u64>)> = versions
            .enumerate()
            .filter(|(band, versions)| bands[*band].versions != *versions)
            .collect();
        let Ok(()) = in_order(
            changed.len(),
            |job| {
                let (band, versions) = &changed[job];
                let top = banded.cells()[1] - banded.rows(*band).end;
                let (first, light) = reduction.light(top, &drawing.band(*band, Depth::Sixteen));
                DrawnBand {
                    versions: versions.clone(),
                    first,
                    light,
                }
            },
            |job, drawn| -> Result<(), Infallible> {
                bands[changed[job].0] = drawn;
                Ok(())
            },
        );
        let [width, height] = self.reduction.size;
        let mut frame = vec![[0.0f32; 3]; width * height];
        for band in &self.bands {
            let rows = frame.iter_mut().skip(band.first * width);
            for (sum, light) in rows.zip(&band.light) {
                (0..3).for_each(|c| sum[c] += light[c]);
            }
        }
        let table = SrgbTable::default();
        let rgb = frame.iter().flatten().map(|linear| table.byte(*linear));
        Some(Picture::srgb(width, height, rgb.collect()))
    }
}

/// Numbers of the tile versions of a band and of those beside it.
fn versions(banded: &Banded<'_>, band: usize) -> Vec<u64> {
    let near = band.saturating_sub(1)..(band + 2).min(banded.bands());
    let tiles = near.flat_map(|band| banded.tiles(band));
    tiles
        .map(|(id, _)| banded.store().version(id).number)
        .collect()
}

#[cfg(test)]
mod tests {
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::PaintingSetup;
    use maulstick_painting::edits::{Fill, FillPaint, Scrape, Undo};
    use maulstick_painting::picture::picture;
    use maulstick_types::Mixture;
    use maulstick_types::region::Region;
    use maulstick_types::values::FilmThickness;

    use super::*;

    #[test]
    fn frames_keep_the_proportions_of_the_canvas_and_never_grow() {
        assert_eq!(frame_size([4096, 3072], 640, false), [640, 480]);
        assert_eq!(frame_size([100, 75], 640, false), [100, 75]);
        assert_eq!(frame_size([100, 75], 640, true), [100, 74]);
        assert_eq!(frame_size([4096, 1], 640, false), [640, 1]);
        assert_eq!(frame_size([4096, 1], 640, true), [640, 2]);
    }

    #[test]
    fn a_frame_that_follows_others_is_that_of_a_new_film() {
        let setup = PaintingSetup {
            cells: [200, 150],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let mut painting = Painting::new(&setup, library).expect("a painting");
        let mut film = Film::new([200, 150], [80, 60]);
        let mut whole = Film::new([200, 150], [200, 150]);
        let mut frames = Vec::new();
        let mut look = |painting: &mut Painting| {
            let frame = film.frame(painting).expect("a frame");
            let alone = Film::new([200, 150], [80, 60]).frame(painting);
            assert!(alone.is_some_and(|alone| alone == frame));
            // A pixel a cell is the picture, except for rounding to 16 bits.
            let near = whole.frame(painting).expect("a frame");
            let picture = picture(painting, CANVAS);
            let apart = near.rgb.iter().zip(&picture.rgb);
            assert!(apart.map(|(one, other)| one.abs_diff(*other)).max() <= Some(1));
            frames.push(frame);
        };
        look(&mut painting);
        let fill = Fill {
            paint: FillPaint::Mixture {
                mixture: Mixture::pure("Pyrrole Red"),
            },
            thickness: FilmThickness::new(4e-5).expect("in range"),
            surface: CANVAS,
        };
        painting.apply(fill).expect("laid");
        look(&mut painting);
        let region = Region {
            corner_m: [0.0, 0.0],
            size_m: [5e-3, 5e-3],
        };
        painting
            .apply(Scrape {
                region: Some(region),
                surface: CANVAS,
            })
            .expect("scraped");
        look(&mut painting);
        painting.apply(Undo { brush: None }).expect("undone");
        look(&mut painting);
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
        assert!(frames[1] == frames[3]);
        let mut other = Film::new([100, 150], [80, 60]);
        assert_eq!(other.frame(&mut painting), None);
    }
}
