//! A surface that is panned and zoomed looks as one whole atlas would show it.

use eframe::egui::{Rect, pos2, vec2};
use glam::{DVec2, DVec3};
use maulstick_appearance::display::DisplayTile;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_num::geometry::rotation;
use maulstick_optics::light::shadow::REACH;
use maulstick_types::FrameView;
use maulstick_types::paint::TILE;

use maulstick_client::frames::tile_planner::{Asked, AtlasState, TilePlanner};
use maulstick_client::frames::tiles::{TileRect, Wanted};
use maulstick_client::frames::{ShownTile, texels};

use super::tests::{lamp, surface as small};
use super::*;
use crate::render::gpu::testing::{draw, gpu, read, target};
use crate::view::visible_tiles::{cells_of, wanted_by};

const CELLS: [u32; 2] = [2100, 1700];
const VIEW: [u32; 2] = [240, 180];

/// Ridges that run over all, and colours that grow, at a level.
fn tile(level: u32, x: u32, y: u32) -> ShownTile {
    let side = f64::from(1u32 << level);
    let place = |i: usize| {
        let at = [x as usize * TILE + i % TILE, y as usize * TILE + i / TILE];
        at.map(|cell| (cell as f64 + 0.5) * side)
    };
    let plane = |f: &dyn Fn([f64; 2]) -> f64| -> Vec<f32> {
        (0..TILE_CELLS).map(|i| f(place(i)) as f32).collect()
    };
    let wave = |v: f64| (v - v.floor() - 0.5).abs();
    let tile = DisplayTile {
        rgb: [
            plane(&|[x, _]| 0.2 + 0.5 * x / 2100.0),
            plane(&|[_, y]| 0.2 + 0.5 * y / 1700.0),
            plane(&|[x, y]| 0.3 + 0.3 * wave((x + 2.0 * y) / 90.0)),
        ],
        gloss: vec![0.8; TILE_CELLS],
        wetness: vec![1.0; TILE_CELLS],
        height: plane(&|[x, y]| 6e-4 * wave((x - y) / 60.0)),
    };
    let (colour, height) = texels(&tile.to_bytes()).expect("whole");
    ShownTile {
        x,
        y,
        colour,
        height,
    }
}

fn surface() -> Surface {
    let mut surface = small();
    surface.cells = CELLS;
    let half = CELLS.map(|cells| -0.5 * f64::from(cells) * surface.cell_m);
    surface.pose.position_m = [half[0], half[1], 0.0];
    surface
}

/// A view of `scale` pixels a cell around a cell.
fn look(surface: &Surface, scale: f64, around: [f64; 2]) -> View {
    let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(VIEW[0] as f32, VIEW[1] as f32));
    let off = [0, 1].map(|i| (around[i] - 0.5 * f64::from(CELLS[i])) * surface.cell_m);
    View {
        middle: DVec2::from(off),
        scale: scale / surface.cell_m,
        ..View::fit(area, std::slice::from_ref(surface)).expect("a view")
    }
}

struct Easel {
    gpu: Gpu,
    passes: Passes,
    surface: Surface,
}

/// A view of a paint node that answers at once.
#[derive(Default)]
struct Puller {
    plan: TilePlanner,
    view: SurfaceView,
}

impl Puller {
    /// A question and its answer.
    fn turn(&mut self, easel: &Easel, wanted: &Wanted, fault: impl Fn(&mut ShownTile)) -> Asked {
        let asked = self.plan.next(wanted);
        let cells = CELLS.map(|cells| cells.div_ceil(1 << asked.level));
        let reply = FrameView {
            surface: 0,
            epoch: 1,
            version: 1,
            level: asked.level,
            cells,
            journal: 0,
            holds: Vec::new(),
            more: false,
            tiles: Vec::new(),
            look: 1,
        };
        let mut tiles = Vec::new();
        if asked.since == 0 {
            let TileRect { from, to } = asked.tiles;
            let all = (from[1]..to[1]).flat_map(|y| (from[0]..to[0]).map(move |x| (x, y)));
            tiles.extend(all.map(|(x, y)| tile(asked.level, x, y)));
            tiles.iter_mut().for_each(fault);
        }
        if self.plan.take(&asked, &reply) {
            let shown = Shown {
                part: asked.part,
                atlas: self.plan.atlas(asked.part),
                cells,
                tiles,
                ..Shown::default()
            };
            self.view.update(&easel.gpu, &easel.passes, &shown);
        }
        asked
    }

