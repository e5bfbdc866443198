//! Columns of ground, dry and wet paint over the cells of a tile, with the air under overhangs.

use std::collections::BTreeMap;

use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};

use crate::film::{Film, film};
use crate::layer_planes::{place_of, value};
use crate::layers::Layers;

/// True if paint of a tile is in several layers.
#[must_use]
pub(crate) fn has_layers(tile: &Tile) -> bool {
    tile.pages().any(|page| is_layered(&page.get()))
}

fn is_layered(planes: &Planes) -> bool {
    planes.own().iter().any(|own| place_of(own.shape).is_some())
}

/// The columns of a tile that contain air under paint, by cell: their ends in m above the highest bare peaks. The first
/// is the top of the paint on the ground; bottom and top of each piece over air follow. A film lies on the highest
/// paint that dried before it.
#[must_use]
pub fn tile_columns(
    relief: &Relief,
    id: TileId,
    tile: &Tile,
    cell_m: f64,
) -> BTreeMap<usize, Vec<f32>> {
    let layers = Layers::over(relief, cell_m);
    let cells = f64::from(relief.cells_per_m()) as f32;
    let ground: Vec<f32> = relief.tile(id).iter().map(|m| m * cells).collect();
    let mut stack = FilmStack {
        layers,
        floors: ground.clone(),
        tops: ground,
        layered: BTreeMap::new(),
    };
    let dry: Vec<_> = tile
        .dry()
        .map(|stack| stack.layers().collect())
        .unwrap_or_default();
    for layer in dry.iter().rev() {
        stack.add_film(&layer.planes.get());
    }
    stack.add_film(&tile.wet());
    let mut columns = stack.layered;
    columns.values_mut().flatten().for_each(|end| *end /= cells);
    columns
}

/// Stack of a tile's films; heights in cells above the highest bare peaks.
struct FilmStack {
    layers: Layers,
    /// Floor of the next film, without pieces over air.
    floors: Vec<f32>,
    /// Tops of columns of one piece.
    tops: Vec<f32>,
    /// Ends of columns of several pieces.
    layered: BTreeMap<usize, Vec<f32>>,
}

impl FilmStack {
    /// Adds a film on top.
    fn add_film(&mut self, planes: &Planes) {
        let own: Vec<LayerPlane<'_>> = planes
            .own()
            .iter()
            .filter_map(|own| {
                let (slot, layer) = place_of(own.shape)?;
                let paint = planes.iter().position(|(known, _)| *known == slot)?;
                Some((paint, layer, &own.bytes[..]))
            })
            .collect();
        let capacity = self.layers.capacity as f32;
        let mut column = Column::default();
        for cell in 0..TILE_CELLS {
            let floor = (self.floors[cell] + self.layers.below).max(0.0);
            let lowest = self.layers.lowest(floor);
            let total = column.read(planes, &own, cell, lowest);
            let film = match column.fills.len() {
                1 => Film::lying(total / capacity),
                _ => {
                    column.fills.iter_mut().for_each(|fill| *fill /= capacity);
                    film(&column.fills, (lowest + 1) as f32 - floor)
                }
            };
            self.floors[cell] += total / capacity;
            self.add_to_column(cell, &film);
        }
    }

    /// Adds the film over a cell to its column.
    fn add_to_column(&mut self, cell: usize, film: &Film) {
        if let Some(top) = self.layered.get_mut(&cell).and_then(|ends| ends.last_mut()) {
            let base = *top;
            *top += film.lying;
            let ends = film.floating.iter().flatten().map(|height| base + height);
            self.layered.entry(cell).or_default().extend(ends);
            return;
        }
        let base = self.tops[cell];
        self.tops[cell] += film.lying;
        if !film.floating.is_empty() {
            let ends = film.floating.iter().flatten().map(|height| base + height);
            let ends = std::iter::once(self.tops[cell]).chain(ends);
            self.layered.insert(cell, ends.collect());
        }
    }
}

/// One of the model's own planes: index of its paint, layer, bytes.
type LayerPlane<'a> = (usize, usize, &'a [u8]);

/// The paint of a film over one cell.
#[derive(Default)]
struct Column {
    /// Quanta of each paint that are not in a layer above the lowest.
    left: Vec<f32>,
    /// Quanta of all paints by layer, from the lowest on.
    fills: Vec<f32>,
}

impl Column {
    /// Reads a cell whose lowest open layer is `lowest`, and returns all its quanta.
    fn read(&mut self, planes: &Planes, own: &[LayerPlane<'_>], cell: usize, lowest: usize) -> f32 {
        self.left.clear();
        self.left
            .extend(planes.iter().map(|(_, plane)| plane[cell]));
        let total = self.left.iter().sum();
        self.fills.clear();
        self.fills.push(0.0);
        // From the lowest layer up: quanta that the counts lack were taken from the top.
        for (paint, layer, bytes) in own.iter().filter(|(_, layer, _)| *layer > lowest) {
            let quanta = (value(bytes, cell) as f32).min(self.left[*paint]);
            if quanta > 0.0 {
                let place = layer - lowest;
                self.fills.resize(self.fills.len().max(place + 1), 0.0);
                self.fills[place] += quanta;
                self.left[*paint] -= quanta;
            }
        }
        self.fills[0] = self.left.iter().sum();
        total
    }
}
