//! A canvas, a brush and a hand for the measurements of looks, and the resulting films.

use maulstick_appearance::show_paint::counted_films;
use maulstick_appearance::{Appearance, Bakery};
use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::sheet::sheets;
use maulstick_num::atan2;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Dry, Load};
use maulstick_painting::picture::banded;
use maulstick_painting::{EditError, Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_session::Offline;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use maulstick_types::values::BrushName;
use maulstick_types::{Edit, Mixture};

use crate::map::Map;

const RATE_HZ: f64 = 250.0;
/// Speed of the hand, mm/s.
const SPEED: f64 = 100.0;
/// Share of the head's length by which full pressure presses a brush in.
const DEPTH_SHARE: f64 = 0.5;
/// Name of the first brush.
pub(crate) const BRUSH: &str = "main";

/// A straight stroke.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Ends, mm from the lower left corner.
    pub from: [f64; 2],
    /// As `from`.
    pub to: [f64; 2],
    /// Pressure, 0 to 1.
    pub pressure: f64,
    /// Lean of the handle along the path, degrees.
    pub lean_deg: f64,
}

impl Stroke {
    /// Along x at a height.
    pub fn along(y: f64, from: f64, to: f64, pressure: f64) -> Self {
        Self {
            from: [from, y],
            to: [to, y],
            pressure,
            lean_deg: 25.0,
        }
    }
}

/// A canvas with a hand over it.
pub struct Easel {
    /// Brush and paint.
    pub offline: Offline,
    size_mm: [f64; 2],
    /// Side of a cell, mm.
    pub cell_mm: f64,
    now_s: f64,
}

fn refused(refusal: EditError) -> UserError {
    UserError::failure(format!("{refusal}; {}", refusal.advice()))
}

/// A brush of the library, so wide.
///
/// # Errors
/// [`UserError`] if there is none, or none so wide.
pub fn brush(kind: &str, width_mm: f64) -> Result<BrushFile, UserError> {
    let found = BrushFile::library(kind).map_err(|error| UserError::failure(error.to_string()))?;
    found
        .scaled_to(width_mm)
        .map_err(|error| UserError::failure(error.to_string()))
}