    fn settle(&mut self, easel: &Easel, look: &View) {
        let wanted = wanted_by(&easel.surface, look, 1.0);
        while !self.turn(easel, &wanted, |_| {}).waits {}
    }
}

impl Easel {
    fn new() -> Self {
        let gpu = gpu();
        Self {
            passes: Passes::new(&gpu, &Export::default()),
            surface: surface(),
            gpu,
        }
    }

    /// Draws a window, and returns its pixels.
    fn drawn(&self, view: &mut SurfaceView, look: &View) -> Vec<u8> {
        view.light(&self.gpu, &self.passes, &lamp(), self.surface.cell_m);
        let target = target(&self.gpu, VIEW);
        let laid = view.lay(&self.gpu, &self.passes, &self.surface, look, 1.0);
        let bound = laid.expect("a picture").bound;
        draw(&self.gpu, &target, wgpu::Color::RED, |pass| {
            self.passes.show.fill(pass, &bound);
            self.passes.show.lay(pass, &bound);
        });
        read(&self.gpu, &target)
    }

    /// One sheet of the whole surface at a level.
    fn sheet(&self, level: u32) -> SurfaceView {
        let cells = CELLS.map(|cells| cells.div_ceil(1 << level));
        let room = cells.map(|cells| cells.div_ceil(TILE as u32));
        let all = (0..room[1]).flat_map(|y| (0..room[0]).map(move |x| tile(level, x, y)));
        let shown = Shown {
            atlas: AtlasState {
                number: 1,
                level,
                room,
                held: TileRect::up_to(room),
                wet: false,
            },
            cells,
            tiles: all.collect(),
            ..Shown::default()
        };
        let mut view = SurfaceView::default();
        view.update(&self.gpu, &self.passes, &shown);
        view
    }
}

fn farthest(one: &[u8], other: &[u8]) -> u8 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| a.abs_diff(*b)).max().expect("pixels")
}

#[test]
fn a_view_that_is_panned_zoomed_and_turned_shows_the_pixels_of_a_whole_sheet() {
    let mut easel = Easel::new();
    let mut puller = Puller::default();
    let (mut moved, mut sheets) = (0, std::collections::BTreeMap::new());
    for (scale, around, turn) in [
        (1.0, [1000.0, 800.0], 0.0),
        (1.0, [1090.5, 800.0], 0.0),
        (1.0, [1250.0, 930.25], 0.0),
        (1.0, [900.0, 700.0], 0.0),
        (2.7, [900.0, 720.0], 0.0),
        // Beyond the surface's corners.
        (1.0, [2050.0, 1650.0], 0.0),
        (1.0, [60.0, 40.0], 0.0),
        (0.55, [300.0, 400.0], 0.0),
        (0.55, [300.0, 400.0], 0.6),
        (0.4, [700.0, 800.0], 0.6),
        (0.2, [1000.0, 800.0], 0.0),
        (1.0, [1000.0, 800.0], 0.0),
    ] {
        easel.surface = surface();
        let pose = rotation(DVec3::Z, turn);
        easel.surface.pose.position_m =
            (pose * DVec3::from(easel.surface.pose.position_m)).to_array();
        easel.surface.pose.orientation = pose.to_array();
        let look = look(&easel.surface, scale, around);
        puller.settle(&easel, &look);
        let AtlasState {
            level, held, room, ..
        } = puller.plan.atlas(Part::Detail);
        moved += u32::from((0..2).any(|i| held.to[i] > room[i]));
        let shown = easel.drawn(&mut puller.view, &look);
        let sheet = sheets.entry(level).or_insert_with(|| easel.sheet(level));
        let whole = easel.drawn(sheet, &look);
        let off = farthest(&shown, &whole);
        assert!(off <= 1, "{scale} {around:?} {turn}: {off} of 255");
        // A tile that did not come.
        let mut broken = Puller::default();
        let wanted = wanted_by(&easel.surface, &look, 1.0);
        for _ in 0..4 {
            broken.turn(&easel, &wanted, |tile| tile.colour.rotate_right(16));
        }
        let fault = easel.drawn(&mut broken.view, &look);
        assert!(farthest(&fault, &whole) > 1, "a fault would pass");
    }
    assert!(moved > 4, "the torus is gone round");
    assert_eq!(sheets.len(), 3);
}

