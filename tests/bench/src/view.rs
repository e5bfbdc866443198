//! Frames of the whole desk without a window: a changed tile lit and laid, the brush with its shadows.

use std::time::Instant;

use maulstick_appearance::display::DisplayTile;
use maulstick_appearance::lamp::lamp_over;
use maulstick_appearance::picture::Export;
use maulstick_brush::desk::Desk;
use maulstick_brush::palette_place::Side;
use maulstick_brush::{BrushFile, BrushModel, Head};
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_client::frames::tile_planner::AtlasState;
use maulstick_client::frames::tiles::TileRect;
use maulstick_client::frames::{Shown, ShownTile, texels};
use maulstick_num::geometry::Rigid;
use maulstick_painting::PaintingSetup;
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::paint::TILE;
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_ui::app::rack;
use maulstick_ui::render::backdrop::Backdrop;
use maulstick_ui::render::brush::renderer::{Below, BrushRenderer};
use maulstick_ui::render::offscreen::Offscreen;
use maulstick_ui::render::show_surface::Place;
use maulstick_ui::render::surface::{Passes, SurfaceView};
use maulstick_ui::rig::brushes::BrushPose;
use maulstick_ui::view::camera::{View, level};

use crate::report::{Report, quantile, sorted};

/// Pixels of the view and cells of the canvas, either way.
const PIXELS: [u32; 2] = [1920, 1080];
const CELLS: u32 = 2048;
/// Frames that are measured, after as many that are not.
const FRAMES: u32 = 150;
const BRUSH: &str = "flat";

fn fault(error: impl ToString) -> UserError {
    UserError::failure(error.to_string())
}

/// A tile of paint with relief; another at each turn.
fn tile(x: u32, y: u32, turn: u32) -> Option<ShownTile> {
    let plane = |seed: usize| -> Vec<f32> {
        let value = |i: usize| ((i * 31 + seed + turn as usize) % 97) as f32 / 97.0;
        (0..TILE_CELLS).map(value).collect()
    };
    let tile = DisplayTile {
        rgb: [plane(0), plane(13), plane(29)],
        gloss: vec![0.7; TILE_CELLS],
        wetness: vec![1.0; TILE_CELLS],
        height: plane(5).iter().map(|height| 1e-4 * height).collect(),
    };
    let (colour, height) = texels(&tile.to_bytes())?;
    Some(ShownTile {
        x,
        y,
        colour,
        height,
    })
}

/// A surface in the window's form, at the level of the view.
struct Sheet {
    surface: Surface,
    view: SurfaceView,
    level: u32,
}

impl Sheet {
    fn new(scene: &Scene, id: u32, view: &View) -> Result<Self, UserError> {
        let surface = scene.surfaces.iter().find(|surface| surface.id == id);
        let surface = surface
            .ok_or_else(|| fault("a surface is missing"))?
            .clone();
        let [across, _] = Place::pixels(&surface, view, 1.0);
        Ok(Self {
            level: level(surface.cells[0], across),
            surface,
            view: SurfaceView::default(),
        })
    }

    fn cells(&self) -> [u32; 2] {
        self.surface
            .cells
            .map(|cells| cells.div_ceil(1 << self.level))
    }

    fn grid(&self) -> [u32; 2] {
        self.cells().map(|cells| cells.div_ceil(TILE as u32))
    }

    fn shown(&self, tiles: Vec<ShownTile>) -> Shown {
        let room = self.grid();
        Shown {
            atlas: AtlasState {
                number: 1,
                level: self.level,
                room,
                held: TileRect::up_to(room),
                wet: false,
            },
            cells: self.cells(),
            tiles,
            ..Shown::default()
        }
    }

    fn whole(&self) -> Shown {
        let [across, up] = self.grid();
        let places = (0..up).flat_map(|y| (0..across).map(move |x| (x, y)));
        self.shown(places.filter_map(|(x, y)| tile(x, y, 0)).collect())
    }
}

/// The whole desk in a window.
fn view_of(picture: &Offscreen, scene: &Scene) -> Option<View> {
    let [canvas, palette] = [0, 1].map(|place| scene.surfaces.get(place));
    View::of(picture.area(), canvas?, palette, Side::Left, rack::WIDTH)
}

