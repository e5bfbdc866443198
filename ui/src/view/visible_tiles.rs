//! Tiles of a surface that are in view.

use eframe::egui::Pos2;
use maulstick_brush::palette_place::size_m;
use maulstick_client::frames::tiles::{TileRect, Wanted};
use maulstick_types::paint::TILE;
use maulstick_types::scene::Surface;

use crate::render::light_surface::CellRect;
use crate::view::camera::{View, corners, level};

/// Tiles beyond the visible ones, each way: a pan finds them loaded.
const MARGIN: u32 = 1;
/// Largest number of cells of an atlas per pixel, each way.
const CELLS_A_PIXEL: f32 = 2.0;
/// The cells that a view takes grow until the next coarser level takes over; the device may lack room for them.
const GROWTHS: [f32; 3] = [f32::INFINITY, 1.2, 1.0];
/// Cells of the longer side of a base, at most.
const BASE_CELLS: u32 = 512;

/// Cells of tiles, on a surface of `cells`.
#[must_use]
pub fn cells_of(tiles: &TileRect, cells: [u32; 2]) -> CellRect {
    let side = TILE as u32;
    let at = |tile: u32, i: usize| tile.saturating_mul(side).min(cells[i]);
    CellRect {
        from: [0, 1].map(|i| at(tiles.from[i], i)),
        size: [0, 1].map(|i| at(tiles.to[i], i).saturating_sub(at(tiles.from[i], i))),
    }
}

/// Tiles of a surface of `cells` at a level.
fn grid(cells: [u32; 2], level: u32) -> [u32; 2] {
    let tiles = cells.map(|cells| cells.div_ceil(TILE as u32).max(1));
    tiles.map(|tiles| tiles.div_ceil(1 << level.min(31)).max(1))
}

/// The level at which one tile shows all of a surface.
fn coarsest(cells: [u32; 2]) -> u32 {
    let [across, up] = grid(cells, 0);
    across.max(up).next_power_of_two().trailing_zeros()
}

/// The part of a surface that is in a view.
struct Part {
    /// In shares of its sides, from the lower left corner: least and greatest.
    shares: [[f32; 2]; 2],
    /// Share of each side that a view takes.
    reach: [f32; 2],
    /// Pixels of its sides.
    pixels: [f32; 2],
}

impl Part {
    /// `None` if the surface is seen from its edge.
    fn of(surface: &Surface, view: &View, pixels_per_point: f32) -> Option<Self> {
        let at: [Pos2; 4] = corners(surface).map(|corner| view.to_window(corner));
        // A raised board looks larger.
        let side = |from: usize, to: usize| (at[to] - at[from]).length() * pixels_per_point;
        let pixels = [side(0, 1).max(side(2, 3)), side(0, 2).max(side(1, 3))];
        let size = size_m(surface) * surface.zoom;
        let shares = |at: Pos2| {
            let own = view.on_plane(at, surface)?.truncate() / size;
            own.is_finite()
                .then(|| own.to_array().map(|share| share as f32))
        };
        let seen = view.area;
        let ends = [
            seen.left_top(),
            seen.right_top(),
            seen.left_bottom(),
            seen.right_bottom(),
        ];
        let ends = ends.into_iter().map(shares).collect::<Option<Vec<_>>>()?;
        let least = [0, 1].map(|i| ends.iter().map(|e| e[i]).fold(f32::INFINITY, f32::min));
        let most = [0, 1].map(|i| ends.iter().map(|e| e[i]).fold(f32::NEG_INFINITY, f32::max));
        Some(Self {
            shares: [least, most],
            reach: [0, 1].map(|i| most[i] - least[i]),
            pixels,
        })
    }
}

/// Tiles that a view wants of a surface. They take no more cells than twice the pixels of the view each way, and a
/// margin; otherwise the level is a coarser one.
#[must_use]
pub fn wanted_by(surface: &Surface, view: &View, pixels_per_point: f32) -> Wanted {
    let cells = surface.cells;
    let last = coarsest(cells);
    let part = Part::of(surface, view, pixels_per_point);
    let finest = part.as_ref().map_or(last, |part| {
        let levels = [0, 1].map(|i| level(cells[i], part.pixels[i]));
        levels[0].min(levels[1]).min(last)
    });
    let most = view.pixels(pixels_per_point).map(|side| room(side as f32));
    let most = u64::from(most[0]) * u64::from(most[1]);
    let fits = |wanted: &Wanted| u64::from(wanted.room[0]) * u64::from(wanted.room[1]) <= most;
    (finest..=last)
        .flat_map(|level| GROWTHS.map(|growth| wanted_at(cells, level, part.as_ref(), growth)))
        .find(fits)
        .unwrap_or_else(|| Wanted::whole(last, grid(cells, last)))
}

