//! The paint of a tile in the colours of another model.

use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::{CELL_MAX, QUANTUM_M};
use maulstick_canvas::tile::Tile;
use maulstick_canvas::wet_over::wet_over;
use maulstick_optics::Under;
use maulstick_optics::colour::delta_e_2000;

use crate::cell::{FilmCell, VolumeCell};
use crate::colouring::Colouring;
use crate::fit::{Fitter, Found, Wanted, whole};
use crate::masstones::Masstones;
use crate::palette::Palette;
use crate::shown::{Kind, Shown};

/// Distance, ΔE₀₀, from which a fit is tried from elsewhere, too.
const FAR: f64 = 1.0;

/// Ground of a tile, and its cells that are left alone.
#[derive(Clone, Copy, Debug)]
pub struct TileGround<'a> {
    /// Internal reflectances.
    pub under: Under<'a>,
    /// Cells whose paint stays as it is: those of wells.
    pub stays: &'a [usize],
}

/// Distances between what is seen of cells before and after, ΔE₀₀.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// Sum over the cells.
    pub sum: f64,
    /// The farthest.
    pub worst: f64,
    /// Number of cells.
    pub cells: u64,
}

impl Distance {
    /// Takes another one in.
    pub fn add(&mut self, other: &Self) {
        self.sum += other.sum;
        self.worst = self.worst.max(other.worst);
        self.cells += other.cells;
    }

    /// The mean; 0 of no cell.
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
    /// How near its painted cells come to what was seen.
    pub distance: Distance,
}

/// Conversion of tiles from one colouring to another.
#[derive(Debug)]
pub struct Converter<'a> {
    palette: Palette<'a>,
    from: Colouring,
    to: Colouring,
    masstones: Option<Masstones>,
}

/// The paint of one layer of a cell.
#[derive(Debug, Default, PartialEq, Clone)]
struct CellPaint {
    /// Quanta by paint of the palette.
    counts: Vec<f32>,
    all: u64,
}

impl CellPaint {
    fn take(&mut self, planes: &[Option<&Arc<[f32]>>], cell: usize) {
        let count = |plane: &Option<&Arc<[f32]>>| plane.map_or(0.0, |plane| plane[cell]);
        self.counts.clear();
        self.counts.extend(planes.iter().map(count));
        self.all = self.counts.iter().map(|count| *count as u64).sum();
    }
}

/// What a fit of a cell depends on: alike for many neighbours.
#[derive(Debug, Default, PartialEq, Clone)]
struct Asked {
    paint: CellPaint,
    colour: [f64; 3],
    /// Reflectances or encoded channels of what lies under it.
    under: Vec<f64>,
    hides: f64,
}

impl<'a> Converter<'a> {
    /// A conversion under a look, whose paints it may use.
    #[must_use]
    pub fn new(look: &'a Appearance, from: Colouring, to: Colouring) -> Self {
        let palette = Palette::new(look);
        let masstones = (from != to && to == Colouring::Films).then(|| Masstones::new(&palette));
        Self {
            palette,
            from,
            to,
            masstones,
        }
    }

    /// The paint of a tile in the other colours. Planes of the model's own are left out. What a tile becomes depends on it
    /// and its ground alone.
    #[must_use]
    pub fn tile(&self, tile: &Tile, ground: TileGround<'_>) -> Converted {
        let stack = tile.dry();
        let layers: Vec<_> = stack.into_iter().flat_map(|stack| stack.layers()).collect();
        let mut converted = Converted::default();
        if self.from == self.to {
            converted.wet = plain(&tile.wet());
            let dry = layers.iter().map(|layer| plain(&layer.planes.get()));
            converted.dry = dry.collect();
            return converted;
        }
        let palette = &self.palette;
        let mut before = Shown::ground(self.from, palette, ground.under);
        let mut after = Shown::ground(self.to, palette, ground.under);
        for layer in layers.iter().rev() {
            let planes = layer.planes.get();
            let opacity = palette.look.opacity(layer.number);
            let dry = |over: Option<Vec<f32>>| Kind::Dry { opacity, over };
            before.lay(palette, &planes, &dry(wet_over(&planes)));
            let fitted = self.layer(&planes, &before, &after, &dry(None), ground.stays);
            after.lay(palette, &fitted, &dry(None));
            converted.dry.push(fitted);
        }
        converted.dry.reverse();
        let wet = tile.wet();
        if !wet.is_empty() {
            before.lay(palette, &wet, &Kind::Wet);
            converted.wet = self.layer(&wet, &before, &after, &Kind::Wet, ground.stays);
            after.lay(palette, &converted.wet, &Kind::Wet);
        }
        converted.distance = self.distance(tile, &before, &after);
        converted
    }

    /// How near what is seen now comes to what was seen, over the painted cells.
    fn distance(&self, tile: &Tile, before: &Shown, after: &Shown) -> Distance {
        let wet = tile.wet();
        let dry = tile.dry().map(|stack| stack.height());
        let mut distance = Distance::default();
        for cell in 0..TILE_CELLS {
            let is_dry = dry.as_ref().is_some_and(|dry| dry[cell] > 0.0);
            if is_dry || wet.iter().any(|(_, plane)| plane[cell] > 0.0) {
                let [one, other] = [before, after].map(|shown| shown.lab(&self.palette, cell));
                let delta_e = delta_e_2000(one, other);
                distance.add(&Distance {
                    sum: delta_e,
                    worst: delta_e,
                    cells: 1,
                });
            }
        }
        distance
    }

