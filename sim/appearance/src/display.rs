//! Unlit colour of tiles, for the view and the exports.

use half::f16;
use half::slice::HalfFloatSliceExt as _;
use maulstick_canvas::dry::DryStack;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::sheet::SheetFilms;
use maulstick_canvas::tile::Tile;
use maulstick_optics::light::HeightField;
use maulstick_optics::light::gloss::{merged_gloss, roughness};
use maulstick_optics::{FilmPlanes, Studio, Under};
use maulstick_types::paint::TILE;

use crate::appearance::Appearance;

/// Display of a tile before light.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayTile {
    /// Linear red, green, blue (sRGB primaries, unclamped).
    pub rgb: [Vec<f32>; 3],
    /// Share of the surface that is glossy, 0 to 1.
    pub gloss: Vec<f32>,
    /// 1 where paint is wet.
    pub wetness: Vec<f32>,
    /// Height of the surface, tooth and paint, above its highest bare peaks, m.
    pub height: Vec<f32>,
}

/// Thickness of each wet paint of a tile, m, by slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WetFilms {
    /// All paint.
    pub(crate) all: SheetFilms,
    /// Body and upper sheet, where there are two.
    pub(crate) sheets: Option<[SheetFilms; 2]>,
}

/// Films for the optics.
fn borrowed(films: &SheetFilms) -> Vec<(usize, &[f32])> {
    let films = films.iter();
    films.map(|(slot, film)| (*slot, film.as_slice())).collect()
}

impl WetFilms {
    /// The uppermost film for the optics, by slot: the upper sheet, or all paint.
    #[must_use]
    pub fn planes(&self) -> Vec<(usize, &[f32])> {
        let uppermost = self.sheets.as_ref().map(|[_, upper]| upper);
        borrowed(uppermost.unwrap_or(&self.all))
    }

    /// The film under it for the optics; `None` where all paint is one sheet.
    #[must_use]
    pub fn body(&self) -> Option<Vec<(usize, &[f32])>> {
        self.sheets.as_ref().map(|[body, _]| borrowed(body))
    }

    /// Colours of the films over their ground: linear red, green, blue.
    #[must_use]
    pub fn shade(&self, studio: &Studio, under: Under<'_>) -> [Vec<f32>; 3] {
        let mut rgb = [const { Vec::new() }; 3];
        rgb.iter_mut()
            .for_each(|plane| plane.resize(TILE_CELLS, 0.0));
        let [red, green, blue] = &mut rgb;
        let baked = self.body().map(|body| {
            let body = FilmPlanes {
                paints: &body,
                opacity: 1.0,
                under,
            };
            studio.bake(&body, TILE_CELLS)
        });
        let planes = FilmPlanes {
            paints: &self.planes(),
            opacity: 1.0,
            under: baked.as_deref().map_or(under, Under::Planes),
        };
        studio.shade(&planes, [red, green, blue]);
        rgb
    }
}

/// Height of wet films and of the dried paint under them, m.
pub(crate) fn height(films: &[(usize, Vec<f32>)], dry: Option<&DryStack>) -> Vec<f32> {
    let mut height: Vec<f32> = match dry {
        Some(stack) => stack
            .height()
            .iter()
            .map(|quanta| quanta * QUANTUM_M as f32)
            .collect(),
        None => vec![0.0; TILE_CELLS],
    };
    for (_, film) in films {
        height
            .iter_mut()
            .zip(film)
            .for_each(|(sum, thickness)| *sum += thickness);
    }
    height
}

/// Gloss of the topmost paint of a tile, from its pigments, its share of thinner and its wetness.
fn gloss(films: &[(usize, Vec<f32>)], dry: Option<&DryStack>, look: &Appearance) -> Vec<f32> {
    let mut gloss = vec![0.0; TILE_CELLS];
    let mut bare = TILE_CELLS;
    // From the top down: a cell has the gloss of its topmost paint.
    let mut lay = |planes: &[(usize, &[f32])], wetness: f32, sealed: &dyn Fn(usize) -> f32| {
        let glosses: Vec<f32> = planes.iter().map(|(slot, _)| look.gloss(*slot)).collect();
        for cell in 0..TILE_CELLS {
            if gloss[cell] > 0.0 {
                continue;
            }
            let (mut paint, mut thin, mut sum) = (0.0, 0.0, 0.0);
            for ((slot, plane), own) in planes.iter().zip(&glosses) {
                if look.thinner == Some(*slot) {
                    thin += plane[cell];
                } else {
                    paint += plane[cell];
                    sum += own * plane[cell];
                }
            }
            let all = paint + thin;
            if all > 0.0 {
                let own = if paint > 0.0 { sum / paint } else { 0.0 };
                gloss[cell] =
                    sealed(cell) * maulstick_optics::light::gloss(own, thin / all, wetness);
                bare -= 1;
            }
        }
        bare > 0
    };
    let wet: Vec<_> = films
        .iter()
        .map(|(slot, film)| (*slot, film.as_slice()))
        .collect();
    let mut more = lay(&wet, 1.0, &|_| 1.0);
    let thick = dry.map(DryStack::height);
    let sealed = |cell: usize| {
        let quanta = thick.as_ref().map_or(0.0, |thick| thick[cell]);
        sealed(f64::from(quanta) * QUANTUM_M)
    };
    let mut layers = dry.into_iter().flat_map(DryStack::layers);
    while more && let Some(layer) = layers.next() {
        let content = layer.planes.get();
        let planes: Vec<_> = content
            .iter()
            .map(|(slot, plane)| (*slot, &**plane))
            .collect();
        more = lay(&planes, 0.0, &sealed);
    }
    gloss
}