/// The surfaces, whole.
fn sheets(
    picture: &Offscreen,
    passes: &Passes,
    scene: &Scene,
    view: &View,
) -> Result<[Sheet; 2], UserError> {
    let mut sheets = [
        Sheet::new(scene, CANVAS, view)?,
        Sheet::new(scene, PALETTE, view)?,
    ];
    for sheet in &mut sheets {
        let whole = sheet.whole();
        sheet.view.update(picture.gpu(), passes, &whole);
    }
    Ok(sheets)
}

/// The pen in a frame, drawn along the canvas.
fn sample(frame: u32) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [1e-4 * f64::from(frame), 0.02, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure: 0.4,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// The brush in a frame, once it is over a surface.
fn held<'a>(
    model: &mut BrushModel,
    file: &'a BrushFile,
    desk: &Desk,
    frame: u32,
) -> Option<BrushPose<'a>> {
    let pen = Origin {
        source: 1,
        epoch: 1,
    };
    let now_ns = 1_000_000_000 + u64::from(frame) * 10_000_000;
    let state = model.state(pen, u64::from(frame), now_ns, &sample(frame))?;
    let solve = state.solves.last()?;
    Some(BrushPose {
        name: BRUSH,
        file,
        plane: *desk.plane(solve.surface)?,
        brush: Rigid::from(&solve.pose),
        angles: solve.angles_rad.clone(),
        wetness: 0.5,
        coat: None,
    })
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let mut picture = Offscreen::new(PIXELS).map_err(fault)?;
    report.on(picture.adapter());
    let setup = PaintingSetup {
        cells: [CELLS; 2],
        ..PaintingSetup::default()
    };
    let (scene, export) = (setup.scene(), Export::default());
    let view = view_of(&picture, &scene).ok_or_else(|| fault("no surface"))?;
    let desk = Desk::of(&scene);
    let (passes, mut backdrop, mut brushes) = {
        let gpu = picture.gpu();
        let passes = Passes::new(gpu, &export);
        (passes, Backdrop::new(gpu), BrushRenderer::new(gpu, &export))
    };
    let mut sheets = sheets(&picture, &passes, &scene, &view)?;
    let file = BrushFile::library(BRUSH).map_err(fault)?;
    let head = Head::of(&file);
    let mut model = BrushModel::new(file.clone(), 0.5);
    model.set_scene(&scene);
    let mut times = Vec::new();
    for frame in 0..2 * FRAMES {
        let begun = Instant::now();
        let gpu = picture.gpu();
        let [across, up] = sheets[0].grid();
        let changed = tile(frame % across, frame / across % up, frame);
        let changed = sheets[0].shown(changed.into_iter().collect());
        sheets[0].view.update(gpu, &passes, &changed);
        let mut laid = Vec::new();
        for sheet in &mut sheets {
            let lamp = lamp_over(&scene, sheet.surface.id);
            let surface = &sheet.surface;
            sheet.view.light(gpu, &passes, &lamp, surface.cell_m);
            laid.extend(sheet.view.lay(gpu, &passes, surface, &view, 1.0));
        }
        backdrop.update(gpu, &passes, PIXELS, &laid);
        let mut shapes: Vec<_> = backdrop.shape(&view).into_iter().collect();
        if let Some(held) = held(&mut model, &file, &desk, frame) {
            let below = Below {
                view: &view,
                pixels_per_point: 1.0,
                desk: &desk,
                pixels: backdrop.pixels(),
            };
            let lamp = lamp_over(&scene, held.plane.id);
            shapes.extend(brushes.shapes(gpu, &held, &head, &lamp, &below));
        }
        picture.draw(shapes).map_err(fault)?;
        if frame >= FRAMES {
            times.push(begun.elapsed().as_secs_f64() * 1e3);
        }
    }
    let times = sorted(times);
    report.row("frame.p50", quantile(&times, 0.5), "ms");
    report.row("frame.p95", quantile(&times, 0.95), "ms");
    Ok(())
}