    /// A layer with the paints of each cell chosen anew: over `under` it is to have the colour that `wanted` has.
    fn layer(
        &self,
        planes: &Planes,
        wanted: &Shown,
        under: &Shown,
        kind: &Kind,
        stays: &[usize],
    ) -> Planes {
        let slots = &self.palette.slots;
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
        let mut fit = CellFit::new(self);
        for cell in (0..TILE_CELLS).filter(|cell| !left_alone[*cell]) {
            fit.asked.paint.take(&own, cell);
            // More than a cell holds may not be exact as a count of one paint.
            if !(1..=u64::from(CELL_MAX)).contains(&fit.asked.paint.all) {
                continue;
            }
            fit.ask(wanted, under, kind, cell);
            for (into, count) in into.iter_mut().zip(fit.counts()) {
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
        by_slot.into_iter().collect()
    }
}

/// Counts without planes of the model's own.
fn plain(planes: &Planes) -> Planes {
    planes.iter().cloned().collect()
}

/// Fits of the cells of a layer, one after the other: each begins from the one before it.
struct CellFit<'a> {
    converter: &'a Converter<'a>,
    fitter: Fitter,
    asked: Asked,
    last: Asked,
    own: Vec<f64>,
    start: Vec<f64>,
    found: Found,
    other: Found,
    counts: Vec<u64>,
}

impl<'a> CellFit<'a> {
    fn new(converter: &'a Converter<'a>) -> Self {
        let paints = converter.palette.slots.len();
        Self {
            converter,
            fitter: Fitter::new(paints),
            asked: Asked::default(),
            last: Asked::default(),
            own: Vec::new(),
            start: vec![0.0; paints],
            found: Found::default(),
            other: Found::default(),
            counts: Vec::new(),
        }
    }

    /// Takes in what the fit of a cell depends on besides its paint.
    fn ask(&mut self, wanted: &Shown, under: &Shown, kind: &Kind, cell: usize) {
        let asked = &mut self.asked;
        asked.colour = wanted.lab(&self.converter.palette, cell);
        asked.under.clear();
        match under {
            Shown::Films(planes) => {
                let values = planes.iter().skip(cell).step_by(TILE_CELLS);
                asked.under.extend(values.map(|r| f64::from(*r)));
                asked.hides = kind.opacity().into();
            }
            Shown::Volumes(rgb) => {
                let values = rgb.iter().map(|plane| f64::from(plane[cell]));
                asked.under.extend(values);
                asked.hides = kind.hides(cell, asked.paint.all as f32).into();
            }
        }
    }

    /// Quanta by paint.
    fn counts(&mut self) -> &[u64] {
        if self.asked != self.last || self.counts.is_empty() {
            let all = self.asked.paint.all;
            let share = |count: &f32| f64::from(*count) / all as f64;
            self.own.clear();
            self.own.extend(self.asked.paint.counts.iter().map(share));
            std::mem::swap(&mut self.asked, &mut self.last);
            let Asked { colour, hides, .. } = self.last;
            let palette = &self.converter.palette;
            match self.converter.to {
                Colouring::Films => {
                    let under = std::mem::take(&mut self.last.under);
                    let film = FilmCell {
                        palette,
                        under: &under,
                        thickness_m: all as f64 * QUANTUM_M * hides,
                    };
                    self.fit(&film, colour);
                    self.last.under = under;
                }
                Colouring::Volumes => {
                    let under = [0, 1, 2].map(|channel| self.last.under[channel]);
                    let volume = VolumeCell {
                        palette,
                        under,
                        hides,
                    };
                    self.fit(&volume, colour);
                }
            }
            whole(&self.found.shares, all, &mut self.counts);
        }
        &self.counts
    }

    /// Finds shares, from the own ones and from those of the cell before; where both are far, from a table.
    fn fit(&mut self, colour: &impl crate::cell::CellColour, wanted: [f64; 3]) {
        let wanted = Wanted {
            colour: wanted,
            own: &self.own,
        };
        let has_last = !self.found.shares.is_empty();
        if has_last {
            self.start.copy_from_slice(&self.found.shares);
            self.fitter
                .descend(colour, wanted, &self.start, &mut self.found);
            if self.found.delta_e <= FAR {
                return;
            }
        }
        let mut better = |start: &[f64], found: &mut Found, is_first: bool| {
            self.fitter.descend(colour, wanted, start, &mut self.other);
            if is_first || self.other.energy < found.energy {
                std::mem::swap(found, &mut self.other);
            }
        };
        better(&self.own, &mut self.found, !has_last);
        if self.found.delta_e > FAR
            && let Some(masstones) = &self.converter.masstones
        {
            masstones.nearest(wanted.colour, &mut self.start);
            better(&self.start, &mut self.found, false);
        }
    }
}