/// Thickness of dry paint over which its ground drinks e times less of its oil, m: on gesso a first thin coat sinks in and
/// is matt, as painters know it, and a few coats seal the ground. All grounds drink alike, also sized ones.
const SEALS_M: f64 = 20e-6;

/// Share of its gloss that dry paint keeps on the ground, where it is so thick, m.
fn sealed(thick_m: f64) -> f32 {
    (1.0 - maulstick_num::exp(-thick_m / SEALS_M)) as f32
}

impl DisplayTile {
    /// Display of a tile on a flat ground. `rgb` are the colours of its wet `films` over that.
    #[must_use]
    pub fn of(
        tile: Option<&Tile>,
        (films, rgb): (&WetFilms, [Vec<f32>; 3]),
        look: &Appearance,
    ) -> Self {
        let dry = tile.and_then(Tile::dry).map(|stack| &**stack);
        let wetness = height(&films.all, None)
            .iter()
            .map(|thickness| f32::from(u8::from(*thickness > 0.0)))
            .collect();
        Self {
            rgb,
            gloss: gloss(&films.all, dry, look),
            wetness,
            height: height(&films.all, dry),
        }
    }

    /// The tile of the next level from its four children, of cells of side `cell_m`: lower left, lower right, upper
    /// left, upper right; absent ones are beyond the edge and count as `outside`. Slopes below its resolution reduce
    /// its gloss (Toksvig 2005).
    #[must_use]
    pub fn coarser(children: [Option<&Self>; 4], outside: &Self, cell_m: f32) -> Self {
        let children = children.map(|child| child.unwrap_or(outside));
        let fours = |plane: &dyn Fn(&Self) -> &Vec<f32>| {
            let four = |cell: usize| {
                let (x, y) = (2 * (cell % TILE), 2 * (cell / TILE));
                let plane = plane(children[2 * (y / TILE) + x / TILE]);
                let at = (y % TILE) * TILE + x % TILE;
                [at, at + 1, at + TILE, at + TILE + 1].map(|at| plane[at])
            };
            (0..TILE_CELLS).map(four).collect::<Vec<[f32; 4]>>()
        };
        let mean = |four: &[f32; 4]| 0.25 * (four[0] + four[1] + four[2] + four[3]);
        let halve = |plane: &dyn Fn(&Self) -> &Vec<f32>| -> Vec<f32> {
            fours(plane).iter().map(mean).collect()
        };
        let heights = fours(&|t| &t.height);
        let height: Vec<f32> = heights.iter().map(mean).collect();
        let field = HeightField {
            heights: &height,
            cells: [TILE; 2],
            cell_m: 2.0 * cell_m,
        };
        let glosses = fours(&|t| &t.gloss);
        let merged = glosses.iter().zip(&heights).enumerate().map(|(cell, own)| {
            let (gloss, [a, b, c, d]) = own;
            let slopes = [b - a, d - c, c - a, d - b].map(|rise| rise / cell_m);
            let shown = field.slope(cell % TILE, cell / TILE);
            let squares = |slopes: &[f32]| slopes.iter().map(|s| s * s).sum::<f32>();
            let hidden = (0.25 * squares(&slopes) - 0.5 * squares(&shown)).max(0.0);
            let rough = gloss.map(|gloss| roughness(gloss) * roughness(gloss));
            merged_gloss(mean(&rough), hidden)
        });
        let gloss = merged.collect();
        Self {
            rgb: [
                halve(&|t| &t.rgb[0]),
                halve(&|t| &t.rgb[1]),
                halve(&|t| &t.rgb[2]),
            ],
            gloss,
            wetness: halve(&|t| &t.wetness),
            height,
        }
    }

    /// The tile with the mean of each plane in all of its cells.
    #[must_use]
    pub fn even(&self) -> Self {
        let even = |plane: &[f32]| {
            let sum: f64 = plane.iter().copied().map(f64::from).sum();
            vec![(sum / plane.len().max(1) as f64) as f32; plane.len()]
        };
        Self {
            rgb: self.rgb.each_ref().map(|plane| even(plane)),
            gloss: even(&self.gloss),
            wetness: even(&self.wetness),
            height: even(&self.height),
        }
    }

