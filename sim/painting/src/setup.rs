//! The scene of a new painting.

use maulstick_appearance::ground::check_ground;
use maulstick_appearance::light::studio_settings;
use maulstick_brush::palette_place::{Side, beside};
use maulstick_canvas::assets::{Assets, IMAGE};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::relief::tooth_picture::PictureTooth;
use maulstick_models::{MODELS, model_called};
use maulstick_optics::PaintLibrary;
use maulstick_types::limits::CELLS_MAX;
use maulstick_types::scene::{CANVAS, Light, PALETTE, Scene, Surface, Well, WellKind};
use maulstick_types::values::CellSide;
use maulstick_types::{Mixture, Pose};

use crate::error::{EditError, SurfaceError};

/// Paints in the wells of a new palette.
pub const PALETTE_PAINTS: [&str; 10] = [
    "Titanium White",
    "Hansa Yellow Opaque",
    "Cadmium Orange",
    "Pyrrole Red",
    "Quinacridone Magenta",
    "Ultramarine Blue",
    "Phthalo Green Blue Shade",
    "Yellow Ochre",
    "Burnt Sienna",
    "Bone Black",
];

/// Size of the palette, across and up, m.
const PALETTE_M: [f64; 2] = [0.128, 0.256];
/// Radius of its wells, m.
const WELL_RADIUS_M: f64 = 9e-3;

/// Settings of a new painting.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintingSetup {
    /// Cells of the canvas, across and up.
    pub cells: [u32; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Name of the ground: one of [`GROUNDS`](maulstick_appearance::ground::GROUNDS), or `image:` or `spectrum:` and the
    /// hash of a file.
    pub ground: String,
    /// Name of the tooth: one of [`Tooth::names`], or a picture's
    /// ([`ToothName`](maulstick_canvas::relief::tooth_picture::ToothName)).
    pub tooth: String,
    /// Seed of the tooth.
    pub tooth_seed: u64,
    /// Thickness of paint that stays on the canvas however hard it is brushed, m.
    pub stain_m: f64,
    /// True if paint on the palette lasts, however much of it brushes take up.
    pub piles_last: bool,
    /// Mixtures of the palette's wells, from the top.
    pub wells: Vec<Mixture>,
    /// The light.
    pub light: Light,
    /// Exposure factor; `None` for the one at which the bare canvas does not clip.
    pub exposure: Option<f64>,
    /// Name of the canvas's paint model, one of [`MODELS`].
    pub model: String,
    /// The palette's.
    pub palette_model: String,
    /// The pictures that its ground and its tooth may be made of.
    pub embedded: Assets,
}

impl Default for PaintingSetup {
    fn default() -> Self {
        Self {
            cells: [1024, 1024],
            cell_m: 2.5e-4,
            ground: "gesso".to_owned(),
            tooth: "linen".to_owned(),
            tooth_seed: 1,
            stain_m: maulstick_types::scene::default_stain_m(),
            piles_last: false,
            wells: PALETTE_PAINTS
                .iter()
                .map(|name| Mixture::pure(name))
                .collect(),
            light: Light::default(),
            exposure: None,
            model: MODELS[0].name.to_owned(),
            palette_model: MODELS[0].name.to_owned(),
            embedded: Assets::default(),
        }
    }
}

impl PaintingSetup {
    /// Checks sizes, the names of models, ground and tooth, and the wells' paints.
    ///
    /// # Errors
    /// [`EditError`] with what to do.
    pub fn check(&self, library: &PaintLibrary) -> Result<(), EditError> {
        check_size(self.cells, self.cell_m)?;
        model_called(&self.model)?;
        model_called(&self.palette_model)?;
        check_ground(&self.ground, &self.embedded)?;
        relief_called(&self.tooth, self.tooth_seed, self.cell_m, &self.embedded)?;
        studio_settings(&self.light)?;
        for mixture in &self.wells {
            library.check(mixture)?;
        }
        Ok(())
    }