#[test]
fn what_has_not_come_yet_is_shown_coarse_without_a_hole_or_a_seam() {
    let easel = Easel::new();
    let mut puller = Puller::default();
    let before = look(&easel.surface, 1.0, [1000.0, 800.0]);
    puller.settle(&easel, &before);
    // Farther than the margin, so that a part of the view has no detail.
    let after = look(&easel.surface, 1.0, [1160.0, 880.0]);
    let fine = easel.drawn(&mut easel.sheet(0), &after);
    let shown = easel.drawn(&mut puller.view, &after);
    let held = cells_of(&puller.plan.atlas(Part::Detail).held, CELLS);
    let edge = |i: usize| (held.from[i] + held.size[i] - (REACH + 1)) as f32;
    let origin = [1160.0 - 120.0, 880.0 + 90.0];
    let (right, top) = (edge(0) - origin[0], origin[1] - edge(1));
    assert!(right < 200.0 && top > 10.0, "{right} {top}: both are seen");
    let (mut inside, mut outside, mut coarse) = (0, 0, 0);
    for (i, (a, b)) in shown.chunks_exact(4).zip(fine.chunks_exact(4)).enumerate() {
        let (x, y) = ((i as u32 % VIEW[0]) as f32, (i as u32 / VIEW[0]) as f32);
        let off = (0..3).map(|c| a[c].abs_diff(b[c])).max().expect("three");
        if x + 1.0 < right && y > top {
            inside = inside.max(off);
        } else {
            outside = outside.max(off);
            coarse += usize::from(off > 1);
        }
    }
    println!("{inside} within the detail, {outside} beyond it, {coarse} pixels");
    assert!(inside <= 1, "{inside}: light changes at the edge");
    // A base of four cells a texel has softer ridges; the desk would be another colour altogether.
    assert!(outside < 60, "{outside}");
    assert!(coarse > 500, "the detail covers all");
    // With the strips it is whole.
    let wanted = wanted_by(&easel.surface, &after, 1.0);
    while !puller.turn(&easel, &wanted, |_| {}).waits {}
    assert!(farthest(&easel.drawn(&mut puller.view, &after), &fine) <= 1);
    assert!(farthest(&shown, &fine) > 1, "a fault would pass");
}

#[test]
fn textures_are_bounded_by_the_window() {
    let easel = Easel::new();
    let mut large = surface();
    large.cells = [4096; 2];
    let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(1280.0, 720.0));
    let fit = View::fit(area, std::slice::from_ref(&large)).expect("a view");
    let (mut view, mut most, mut whole) = (SurfaceView::default(), 0, 0);
    for (number, scale) in (1..).zip([0.16, 0.26, 0.49, 0.51, 0.99, 1.0, 4.0]) {
        let look = View {
            scale: scale / large.cell_m,
            ..fit
        };
        let wanted = wanted_by(&large, &look, 1.0);
        let atlases = [
            (Part::Base, wanted.base, wanted.base_tiles),
            (Part::Detail, Some(wanted.level), wanted.room),
        ];
        for (part, level, room) in atlases {
            let Some(level) = level else { continue };
            let shown = Shown {
                part,
                atlas: AtlasState {
                    number,
                    level,
                    room,
                    held: TileRect::up_to([1, 1]),
                    wet: false,
                },
                cells: large.cells.map(|cells| cells >> level),
                ..Shown::default()
            };
            view.update(&easel.gpu, &easel.passes, &shown);
        }
        most = most.max(view.bytes());
        whole = whole.max(
            20 * large
                .cells
                .map(|cells| u64::from(cells >> wanted.level))
                .iter()
                .product::<u64>(),
        );
    }
    println!("{most} bytes of textures, {whole} as one sheet");
    assert!(most <= 100_000_000, "{most} bytes");
    assert!(whole > 300_000_000, "a whole sheet would pass: {whole}");
}