    /// The planes in the layout of a frame: red, green, blue, gloss, wetness as half floats, height as floats, little
    /// endian.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(TILE_CELLS * 14);
        let mut halves = vec![f16::ZERO; TILE_CELLS];
        let [red, green, blue] = &self.rgb;
        for plane in [red, green, blue, &self.gloss, &self.wetness] {
            halves.convert_from_f32_slice(plane);
            bytes.extend(halves.iter().flat_map(|half| half.to_le_bytes()));
        }
        bytes.extend(self.height.iter().flat_map(|height| height.to_le_bytes()));
        bytes
    }

    /// Reads [`to_bytes`](Self::to_bytes); `None` if the length is wrong.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        if bytes.len() != TILE_CELLS * 14 {
            return None;
        }
        let half = |plane: usize| -> Vec<f32> {
            bytes[plane * TILE_CELLS * 2..][..TILE_CELLS * 2]
                .chunks_exact(2)
                .map(|pair| f16::from_le_bytes([pair[0], pair[1]]).to_f32())
                .collect()
        };
        let height = bytes[TILE_CELLS * 10..]
            .chunks_exact(4)
            .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
            .collect();
        Some(Self {
            rgb: [half(0), half(1), half(2)],
            gloss: half(3),
            wetness: half(4),
            height,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use maulstick_optics::PaintLibrary;

    use super::*;

    fn shown(tile: Option<&Tile>, studio: &Studio, ground: &[f32]) -> DisplayTile {
        let films = WetFilms::of(tile);
        let rgb = films.shade(studio, Under::Even(ground));
        let look = Appearance::new(studio.clone());
        DisplayTile::of(tile, (&films, rgb), &look)
    }

    fn tile() -> (Studio, Vec<f32>, DisplayTile) {
        let mut studio = Studio::daylight();
        let library = PaintLibrary::measured().expect("whole");
        studio.add(library.find("Ultramarine Blue").expect("known"));
        let ground = vec![0.95; studio.wavelengths()];
        let plane: Arc<[f32]> = (0..TILE_CELLS)
            .map(|i| if i % 2 == 0 { 33_000.0 } else { 0.0 })
            .collect();
        let tile = Tile::new([(0, plane)].into_iter(), None);
        let shown = shown(Some(&tile), &studio, &ground);
        (studio, ground, shown)
    }

    #[test]
    fn a_blue_film_is_blue_and_has_its_thickness() {
        let (_, _, shown) = tile();
        assert!(shown.rgb[2][0] > 1.5 * shown.rgb[0][0]);
        assert!((shown.height[0] - 33_000.0 * QUANTUM_M as f32).abs() < 1e-9);
        assert_eq!((shown.wetness[0], shown.wetness[1]), (1.0, 0.0));
    }

    #[test]
    fn bytes_come_back_within_half_precision() {
        let (_, _, shown) = tile();
        let back = DisplayTile::from_bytes(&shown.to_bytes()).expect("whole");
        for (one, two) in shown.rgb.iter().flatten().zip(back.rgb.iter().flatten()) {
            assert!((one - two).abs() < 1e-3 * one.abs().max(1e-3));
        }
        assert_eq!(shown.height, back.height);
        assert_eq!(DisplayTile::from_bytes(&[0; 7]), None);
    }

    #[test]
    fn a_coarser_tile_is_the_mean_of_its_cells() {
        let (studio, ground, painted) = tile();
        let bare = shown(None, &studio, &ground);
        let coarse = DisplayTile::coarser([Some(&painted), None, None, None], &bare, 2.5e-4);
        assert!((coarse.height[0] - 0.5 * painted.height[0]).abs() < 1e-9);
        assert_eq!(
            coarse.height[40], 0.0,
            "the right half lies beyond the edge"
        );
    }

    #[test]
    fn bristle_marks_that_a_coarser_tile_does_not_show_dull_its_gloss() {
        let (_, _, painted) = tile();
        let marked = |height: &dyn Fn(usize) -> f32| {
            let mut tile = painted.clone();
            tile.gloss = vec![0.75; TILE_CELLS];
            tile.height = (0..TILE_CELLS).map(|i| height(i % TILE) * 1e-4).collect();
            DisplayTile::coarser([Some(&tile); 4], &tile, 2.5e-4)
        };
        let level = marked(&|_| 1.0).gloss[100];
        assert!((level - 0.75).abs() < 1e-3, "{level}");
        let [ramp, marks] = [marked(&|x| x as f32), marked(&|x| (x % 2) as f32)];
        assert!(
            ramp.gloss[100] > 0.749,
            "{} shows its slope",
            ramp.gloss[100]
        );
        // Flanks of slope .4 along x: a variance of .08 an axis.
        let square = roughness(0.75) * roughness(0.75) + 0.16;
        let got = roughness(marks.gloss[100]);
        println!("roughness {got:.3}, expected {:.3}", square.sqrt());
        assert!((got - square.sqrt()).abs() < 1e-3);
        assert!(got > 2.0 * roughness(level), "a mean of gloss would pass");
    }
}