    /// The scene: the canvas in the middle of the desk, the palette to its left.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let size = self.cells.map(|cells| f64::from(cells) * self.cell_m);
        let at = |x: f64, y: f64| Pose {
            position_m: [x, y, 0.0],
            ..Pose::IDENTITY
        };
        let surface = |id: u32, pose: Pose, cells: [u32; 2]| Surface {
            id,
            pose,
            zoom: 1.0,
            cells,
            cell_m: self.cell_m,
            ground: self.ground.clone(),
            tooth: self.tooth.clone(),
            tooth_seed: self.tooth_seed,
            wells: Vec::new(),
            stain_m: self.stain_m,
            piles_last: false,
            model: self.model.clone(),
        };
        let canvas = surface(CANVAS, at(-0.5 * size[0], -0.5 * size[1]), self.cells);
        let cells = palette_cells(self.cell_m);
        let mut board = surface(PALETTE, Pose::IDENTITY, cells);
        board.pose = beside(&canvas, &board, Side::Left);
        board.ground = "grey".to_owned();
        board.tooth = "panel".to_owned();
        board.model.clone_from(&self.palette_model);
        board.piles_last = self.piles_last;
        board.wells = wells_of(&self.wells, cells, self.cell_m);
        Scene {
            version: 1,
            surfaces: vec![canvas, board],
            paints: Vec::new(),
            tunings: Vec::new(),
            light: Light {
                exposure: self.exposure.unwrap_or(1.0),
                ..self.light.clone()
            },
            layers: Vec::new(),
            versions: Vec::new(),
            handlings: Vec::new(),
            sets: Vec::new(),
        }
    }
}

/// Cells of a new palette, across and up.
fn palette_cells(cell_m: f64) -> [u32; 2] {
    PALETTE_M.map(|side| (side / cell_m).round().max(1.0) as u32)
}

/// Wells with these mixtures for a palette of `cells`, across and up, from the top: along its right edge, toward the
/// canvas, smaller for many, so that they are within reach while the rest of the palette is not. The cleaner is beside
/// the lowest, the medium above it.
#[must_use]
pub fn wells_of(mixtures: &[Mixture], cells: [u32; 2], cell_m: f64) -> Vec<Well> {
    let [width, height] = cells.map(f64::from);
    let count = mixtures.len().max(1) as f64;
    let large = (WELL_RADIUS_M / cell_m).min(0.3 * width.min(height));
    let [cleaner_m, radius_m] = [large, large.min(0.45 * height / count)].map(|r| r * cell_m);
    let paints = mixtures.iter().enumerate().map(|(i, mixture)| Well {
        center_m: [
            width * cell_m - 1.5 * radius_m,
            height * (1.0 - (i as f64 + 0.5) / count) * cell_m,
        ],
        radius_m,
        kind: WellKind::Paint {
            mixture: mixture.clone(),
        },
    });
    let cleaner = Well {
        center_m: [width * cell_m - 4.0 * cleaner_m, 1.5 * cleaner_m],
        radius_m: cleaner_m,
        kind: WellKind::Cleaner,
    };
    let medium = Well {
        center_m: [cleaner.center_m[0], 4.25 * cleaner_m],
        radius_m: cleaner_m,
        kind: WellKind::Medium,
    };
    paints.chain([cleaner, medium]).collect()
}

/// Checks the size of a surface and of its cells.
///
/// # Errors
/// [`SurfaceError`] with what is possible.
pub(crate) fn check_size(cells: [u32; 2], cell_m: f64) -> Result<(), SurfaceError> {
    if cells.iter().any(|cells| !(1..=CELLS_MAX).contains(cells)) {
        return Err(SurfaceError::Cells(cells));
    }
    if CellSide::stored_range().contains(&cell_m) {
        Ok(())
    } else {
        Err(SurfaceError::CellSize(cell_m * 1e3))
    }
}

