//! The paint of a tile in the colours of another model.

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::colouring::Colouring;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M};
use maulstick_canvas::tile::Tile;
use maulstick_optics::Under;
use maulstick_optics::colour::delta_e_2000;
use maulstick_types::paint::TILE;

use crate::cell_fit::{CellFit, Target};
use crate::masstones::Masstones;
use crate::palette::Palette;
use crate::shown::{Kind, Paints, Shown};

/// Ground of a tile, and its cells that are left unchanged.
#[derive(Clone, Copy, Debug)]
pub struct TileGround<'a> {
    /// Internal reflectances.
    pub under: Under<'a>,
    /// Cells whose paint stays unchanged: those of wells.
    pub stays: &'a [usize],
}

/// Distances between the appearance of cells before and after, ΔE₀₀.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// Sum over the cells.
    pub sum: f64,
    /// Greatest distance.
    pub worst: f64,
    /// Cell with the greatest distance; `None` without cells.
    pub farthest: Option<Farthest>,
    /// Number of cells.
    pub cells: u64,
    /// Number of cells beyond [`OBVIOUS_DELTA_E`].
    pub far: u64,
}

/// An obvious difference of colour, ΔE₀₀.
pub const OBVIOUS_DELTA_E: f64 = 5.0;
/// Thickness below which the opacity of a film may change in another model, for any mixture, m.
const THIN_M: f64 = 40e-6;

/// A cell whose colour is not reproduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Farthest {
    /// Its column and row, in the tile or the surface, from the lower left corner.
    pub cell: [usize; 2],
    /// Thickness of its paint, m.
    pub film_m: f64,
}

impl Farthest {
    /// True where the film is so thin that its opacity may change.
    #[must_use]
    pub fn is_thin(&self) -> bool {
        self.film_m < THIN_M
    }
}

impl Distance {
    /// Adds another distance.
    pub fn add(&mut self, other: &Self) {
        self.sum += other.sum;
        if other.worst > self.worst || self.farthest.is_none() {
            self.farthest = other.farthest;
        }
        self.worst = self.worst.max(other.worst);
        self.cells += other.cells;
        self.far += other.far;
    }

    /// The distance of a tile whose first cell is at this cell of a surface.
    #[must_use]
    pub fn moved(mut self, [x, y]: [usize; 2]) -> Self {
        if let Some(Farthest { cell, .. }) = &mut self.farthest {
            *cell = [cell[0] + x, cell[1] + y];
        }
        self
    }

    /// Mean distance; 0 without cells.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.cells.max(1) as f64
    }
}

/// Paint of a tile in other colours.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Converted {
    /// Wet planes; empty where nothing is wet.
    pub wet: Planes,
    /// Planes of the dry layers, the newest first.
    pub dry: Vec<Planes>,
    /// Distance of its painted cells from their old appearance.
    pub distance: Distance,
}

/// Conversion of tiles from one colouring to another.
#[derive(Debug)]
pub struct Converter<'a> {
    /// True if both colourings are the same.
    is_same: bool,
    from: Paints,
    target: Target<'a>,
}

impl<'a> Converter<'a> {
    /// A conversion under an appearance, whose paints it may use.
    #[must_use]
    pub fn new(look: &'a Appearance, from: Colouring, to: Colouring) -> Self {
        let palette = Palette::new(look);
        let masstones = (from != to && to == Colouring::Films).then(|| Masstones::new(&palette));
        Self {
            is_same: from == to,
            from: Paints::of(from, &palette),
            target: Target {
                paints: Paints::of(to, &palette),
                palette,
                masstones,
            },
        }
    }

    /// The paint of a tile in the other colours, without the model's own planes. The result depends on the tile and its
    /// ground alone.
    #[must_use]
    pub fn tile(&self, tile: &Tile, ground: TileGround<'_>) -> Converted {
        let stack = tile.dry();
        let layers: Vec<_> = stack.into_iter().flat_map(|stack| stack.layers()).collect();
        let mut converted = Converted::default();
        if self.is_same {
            converted.wet = plain(&tile.wet());
            let dry = layers.iter().map(|layer| plain(&layer.planes.get()));
            converted.dry = dry.collect();
            return converted;
        }
        let palette = &self.target.palette;
        let mut before = Shown::ground(&self.from, palette, ground.under);
        let mut after = Shown::ground(&self.target.paints, palette, ground.under);
        for layer in layers.iter().rev() {
            let planes = layer.planes.get();
            let opacity = palette.look.opacity(layer.number);
            let dry = |over: Option<Vec<f32>>| Kind::Dry { opacity, over };
            before.lay(
                &self.from,
                palette,
                &planes,
                &dry(self.from.wet_over(&planes)),
            );
            let fitted = self.layer(&planes, &before, &after, &dry(None), ground.stays);
            after.lay(
                &self.target.paints,
                palette,
                &fitted,
                &dry(self.target.paints.wet_over(&fitted)),
            );
            converted.dry.push(fitted);
        }
        converted.dry.reverse();
        let wet = tile.wet();
        if !wet.is_empty() {
            before.lay(&self.from, palette, &wet, &Kind::Wet);
            converted.wet = self.layer(&wet, &before, &after, &Kind::Wet, ground.stays);
            after.lay(&self.target.paints, palette, &converted.wet, &Kind::Wet);
        }
        converted.distance = self.distance(tile, &before, &after);
        converted
    }

