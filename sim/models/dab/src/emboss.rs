//! Embossing (Baxter 2004, § 4.6.2): the relief of the paint, as if lit from above and from the right.

use maulstick_types::paint::TILE;

/// Kernel of a correlation, the uppermost row first.
const KERNEL: [[f32; 3]; 3] = [[0.0, -1.0, -2.0], [1.0, 0.0, -1.0], [2.0, 1.0, 0.0]];

/// Embossing of the heights of a tile, rows from the bottom: the summand of each channel at strength 1.
///
/// Beyond its edge a tile continues with the mean slope of its outer two cells, so that it needs no other and no edge
/// shows.
#[must_use]
pub fn emboss(heights: &[f32]) -> Vec<f32> {
    let at = |x: i64, y: i64| {
        let inside = |at: i64| at.clamp(0, TILE as i64 - 1);
        let cell = |x: i64, y: i64| heights[(inside(y) as usize) * TILE + inside(x) as usize];
        let (to_x, to_y) = (inside(x), inside(y));
        let (dx, dy) = (x - to_x, y - to_y);
        let own = cell(to_x, to_y);
        own + 0.5 * (own - cell(to_x - 2 * dx, to_y)) + 0.5 * (own - cell(to_x, to_y - 2 * dy))
    };
    let value = |cell: usize| {
        let (x, y) = ((cell % TILE) as i64, (cell / TILE) as i64);
        let mut sum = 0.0;
        for (row, weights) in KERNEL.iter().enumerate() {
            for (column, weight) in weights.iter().enumerate() {
                if *weight != 0.0 {
                    sum += weight * at(x + column as i64 - 1, y + 1 - row as i64);
                }
            }
        }
        sum
    };
    (0..TILE * TILE).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(height: impl Fn(f32, f32) -> f32) -> Vec<f32> {
        let cell = |i: usize| height((i % TILE) as f32, (i / TILE) as f32);
        (0..TILE * TILE).map(cell).collect()
    }

    #[test]
    fn slopes_to_the_upper_right_are_light_and_level_paint_is_as_it_was() {
        assert!(emboss(&plane(|_, _| 3.0)).iter().all(|value| *value == 0.0));
        // Falls by one a cell to the right: −1·(−1) twice, −2·… of the kernel: 6.
        let right = emboss(&plane(|x, _| -x));
        let up = emboss(&plane(|_, y| -y));
        let away = emboss(&plane(|x, y| x + y));
        for (light, value) in [(&right, 6.0), (&up, 6.0), (&away, -12.0)] {
            assert!(
                light.iter().all(|got| (got - value).abs() < 1e-3),
                "{:?}",
                &light[..4]
            );
        }
        let flipped = plane(|_, y| y);
        assert!(
            emboss(&flipped)[70] < 0.0,
            "lit from below, a fault would pass"
        );
    }

    #[test]
    fn a_tile_embosses_its_edge_as_if_it_knew_its_neighbour() {
        let ridge =
            |x: f32, y: f32| ((x + 0.6 * y) * 0.7 - ((x + 0.6 * y) * 0.7).floor() - 0.5).abs();
        let smooth = |x: f32, y: f32| (x - 30.0) * (x - 30.0) * 0.01 + ridge(0.0, 0.2 * y);
        let heights = [0.0, 20.0].map(|by| plane(|x, y| smooth(x + by, y)));
        let [own, moved] = heights.each_ref().map(|heights| emboss(heights));
        let mut found = 0;
        for y in 1..TILE - 1 {
            let (edge, inner) = (own[y * TILE + TILE - 1], moved[y * TILE + TILE - 21]);
            let off = |edge: f32| (edge - inner).abs() >= 0.1 * inner.abs() + 0.1;
            assert!(!off(edge), "{edge} {inner}");
            found += usize::from(off(level_beyond(&heights[0], [TILE - 1, y])));
        }
        assert!(found > TILE / 2, "a tile level beyond its edge passes");
    }

    /// The kernel on a cell of a tile whose outermost cells continue level beyond its edge, in f64.
    fn level_beyond(heights: &[f32], [x, y]: [usize; 2]) -> f32 {
        let rows = [
            (1, [0.0, -1.0, -2.0]),
            (0, [1.0, 0.0, -1.0]),
            (-1, [2.0, 1.0, 0.0]),
        ];
        let mut sum = 0.0;
        for (up, weights) in rows {
            for (right, weight) in (-1i64..).zip(weights) {
                let [x, y] = [x as i64 + right, y as i64 + up]
                    .map(|at| at.clamp(0, TILE as i64 - 1) as usize);
                sum += weight * f64::from(heights[y * TILE + x]);
            }
        }
        sum as f32
    }
}