/// With room for what a view takes when it takes `growth` times as many cells, but no more than
/// it may at this level.
fn wanted_at(cells: [u32; 2], level: u32, part: Option<&Part>, growth: f32) -> Wanted {
    let all = grid(cells, level);
    let Some(part) = part else {
        return Wanted::whole(level, all);
    };
    let side = (TILE as u32) << level.min(16);
    let extent = [0, 1].map(|i| cells[i] as f32 / side as f32);
    let density = [0, 1].map(|i| extent[i] * TILE as f32 / part.pixels[i].max(1.0));
    let most = CELLS_A_PIXEL / density[0].max(density[1]).max(1e-6);
    let growth = growth.min(most).max(1.0);
    let room = [0, 1].map(|i| {
        let tiles = part.reach[i] * extent[i] * growth;
        room(tiles * TILE as f32 / CELLS_A_PIXEL).min(all[i])
    });
    if (0..2).all(|i| all[i] <= room[i]) {
        return Wanted::whole(level, all);
    }
    let visible = TileRect {
        from: [0, 1].map(|i| (part.shares[0][i] * extent[i]).floor().max(0.0) as u32),
        to: [0, 1].map(|i| (part.shares[1][i] * extent[i]).ceil().max(0.0) as u32),
    };
    // A surface outside the view keeps its nearest tiles.
    let from = [0, 1].map(|i| visible.from[i].saturating_sub(MARGIN).min(all[i] - 1));
    let tiles = TileRect {
        from,
        to: [0, 1].map(|i| {
            let to = visible.to[i].saturating_add(MARGIN).min(from[i] + room[i]);
            to.clamp(from[i] + 1, all[i])
        }),
    };
    let base = (level..)
        .find(|level| cells.iter().all(|cells| cells >> level <= BASE_CELLS))
        .unwrap_or(level);
    Wanted {
        level,
        tiles,
        room,
        base: Some(base),
        base_tiles: grid(cells, base),
        wet: false,
    }
}

