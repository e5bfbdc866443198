//! Edges of paint finer than a cell.
//!
//! A cell at the edge of paint has a part of the paint's thickness, for the paint covers a part of it (the volume
//! fraction of an interface; Youngs 1982, "Time-dependent multi-material flow with large fluid distortion"). A thin film
//! hides nearly as well as a thick one, so taken as an even film such a cell is all or nothing, and the edge a
//! staircase. Here paint covers as much of the cell as there is of it beside its neighbours, and the ground shows in the
//! rest: wet paint and dry layers alike, so that drying changes nothing. The paint keeps the colour of the cell's mean
//! thickness, so the edge of a transparent film is somewhat too pale. An edge over other paint stays all or nothing.

use maulstick_canvas::planes::TILE_CELLS;
use maulstick_types::paint::TILE;

/// Thickness below which a cell counts as bare, m.
const BARE_M: f32 = 0.5e-6;

/// Share of each cell of a tile that its paint covers, 0 to 1, by the paint's height, m; `None` without an edge.
/// Neighbours beyond the first `cells` columns and rows, those of the surface, are not read: paint that ends with the
/// surface has no edge there.
#[must_use]
pub(crate) fn covers(paint: &[f32], cells: [usize; 2]) -> Option<Vec<f32>> {
    let [columns, rows] = cells;
    let is_bare = |height: &f32| *height < BARE_M;
    let mut on_surface = (paint.chunks_exact(TILE).take(rows)).flat_map(|row| &row[..columns]);
    if on_surface.clone().all(is_bare) || !on_surface.any(is_bare) {
        return None;
    }
    let mut covers = vec![1.0; TILE_CELLS];
    for (cell, cover) in covers.iter_mut().enumerate() {
        if is_bare(&paint[cell]) {
            continue;
        }
        let [x, y] = [cell % TILE, cell / TILE];
        let (mut at_edge, mut most) = (false, [0.0f32; 2]);
        for row in y.saturating_sub(1)..(y + 2).min(rows) {
            for column in x.saturating_sub(1)..(x + 2).min(columns) {
                let beside = paint[row * TILE + column];
                if [column, row] == [x, y] {
                    continue;
                }
                at_edge |= is_bare(&beside);
                // The highest neighbour may be a lone peak; the second highest is the film.
                most = if beside > most[0] {
                    [beside, most[0]]
                } else {
                    [most[0], most[1].max(beside)]
                };
            }
        }
        if at_edge && most[1] > paint[cell] {
            *cover = paint[cell] / most[1];
        }
    }
    Some(covers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Paint of 200 µm with an edge of slope 1 in `run`, and the share of each cell that it covers.
    fn sloping(run: usize) -> (Vec<f32>, Vec<f32>) {
        let share = |cell: usize| {
            // The edge is at y = 20 + x / run.
            let fine = (0..64).filter(|fine| {
                let [x, y] = [cell % TILE, cell / TILE].map(|v| v as f32);
                let [u, v] = [fine % 8, fine / 8].map(|v| (v as f32 + 0.5) / 8.0);
                y + v < 20.0 + (x + u) / run as f32
            });
            fine.count() as f32 / 64.0
        };
        let shares: Vec<f32> = (0..TILE_CELLS).map(share).collect();
        let paint = shares.iter().map(|share| 200e-6 * share).collect();
        (paint, shares)
    }

    #[test]
    fn a_sloping_edge_covers_cells_by_its_share_of_them() {
        for run in [3, 9, 64] {
            let (paint, shares) = sloping(run);
            let covers = covers(&paint, [TILE; 2]).expect("an edge");
            let painted = |share: &f32| *share > 0.0;
            let pairs = || {
                covers
                    .iter()
                    .zip(&shares)
                    .filter(|(_, share)| painted(share))
            };
            let worst = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 0.15, "1 in {run}: {worst}");
            let (all, want) = pairs().fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
            assert!((all / want - 1.0).abs() < 0.002, "{all} {want}");
            let stairs = shares.iter().filter(|share| painted(share)).count() as f32;
            assert!(stairs / want - 1.0 > 0.002, "whole cells pass");
        }
    }

    #[test]
    fn paint_that_ends_with_the_surface_has_no_edge_there() {
        let [columns, rows] = [37, 50];
        let thick = |cell: usize| match [cell % TILE, cell / TILE] {
            [x, y] if x < columns && y < rows => 50e-6 + 1e-6 * ((x + y) % 7) as f32,
            _ => 0.0,
        };
        let paint: Vec<f32> = (0..TILE_CELLS).map(thick).collect();
        assert_eq!(covers(&paint, [columns, rows]), None);
        assert!(
            covers(&paint, [TILE; 2]).is_some(),
            "what lies beyond is read"
        );
    }

    #[test]
    fn paint_without_an_edge_is_whole() {
        assert_eq!(covers(&[0.0; TILE_CELLS], [TILE; 2]), None);
        assert_eq!(covers(&[50e-6; TILE_CELLS], [TILE; 2]), None);
        // A line of one cell, and a speck, cover their cells.
        let mut line = vec![0.0; TILE_CELLS];
        (0..TILE).for_each(|x| line[20 * TILE + x] = 80e-6);
        line[40 * TILE + 40] = 300e-6;
        let covers = covers(&line, [TILE; 2]).expect("edges");
        assert!(covers.iter().all(|cover| *cover == 1.0));
    }
}