/// The relief of a tooth called `name` on cells of `cell_m`.
///
/// # Errors
/// [`EditError`] with the names that there are.
pub fn relief_called(
    name: &str,
    seed: u64,
    cell_m: f64,
    embedded: &Assets,
) -> Result<Relief, EditError> {
    if name.starts_with(IMAGE) {
        let tooth = PictureTooth::called(name, cell_m, embedded)?;
        return Ok(Relief::pictured(tooth, cell_m));
    }
    let tooth = Tooth::new(name, seed, cell_m).ok_or_else(|| SurfaceError::NoTooth {
        name: name.to_owned(),
        known: Tooth::names().collect(),
    })?;
    Ok(Relief::new(tooth, cell_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canvas_and_palette_do_not_overlap_and_wells_lie_on_the_palette() {
        let setup = PaintingSetup::default();
        let scene = setup.scene();
        let [canvas, palette] = &scene.surfaces[..] else {
            panic!("two surfaces")
        };
        let right = palette.pose.position_m[0] + f64::from(palette.cells[0]) * palette.cell_m;
        assert!(right < canvas.pose.position_m[0]);
        assert_eq!(palette.wells.len(), 12);
        for well in &palette.wells {
            for i in 0..2 {
                let size = f64::from(palette.cells[i]) * palette.cell_m;
                assert!(
                    well.center_m[i] > well.radius_m && well.center_m[i] < size - well.radius_m
                );
            }
        }
    }

    #[test]
    fn palette_and_wells_keep_their_size_whatever_the_cells() {
        let board = |cell_m: f64| {
            let setup = PaintingSetup {
                cells: [0.256, 0.256].map(|side| (side / cell_m) as u32),
                cell_m,
                ..PaintingSetup::default()
            };
            setup.scene().surfaces[1].clone()
        };
        let lengths = |board: &Surface| {
            let size = board.cells.map(|cells| f64::from(cells) * board.cell_m);
            let wells = board
                .wells
                .iter()
                .flat_map(|well| [well.center_m[0], well.center_m[1], well.radius_m]);
            let place = board.pose.position_m;
            wells.chain(size).chain(place).collect::<Vec<f64>>()
        };
        let reference = board(2.5e-4);
        assert_eq!(reference.cells, [512, 1024]);
        for cell_m in [1.25e-4, 6.25e-5, 1e-3] {
            let other = lengths(&board(cell_m));
            for (a, b) in lengths(&reference).iter().zip(&other) {
                assert!((a - b).abs() < 1e-9, "{cell_m} m: {a} {b}");
            }
        }
        // On coarse cells it is as near as these allow, and never empty.
        assert_eq!(board(1e-2).cells, [13, 26]);
    }

    #[test]
    fn many_wells_are_smaller_and_do_not_touch() {
        let whole = palette_cells(2.5e-4);
        for (count, cells) in [(1, whole), (12, whole), (40, [200, 900])] {
            let mixtures = vec![Mixture::pure("Bone Black"); count];
            let wells = wells_of(&mixtures, cells, 2.5e-4);
            assert_eq!(wells.len(), count + 2);
            for pair in wells[..count].windows(2) {
                let apart = pair[0].center_m[1] - pair[1].center_m[1];
                assert!(apart > 2.0 * pair[0].radius_m, "{count} wells overlap");
            }
            let jars = &wells[count..];
            for (at, jar) in jars.iter().enumerate() {
                for other in wells.iter().take(count + at) {
                    let [x, y] = [0, 1].map(|i| jar.center_m[i] - other.center_m[i]);
                    let apart = (x * x + y * y).sqrt() - jar.radius_m - other.radius_m;
                    assert!(apart > 0.0, "{count} wells: {jar:?} {other:?}");
                }
            }
            for well in &wells {
                let inside = |i: usize| {
                    let size = f64::from(cells[i]) * 2.5e-4;
                    well.center_m[i] >= well.radius_m && well.center_m[i] <= size - well.radius_m
                };
                assert!(inside(0) && inside(1), "{count} wells: {well:?}");
            }
        }
    }

    #[test]
    fn a_bad_setup_says_what_to_do() {
        let library = PaintLibrary::measured().expect("whole");
        let check = |change: fn(&mut PaintingSetup)| {
            let mut setup = PaintingSetup::default();
            change(&mut setup);
            setup.check(&library)
        };
        assert_eq!(check(|_| {}), Ok(()));
        assert!(check(|s| s.cells = [0, 10]).is_err());
        assert!(check(|s| s.cell_m = f64::NAN).is_err());
        let error = check(|s| s.ground = "gesoo".into()).expect_err("unknown");
        assert!(error.advice().to_string().contains("gesso"));
        let error = check(|s| s.model = "makrer".into()).expect_err("unknown");
        assert!(error.advice().to_string().contains("marker"));
        assert!(check(|s| s.palette_model = String::new()).is_err());
        let error = check(|s| s.tooth = "line".into()).expect_err("unknown");
        assert!(error.advice().to_string().contains("linen"));
        assert!(check(|s| s.wells = vec![Mixture::pure("Blue")]).is_err());
        let error = check(|s| s.ground = "image:00".into()).expect_err("no hash");
        assert!(error.advice().to_string().contains("SHA-256"));
        let error = check(|s| s.tooth = "image:00".into()).expect_err("no size");
        assert!(error.advice().to_string().contains("80um"));
    }
}
