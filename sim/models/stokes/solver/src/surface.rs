//! The surface of the paint with subcell accuracy: heights by column, and all of it as triangles.

use crate::grid::Grid;

/// Fill at the surface.
const HALF: f32 = 0.5;

/// Height of the paint of each column in cells, row by row; `None` without paint. It uses the fill of the two uppermost
/// cells, so that a level surface is exact.
#[must_use]
pub fn heights(grid: &Grid, fill: &[f32]) -> Vec<Option<f32>> {
    let [width, height, depth] = grid.cells.map(|cells| cells as isize);
    let column = |base: usize| {
        let at = |z: isize| fill[base + z as usize * grid.stride(2)].clamp(0.0, 1.0);
        let top = (0..depth).rev().find(|z| at(*z) >= HALF)?;
        let above = if top + 1 < depth { at(top + 1) } else { 0.0 };
        Some(top as f32 + at(top) + above)
    };
    grid.block([0; 3], [width, height, 1]).map(column).collect()
}

/// Unit normals of a surface of heights by column, row by row, by central differences; sides count as level.
#[must_use]
pub fn normals(width: usize, heights: &[f32]) -> Vec<[f32; 3]> {
    let rows = heights.len() / width.max(1);
    let normal = |place: usize| {
        let (x, y) = (place % width, place / width);
        let slope = |low: usize, high: usize, cells: usize| {
            (heights[high] - heights[low]) / cells.max(1) as f32
        };
        let [left, right] = [x.saturating_sub(1), (x + 1).min(width - 1)];
        let [down, up] = [y.saturating_sub(1), (y + 1).min(rows - 1)];
        let dx = slope(y * width + left, y * width + right, right - left);
        let dy = slope(down * width + x, up * width + x, up - down);
        let length = (1.0 + dx * dx + dy * dy).sqrt();
        [-dx / length, -dy / length, 1.0 / length]
    };
    (0..heights.len()).map(normal).collect()
}

/// Tetrahedra of a cube of eight cells' middles, around its diagonal: corners as bits x, y, z.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

/// The surface as triangles in cells, seen counter-clockwise from the air (Doi and Koide 1991). It is closed, also
/// where paint touches a side: beyond the grid there is air.
#[must_use]
pub fn triangles(grid: &Grid, fill: &[f32]) -> Vec<[[f32; 3]; 3]> {
    let mut triangles = Vec::new();
    let cells = grid.cells.map(|cells| cells as isize);
    let at = |cell: [isize; 3]| {
        let inside = (0..3).all(|axis| (0..cells[axis]).contains(&cell[axis]));
        if inside { fill[grid.at(cell)] } else { 0.0 }
    };
    for place in grid.block([-1; 3], cells) {
        let first = grid.cell(place);
        let corner = |bits: usize| {
            let cell = [0, 1, 2].map(|axis| first[axis] + (bits >> axis & 1) as isize);
            (cell.map(|at| at as f32 + 0.5), at(cell))
        };
        let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
        if corners.iter().all(|(_, fill)| *fill >= HALF)
            || corners.iter().all(|(_, fill)| *fill < HALF)
        {
            continue;
        }
        for tetrahedron in TETRAHEDRA {
            cut(tetrahedron.map(|bits| corners[bits]), &mut triangles);
        }
    }
    triangles
}

/// Place between two corners where the fill is a half, the same from either side.
fn between(one: ([f32; 3], f32), other: ([f32; 3], f32)) -> [f32; 3] {
    let (low, high) = if one.1 <= other.1 {
        (one, other)
    } else {
        (other, one)
    };
    let share = (HALF - low.1) / (high.1 - low.1);
    [0, 1, 2].map(|axis| low.0[axis] + share * (high.0[axis] - low.0[axis]))
}

