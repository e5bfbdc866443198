//! The skin of a head in its footprint: triangles over the middles of cells.

use super::band::Band;
use super::piece::{Line, Piece};
use crate::brush::traits::TEXELS_PER_STRIP;
use crate::interface::Step;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: [f32; 3],
    moved: [f32; 2],
    /// Place around the head and along it, both 0 to 1.
    place: [f32; 2],
}

impl Band {
    /// Draws the faces of the skin that, with the paint of its strips on them, come below `top`, cells.
    pub(super) fn draw_skin(&mut self, step: &Step<'_>, top: f32) {
        let Some(skin) = step.head.skin() else {
            return;
        };
        let traits = &step.traits;
        let height = top + step.load.thickest() as f32 * traits.film_cells_per_quantum;
        let bottom = traits.recede * step.sweep.to.splay;
        let (before, after) = (&step.sweep.from.skin, &step.sweep.to.skin);
        for face in skin.faces() {
            let low = |i: &u32| after.z[*i as usize] + bottom < height;
            if !face.iter().any(low) {
                continue;
            }
            let first = skin.places()[face[0] as usize][0];
            let corners = face.map(|i| {
                let i = i as usize;
                let [around, along] = skin.places()[i];
                // A face over the seam continues beyond 1.
                let turns = (first - around).round();
                Corner {
                    at: [
                        after.x[i] - self.offset[0],
                        after.y[i] - self.offset[1],
                        after.z[i],
                    ],
                    moved: [after.x[i] - before.x[i], after.y[i] - before.y[i]],
                    place: [around + turns, along],
                }
            });
            let [a, b, c, d] = corners;
            self.draw_triangle(step, [a, b, c], bottom);
            self.draw_triangle(step, [a, c, d], bottom);
        }
    }

    /// Draws a triangle where it is the lowest.
    fn draw_triangle(&mut self, step: &Step<'_>, corners: [Corner; 3], bottom: f32) {
        let [a, b, c] = corners;
        let side = |p: &Corner, q: &Corner, x: f32, y: f32| {
            (q.at[0] - p.at[0]) * (y - p.at[1]) - (q.at[1] - p.at[1]) * (x - p.at[0])
        };
        let area = side(&a, &b, c.at[0], c.at[1]);
        if area.abs() < 1e-9 {
            return;
        }
        let range = |axis: usize| {
            let of = corners.map(|corner| corner.at[axis]);
            let low = of[0].min(of[1]).min(of[2]);
            let high = of[0].max(of[1]).max(of[2]);
            let last = self.grid.size[axis] as f32;
            let cell = |edge: f32| (edge + 0.5).clamp(0.0, last) as usize;
            cell(low)..cell(high)
        };
        let (columns, rows, drawn) = (range(0), range(1), self.drawing.rows());
        let inverse = 1.0 / area;
        for row in rows.start.max(drawn.start)..rows.end.min(drawn.end) {
            let y = row as f32 + 0.5;
            for column in columns.clone() {
                let x = column as f32 + 0.5;
                let u = side(&b, &c, x, y) * inverse;
                let v = side(&c, &a, x, y) * inverse;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let mix = |of: [f32; 3]| u * of[0] + v * of[1] + w * of[2];
                let z = mix(corners.map(|corner| corner.at[2]));
                let around = mix(corners.map(|corner| corner.place[0]));
                let along = mix(corners.map(|corner| corner.place[1])) * TEXELS_PER_STRIP as f32;
                let strip = step.head.strip_around(around);
                let piece = Piece {
                    texel: (strip * TEXELS_PER_STRIP + (along as usize).min(TEXELS_PER_STRIP - 1))
                        as u32,
                    z: [z, 0.0],
                    bottom,
                    moved: [
                        [0, 1].map(|i| mix(corners.map(|corner| corner.moved[i]))),
                        [0.0; 2],
                    ],
                    line: Line {
                        half: f32::MAX,
                        ..Line::default()
                    },
                    ..Piece::default()
                };
                self.drawing.draw_cell(column, row, piece);
            }
        }
    }
}