impl Easel {
    /// A canvas with a tooth and a brush.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn new(
        size_mm: [f64; 2],
        cell_mm: f64,
        tooth: &str,
        file: BrushFile,
    ) -> Result<Self, UserError> {
        let library =
            PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))?;
        let setup = PaintingSetup {
            tooth: tooth.to_owned(),
            cells: size_mm.map(|mm| (mm / cell_mm).round() as u32),
            cell_m: 1e-3 * cell_mm,
            ..PaintingSetup::default()
        };
        let painting = Painting::new(&setup, library).map_err(refused)?;
        let offline =
            Offline::new(painting, BRUSH, file, DEPTH_SHARE, Vec::new()).map_err(refused)?;
        Ok(Self {
            offline,
            size_mm,
            cell_mm,
            now_s: 1.0,
        })
    }

    /// Makes an edit.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn edit(&mut self, edit: impl Into<Edit>) -> Result<(), UserError> {
        self.offline.edit(edit).map(drop).map_err(refused)
    }

    /// Takes up a brush, with the load that it had when it was put down.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn take_up(&mut self, name: &str, file: BrushFile) -> Result<(), UserError> {
        self.offline
            .take_up(name, file, DEPTH_SHARE)
            .map_err(refused)
    }

    /// Loads the brush in hand with a mixture.
    ///
    /// # Errors
    /// [`UserError`] if there is no such paint.
    pub fn load(&mut self, mixture: &str) -> Result<(), UserError> {
        self.load_with(mixture, None)
    }

    /// Loads the halves of the brush in hand with two mixtures.
    ///
    /// # Errors
    /// [`UserError`] if there is no such paint.
    pub fn load_beside(&mut self, left: &str, right: &str) -> Result<(), UserError> {
        self.load_with(left, Some(right))
    }

    fn load_with(&mut self, mixture: &str, beside: Option<&str>) -> Result<(), UserError> {
        let read = |text: &str| {
            let read = text.parse::<Mixture>();
            read.map_err(|error| UserError::failure(format!("{error}")))
        };
        self.edit(Load {
            mixture: read(mixture)?,
            beside: beside.map(read).transpose()?,
            brush: BrushName::new(self.offline.brush())?,
        })
    }

    /// Paints a stroke as a step of a script: a take of its own, with its load.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn script_stroke(&mut self, mixture: &str, stroke: &Stroke) -> Result<(), UserError> {
        self.offline.begin_take(Vec::new()).map_err(refused)?;
        self.load(mixture)?;
        self.stroke(stroke)
    }

    /// The slot of a paint.
    ///
    /// # Errors
    /// [`UserError`] if no brush has been loaded with it.
    pub fn slot(&mut self, paint: &str) -> Result<usize, UserError> {
        let scene = self.offline.painting_mut().scene();
        let slot = scene.paints.iter().position(|own| own.name == paint);
        slot.ok_or_else(|| UserError::failure(format!("no paint '{paint}' in the painting")))
    }

    /// The appearance of its paints.
    pub fn look(&mut self) -> &Appearance {
        self.offline.painting_mut().look()
    }

    /// Dries the whole canvas.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn dry(&mut self) -> Result<(), UserError> {
        self.edit(Dry::whole(CANVAS))
    }

    /// Paints a stroke.
    ///
    /// # Errors
    /// [`UserError`] if the painting refuses it.
    pub fn stroke(&mut self, stroke: &Stroke) -> Result<(), UserError> {
        let way = [0, 1].map(|i| stroke.to[i] - stroke.from[i]);
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let samples = (length / SPEED * RATE_HZ).ceil().max(2.0) as usize;
        let unit = way.map(|v| v / length);
        // The broad side of a flat brush is across the path.
        let twist = atan2(-unit[0], unit[1]);
        for i in 0..=samples + 1 {
            let t = (i as f64 / samples as f64).min(1.0);
            let ramp = (t * length / 4.0)
                .min((1.0 - t) * length / 4.0)
                .clamp(0.02, 1.0);
            let pressure = if i > samples {
                0.0
            } else {
                stroke.pressure * ramp
            };
            let desk = |k: usize| 1e-3 * (stroke.from[k] + t * way[k] - 0.5 * self.size_mm[k]);
            let lean = stroke.lean_deg.to_radians();
            let sample = StylusSample {
                senses: axes::POSITION | axes::PRESSURE,
                in_range: true,
                pose: StylusPose::Contact {
                    point_m: [desk(0), desk(1), 0.0],
                    tilt_rad: unit.map(|v| v * lean),
                    twist_rad: twist,
                    pressure,
                },
                ..StylusSample::away()
            };
            let event_ns = (self.now_s * 1e9) as u64;
            self.offline.sample(event_ns, &sample).map_err(refused)?;
            self.now_s += 1.0 / RATE_HZ;
        }
        self.now_s += 0.3;
        Ok(())
    }

    /// Thickness of the wet paint, µm, of one slot or of all.
    pub fn film(&mut self, slot: Option<usize>) -> Map {
        self.wet(slot, false)
    }

    /// Thickness of a wet paint in the upper sheet, µm.
    pub fn upper(&mut self, slot: usize) -> Map {
        self.wet(Some(slot), true)
    }

    fn wet(&mut self, slot: Option<usize>, is_upper: bool) -> Map {
        let painting = self.offline.painting_mut();
        painting.commit();
        let mut map = Map::new(self.size_mm, self.cell_mm);
        let Some(store) = painting.store(CANVAS) else {
            return map;
        };
        for (id, version) in store.iter() {
            let Some(tile) = &version.tile else { continue };
            let wet = tile.wet();
            let films = match sheets(&wet) {
                Some([_, upper]) if is_upper => upper,
                _ => counted_films(&wet),
            };
            for (_, film) in films
                .iter()
                .filter(|(at, _)| slot.is_none_or(|slot| slot == *at))
            {
                map.add([id.x, id.y], film, 1e6);
            }
        }
        map
    }

    /// Unlit colour: linear red, green, blue.
    pub fn colours(&mut self) -> [Map; 3] {
        let mut maps = [(); 3].map(|()| Map::new(self.size_mm, self.cell_mm));
        if let Some(banded) = banded(self.offline.painting_mut(), CANVAS) {
            let mut bakery = Bakery::default();
            for (id, tile) in (0..banded.bands()).flat_map(|band| banded.tiles(band)) {
                let shown = banded.shown(id, tile, &mut bakery);
                for (map, plane) in maps.iter_mut().zip(&shown.rgb) {
                    map.add([id.x, id.y], plane, 1.0);
                }
            }
        }
        maps
    }

    /// Height of tooth and dry relief, µm.
    pub fn ground(&mut self) -> Map {
        let painting = self.offline.painting_mut();
        painting.commit();
        let mut map = Map::new(self.size_mm, self.cell_mm);
        if let (Some(store), Some(bare)) = (painting.store(CANVAS), painting.bare(CANVAS)) {
            for (id, version) in store.iter() {
                map.add([id.x, id.y], &bare.relief.tile(id), 1e6);
                let dry = version.tile.as_ref().and_then(|tile| tile.dry().cloned());
                if let Some(dry) = dry {
                    map.add([id.x, id.y], &dry.height(), 1e6 * QUANTUM_M as f32);
                }
            }
        }
        map
    }
}