/// Triangles of one tetrahedron, whose corners are right-handed.
fn cut(corners: [([f32; 3], f32); 4], into: &mut Vec<[[f32; 3]; 3]>) {
    let (full, empty): (Vec<_>, Vec<_>) = corners.into_iter().partition(|(_, fill)| *fill >= HALF);
    let mut add = |triangle: [[f32; 3]; 3]| {
        // Outward from the paint.
        let out = [0, 1, 2].map(|axis| empty[0].0[axis] - full[0].0[axis]);
        let [a, b, c] = triangle;
        let u = [0, 1, 2].map(|axis| b[axis] - a[axis]);
        let v = [0, 1, 2].map(|axis| c[axis] - a[axis]);
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let looks = normal[0] * out[0] + normal[1] * out[1] + normal[2] * out[2];
        into.push(if looks < 0.0 { [a, c, b] } else { triangle });
    };
    match (full.as_slice(), empty.as_slice()) {
        ([one], [a, b, c]) | ([a, b, c], [one]) => {
            add([between(*one, *a), between(*one, *b), between(*one, *c)]);
        }
        ([a, b], [c, d]) => {
            let four = [
                between(*a, *c),
                between(*a, *d),
                between(*b, *d),
                between(*b, *c),
            ];
            add([four[0], four[1], four[2]]);
            add([four[0], four[2], four[3]]);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_surface_is_exact_wherever_it_lies_in_a_cell() {
        let grid = Grid::walled([3, 2, 8]);
        for level in [0.5, 2.2, 3.0, 4.9, 7.6, 8.0] {
            let fill = |place| (level - grid.cell(place)[2] as f32).clamp(0.0, 1.0);
            let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
            for height in heights(&grid, &fill) {
                assert!(height.is_some_and(|height| (height - level).abs() < 1e-6));
            }
        }
        assert_eq!(heights(&grid, &grid.field()), vec![None; 6]);
    }

    #[test]
    fn a_slope_has_its_normal() {
        let heights: Vec<f32> = (0..20).map(|i| 0.75 * (i % 5) as f32).collect();
        let normal = normals(5, &heights)[7];
        let off = [-0.6, 0.0, 0.8]
            .iter()
            .zip(normal)
            .map(|(want, got)| (want - got).abs());
        assert!(off.fold(0.0, f32::max) < 1e-6, "{normal:?}");
    }

    /// The triangles of a ball enclose its volume, and each edge is shared with one other triangle, in opposite
    /// direction.
    #[test]
    fn the_surface_of_a_ball_is_closed_and_has_its_volume() {
        let grid = Grid::walled([24; 3]);
        let fill = |place: usize| {
            let squares = grid
                .cell(place)
                .map(|at| (at as f32 - 11.5) * (at as f32 - 11.5));
            (8.5 - squares.iter().sum::<f32>().sqrt()).clamp(0.0, 1.0)
        };
        let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
        let triangles = triangles(&grid, &fill);
        let volume: f64 = triangles
            .iter()
            .map(|[a, b, c]| {
                let [a, b, c] = [a, b, c].map(|point| point.map(f64::from));
                let cross = [
                    b[1] * c[2] - b[2] * c[1],
                    b[2] * c[0] - b[0] * c[2],
                    b[0] * c[1] - b[1] * c[0],
                ];
                (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
            })
            .sum();
        let want = 4.0 / 3.0 * std::f64::consts::PI * 512.0;
        assert!((volume / want - 1.0).abs() < 0.02, "{volume} {want}");
        let bits = |point: [f32; 3]| point.map(f32::to_bits);
        let mut edges = std::collections::BTreeMap::new();
        for triangle in &triangles {
            for i in 0..3 {
                let [from, to] = [triangle[i], triangle[(i + 1) % 3]].map(bits);
                if from != to {
                    *edges.entry((from, to)).or_insert(0) += 1;
                    *edges.entry((to, from)).or_insert(0) -= 1;
                }
            }
        }
        assert!(edges.values().all(|sum| *sum == 0));
    }
}