/// Tiles that `pixels` may touch, with margins.
fn room(pixels: f32) -> u32 {
    (pixels * CELLS_A_PIXEL / TILE as f32).ceil() as u32 + 1 + 2 * MARGIN
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, pos2, vec2};
    use glam::{DVec2, DVec3};
    use maulstick_num::geometry::rotation;
    use maulstick_painting::PaintingSetup;
    use maulstick_types::Pose;

    use super::*;

    const VIEW: [f32; 2] = [1280.0, 720.0];

    fn surface(cells: u32) -> Surface {
        let mut surface = PaintingSetup::default().scene().surfaces[0].clone();
        surface.cells = [cells; 2];
        let half = -0.5 * f64::from(cells) * surface.cell_m;
        surface.pose.position_m = [half, half, 0.0];
        surface
    }

    /// A view of `scale` pixels a cell around a cell.
    fn view(surface: &Surface, scale: f64, around: [f64; 2]) -> View {
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(VIEW[0], VIEW[1]));
        let fit = View::fit(area, std::slice::from_ref(surface)).expect("a view");
        View {
            middle: DVec2::from(
                around.map(|cell| (cell - 0.5 * f64::from(surface.cells[0])) * surface.cell_m),
            ),
            scale: scale / surface.cell_m,
            ..fit
        }
    }

    #[test]
    fn parts_of_a_rectangle_hold_each_tile_once() {
        let rect = |from, to| TileRect { from, to };
        let one = rect([2, 3], [9, 8]);
        for other in [
            rect([0, 0], [1, 1]),
            rect([4, 4], [6, 6]),
            rect([0, 0], [5, 5]),
            rect([2, 3], [9, 8]),
            rect([0, 5], [20, 6]),
        ] {
            let parts = one.without(&other);
            for y in 0..10 {
                for x in 0..10 {
                    let tile = rect([x, y], [x + 1, y + 1]);
                    let count = parts.iter().filter(|part| part.holds(&tile)).count();
                    let expected = one.holds(&tile) && !other.holds(&tile);
                    assert_eq!(count, usize::from(expected), "{other:?} {x} {y}");
                }
            }
        }
        assert!(one.holds(&TileRect::NONE) && !TileRect::NONE.holds(&one));
        let cells = cells_of(&rect([1, 0], [3, 2]), [150, 100]);
        assert_eq!((cells.from, cells.size), ([64, 0], [86, 100]));
    }

    #[test]
    fn a_small_surface_is_wanted_whole_and_a_large_one_around_the_view() {
        let small = surface(1024);
        let wanted = wanted_by(&small, &view(&small, 4.0, [100.0, 100.0]), 1.0);
        assert_eq!(wanted, Wanted::whole(0, [16, 16]));
        let large = surface(4096);
        let wanted = wanted_by(&large, &view(&large, 1.0, [2048.0, 2048.0]), 1.0);
        assert_eq!(
            (wanted.level, wanted.base, wanted.base_tiles),
            (0, Some(3), [8, 8])
        );
        // Cells 1408 to 2688 and 1688 to 2408, with a tile more on each side.
        assert_eq!(wanted.tiles.from, [21, 25]);
        assert_eq!(wanted.tiles.to, [43, 39]);
        let fit = wanted_by(&large, &view(&large, 0.17, [2048.0, 2048.0]), 1.0);
        assert_eq!(fit, Wanted::whole(2, [16, 16]));
    }

    #[test]
    fn all_that_is_visible_is_wanted_and_room_is_bounded_by_the_window() {
        let most = 43 * 26;
        for cells in [1024, 4096, 16384] {
            for turn in [0.0, 0.3, 0.785, 1.57, 3.0] {
                for tilt in [0.0, 0.9] {
                    let mut surface = surface(cells);
                    let pose = rotation(DVec3::Z, turn) * rotation(DVec3::X, tilt);
                    surface.pose.orientation = pose.to_array();
                    surface.pose = Pose {
                        position_m: (pose * DVec3::from(surface.pose.position_m)).to_array(),
                        ..surface.pose
                    };
                    for scale in [0.02, 0.26, 0.51, 0.99, 1.0, 3.0, 40.0] {
                        let view = view(&surface, scale, [0.5 * f64::from(cells); 2]);
                        let wanted = wanted_by(&surface, &view, 1.0);
                        let what = format!("{cells} {turn} {tilt} {scale} {wanted:?}");
                        let [across, up] = wanted.room;
                        assert!(across * up <= most, "{what}");
                        let size = wanted.tiles.size();
                        let texel = scale * f64::from(1 << wanted.level);
                        assert!(wanted.level == 0 || texel <= 2.0, "{what}: too coarse");
                        assert!(size[0] <= across && size[1] <= up, "{what}");
                        // Each cell under a pixel, where the pixel is on the surface.
                        for y in 0..=12 {
                            for x in 0..=12 {
                                let at = [x as f32 / 12.0 * VIEW[0], y as f32 / 12.0 * VIEW[1]];
                                let Some(cell) = under(&surface, &view, at) else {
                                    continue;
                                };
                                let side = f64::from(64u32 << wanted.level);
                                let tile = cell.map(|cell| (cell / side) as u32);
                                let tile = TileRect {
                                    from: tile,
                                    to: tile.map(|tile| tile + 1),
                                };
                                assert!(wanted.tiles.holds(&tile), "{what} {at:?} {tile:?}");
                            }
                        }
                    }
                }
            }
        }
    }

    fn under(surface: &Surface, view: &View, at: [f32; 2]) -> Option<[f64; 2]> {
        let desk = view.to_desk(pos2(at[0], at[1]), std::slice::from_ref(surface));
        let local = maulstick_num::geometry::Rigid::from(&surface.pose)
            .inverse()
            .point(desk);
        let cell = [local.x, local.y].map(|m| m / (surface.cell_m * surface.zoom));
        let inside = (0..2).all(|i| (0.0..f64::from(surface.cells[i])).contains(&cell[i]));
        inside.then_some(cell)
    }

    #[test]
    fn a_surface_beside_the_view_or_seen_from_its_edge_wants_little() {
        let large = surface(4096);
        let beside = wanted_by(&large, &view(&large, 1.0, [-9000.0, 2048.0]), 1.0);
        assert_eq!(beside.tiles.size()[0], 1);
        let mut edge = large;
        edge.pose.orientation = rotation(DVec3::X, std::f64::consts::FRAC_PI_2).to_array();
        let wanted = wanted_by(&edge, &view(&edge, 1.0, [2048.0, 2048.0]), 1.0);
        assert_eq!(wanted, Wanted::whole(6, [1, 1]));
    }
}