    /// Distance between the new and the old appearance, over the painted cells.
    fn distance(&self, tile: &Tile, before: &Shown, after: &Shown) -> Distance {
        let wet = tile.wet();
        let dry = tile.dry().map(|stack| stack.height());
        let mut distance = Distance::default();
        for cell in 0..TILE_CELLS {
            let is_dry = dry.as_ref().is_some_and(|dry| dry[cell] > 0.0);
            if is_dry || wet.iter().any(|(_, plane)| plane[cell] > 0.0) {
                let film: f32 = wet.iter().map(|(_, plane)| plane[cell]).sum();
                let film = film + dry.as_ref().map_or(0.0, |dry| dry[cell]);
                let [one, other] =
                    [before, after].map(|shown| shown.lab(&self.target.palette, cell));
                let delta_e = delta_e_2000(one, other);
                distance.add(&Distance {
                    sum: delta_e,
                    worst: delta_e,
                    farthest: Some(Farthest {
                        cell: [cell % TILE, cell / TILE],
                        film_m: f64::from(film) * QUANTUM_M,
                    }),
                    cells: 1,
                    far: u64::from(delta_e > OBVIOUS_DELTA_E),
                });
            }
        }
        distance
    }

    /// A layer with fitted paints in each cell, which has the colour of `wanted` over `under`. For dry volumes the
    /// opacity is fitted too, as wet quanta over them.
    fn layer(
        &self,
        planes: &Planes,
        wanted: &Shown,
        under: &Shown,
        kind: &Kind,
        stays: &[usize],
    ) -> Planes {
        let slots = &self.target.palette.slots;
        let plane_of = |slot: &usize| {
            let found = planes.iter().find(|(own, _)| own == slot);
            found.map(|(_, plane)| plane)
        };
        let own: Vec<Option<&Arc<[f32]>>> = slots.iter().map(plane_of).collect();
        let mut into: Vec<Option<Vec<f32>>> = own
            .iter()
            .map(|plane| plane.map(|plane| plane.to_vec()))
            .collect();
        let mut left_alone = [false; TILE_CELLS];
        stays.iter().for_each(|cell| left_alone[*cell] = true);
        let mut fit = CellFit::new(&self.target);
        let mut over = vec![0.0; TILE_CELLS];
        for cell in (0..TILE_CELLS).filter(|cell| !left_alone[*cell]) {
            let all = fit.take(&own, cell);
            // More than a cell's capacity may not be exact as a count of one paint.
            if !(1..=u64::from(CELL_MAX)).contains(&all) {
                continue;
            }
            let fitted = fit.fitted(wanted, under, kind, cell);
            over[cell] = fitted.over;
            for (into, count) in into.iter_mut().zip(fitted.counts) {
                match into {
                    Some(plane) => plane[cell] = *count as f32,
                    None if *count > 0 => {
                        let mut plane = vec![0.0; TILE_CELLS];
                        plane[cell] = *count as f32;
                        *into = Some(plane);
                    }
                    None => {}
                }
            }
        }
        let mut by_slot: Vec<(usize, Arc<[f32]>)> = slots
            .iter()
            .zip(into)
            .filter_map(|(slot, plane)| Some((*slot, plane?.into())))
            .collect();
        let others = planes.iter().filter(|(slot, _)| !slots.contains(slot));
        by_slot.extend(others.cloned());
        by_slot.sort_by_key(|(slot, _)| *slot);
        by_slot.retain(|(_, plane)| plane.iter().any(|count| *count != 0.0));
        let fitted: Planes = by_slot.into_iter().collect();
        match &self.target.paints {
            Paints::Volumes(volumes) if over.iter().any(|over| *over > 0.0) => {
                (volumes.of.noted)(fitted, &over)
            }
            _ => fitted,
        }
    }
}

/// Counts without the model's own planes.
fn plain(planes: &Planes) -> Planes {
    planes.iter().cloned().collect()
}
