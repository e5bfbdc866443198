//! Edges of films below a cell.
//!
//! A cell at the edge of a film has a part of the film's thickness, for the film covers a part of it (the volume
//! fraction of an interface; Youngs 1982, "Time-dependent multi-material flow with large fluid distortion"). A thin film
//! hides nearly as well as a thick one, so taken as an even film such a cell is all or nothing, and the edge a
//! staircase. Here its film is as thick as beside it, and covers as much of the cell as there is paint.

use maulstick_types::paint::TILE;

use crate::backend::TILE_CELLS;

/// Thickness below which a cell counts as bare, m.
const BARE_M: f32 = 0.5e-6;
/// The least share of a cell that a film covers.
const LEAST: f32 = 1.0 / 64.0;

/// The share of each cell of a tile that its film covers, 0 to 1; `None` where the film has no edge. Neighbours beyond
/// the tile are not asked.
#[must_use]
pub fn covers(paints: &[(usize, &[f32])]) -> Option<Vec<f32>> {
    let mut film = vec![0.0f32; TILE_CELLS];
    for (_, plane) in paints {
        film.iter_mut().zip(*plane).for_each(|(sum, d)| *sum += d);
    }
    let is_bare = |thickness: &f32| *thickness < BARE_M;
    if film.iter().all(is_bare) || !film.iter().any(is_bare) {
        return None;
    }
    let mut covers = vec![1.0; TILE_CELLS];
    for (cell, cover) in covers.iter_mut().enumerate() {
        if is_bare(&film[cell]) {
            continue;
        }
        let [x, y] = [cell % TILE, cell / TILE];
        let (mut at_edge, mut most) = (false, [0.0f32; 2]);
        for row in y.saturating_sub(1)..(y + 2).min(TILE) {
            for column in x.saturating_sub(1)..(x + 2).min(TILE) {
                let beside = film[row * TILE + column];
                if [column, row] == [x, y] {
                    continue;
                }
                at_edge |= is_bare(&beside);
                // The thickest one may be a peak; two of them are the film.
                most = if beside > most[0] {
                    [beside, most[0]]
                } else {
                    [most[0], most[1].max(beside)]
                };
            }
        }
        if at_edge && most[1] > film[cell] {
            *cover = (film[cell] / most[1]).max(LEAST);
        }
    }
    Some(covers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film of 200 µm with an edge of slope 1 in `run`, and the share of each cell that it covers.
    fn film(run: usize) -> (Vec<f32>, Vec<f32>) {
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
        let film = shares.iter().map(|share| 200e-6 * share).collect();
        (film, shares)
    }

    #[test]
    fn a_sloping_edge_covers_cells_by_its_share_of_them() {
        for run in [3, 9, 64] {
            let (film, shares) = film(run);
            let covers = covers(&[(0, &film)]).expect("an edge");
            let off = covers
                .iter()
                .zip(&shares)
                .filter(|(_, share)| **share > 0.0);
            let worst = off.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 0.15, "1 in {run}: {worst}");
            let all: f32 = covers
                .iter()
                .zip(&film)
                .map(|(c, d)| if *d > 0.0 { *c } else { 0.0 })
                .sum();
            let want: f32 = shares.iter().sum();
            assert!((all / want - 1.0).abs() < 0.002, "{all} {want}");
            let stairs = film.iter().filter(|d| **d > 0.0).count() as f32;
            assert!(stairs / want - 1.0 > 0.002, "whole cells pass");
        }
    }

    #[test]
    fn films_without_an_edge_are_whole() {
        assert_eq!(covers(&[]), None);
        let even = vec![50e-6; TILE_CELLS];
        assert_eq!(covers(&[(0, &even), (3, &even)]), None);
        // A peak beside bare ground is no edge, and neither is a line of one cell.
        let mut line = vec![0.0; TILE_CELLS];
        (0..TILE).for_each(|x| line[20 * TILE + x] = 80e-6);
        line[40 * TILE + 40] = 300e-6;
        let covers = covers(&[(0, &line)]).expect("edges");
        assert!(covers.iter().all(|cover| *cover == 1.0));
    }
}
