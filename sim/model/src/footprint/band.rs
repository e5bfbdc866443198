//! A band of the footprint: the rows of it that one core finds.

use std::ops::Range;

use maulstick_canvas::window::Area;
use maulstick_num::wide;

use super::contact::Contact;
use super::rasterizer::Drawing;
use super::ribbons::Ribbons;
use crate::interface::Step;

wide! {
    fn draw_strips<L>(drawing: &mut Drawing, ribbons: &Ribbons) {
        let numbers = drawing.cells_drawn()..;
        for (number, laid) in numbers.zip(ribbons.laid()) {
            drawing.draw::<L>(laid, number as f32);
        }
    }
}

/// The rows of a footprint that one core finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    /// The cells in contact, row after row; their local places are those on the grid.
    pub(super) contacts: Vec<Contact>,
    /// Wet quanta of all paints on each contact, before the step.
    pub(super) wet: Vec<f32>,
    /// Columns and rows of the grid with contacts, half-open.
    pub(super) reach: ([usize; 2], [usize; 2]),
    /// The whole footprint's cells.
    pub(super) grid: Area,
    /// The surface's coordinates of the grid's lower left corner.
    pub(super) offset: [f32; 2],
    pub(super) drawing: Drawing,
}

impl Band {
    /// The reach of none.
    pub(super) const NOWHERE: ([usize; 2], [usize; 2]) = ([usize::MAX; 2], [0; 2]);

    /// Removes all contacts.
    pub(super) fn clear(&mut self) {
        self.contacts.clear();
        self.wet.clear();
        self.reach = Self::NOWHERE;
    }

    /// Clears these rows of a grid.
    pub(super) fn begin(&mut self, grid: Area, offset: [f32; 2], rows: Range<usize>) {
        self.clear();
        self.grid = grid;
        self.offset = offset;
        self.drawing.begin(grid.size, rows);
    }

    /// Draws the parts of the head that, with their paint, are below `top`, cells; its strips are on the grid already.
    pub(super) fn draw_head(&mut self, step: &Step<'_>, ribbons: &Ribbons, top: f32) {
        self.draw_skin(step, top);
        draw_strips(&mut self.drawing, ribbons);
    }

    /// Finds the covered cells that are touched.
    pub(super) fn touch(&mut self, step: &Step<'_>, ribbons: &Ribbons, lying: &[f32], sink: f32) {
        let window = &*step.window;
        let to_cells = step.traits.cells_per_quantum;
        let film_cells = step.traits.film_cells_per_quantum;
        let films = step.load.films();
        let width = self.grid.size[0];
        let (from, to) = &mut self.reach;
        for y in self.drawing.rows() {
            let row = (self.grid.from[1] + y) * window.width() + self.grid.from[0];
            let lying = &lying[y * width..(y + 1) * width];
            let base = &window.base()[row..row + width];
            let ride = &window.ride()[row..row + width];
            let (mut first, mut last) = (usize::MAX, 0);
            for x in 0..width {
                let Some(over) = self.drawing.over(ribbons, x, y) else {
                    continue;
                };
                let texel = over.texel();
                let wet = lying[x] * to_cells;
                let reach = base[x] + wet - over.bottom(ride[x], sink);
                if reach + films[texel as usize] as f32 * film_cells <= 0.0 {
                    continue;
                }
                (first, last) = (first.min(x), x);
                let depth = reach.clamp(0.0, wet);
                self.wet.push(lying[x]);
                self.contacts.push(Contact {
                    cell: (row + x) as u32,
                    local: (y * width + x) as u32,
                    texel,
                    cover: over.cover,
                    moved: over.moved(),
                    depth,
                    fraction: if wet > 0.0 { depth / wet } else { 0.0 },
                    gap: (-reach).max(0.0),
                });
            }
            if first <= last {
                *from = [from[0].min(first), from[1].min(y)];
                *to = [to[0].max(last + 1), y + 1];
            }
        }
    }
}
