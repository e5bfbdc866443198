//! The two sheets of wet paint in the exchange: what a brush lays comes to lie on top, and stays there until bristles
//! plough through it.
//!
//! Paint that a texel gives to a cell goes to the upper sheet. Paint that it takes comes from as deep as the bristles
//! reach, so a light touch takes from the upper sheet alone. What was the upper sheet sinks into the body as other paint
//! comes over it, as bristles plough through it, and where it is thicker than [`SHEET_MOST`]. Paint of one kind has no
//! sheets.

use maulstick_canvas::quantum::{QUANTUM_M, SLOTS};
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_num::exp_f32;
use maulstick_num::select::{larger, smaller};

/// Greatest thickness of the upper sheet, quanta: 250 µm, as much as a loaded stroke.
pub const SHEET_MOST: f32 = (250e-6 / QUANTUM_M) as f32;
/// Thickness of other paint under which 1/e of an upper sheet is left, quanta: 20 µm.
pub const COVERS: f32 = (20e-6 / QUANTUM_M) as f32;
/// ln of the share of the upper sheet that stays on top where bristles plough through all paint along a reference cell:
/// half of it along 20 mm.
pub const LN_ON_TOP: f32 = -0.008_66;

/// No paint, and several, where one would be a slot.
pub(crate) const NONE: u8 = u8::MAX;
pub(crate) const SEVERAL: u8 = u8::MAX - 1;

/// The paint that is there besides another.
#[inline(always)]
pub(crate) fn besides(one: u8, other: u8) -> u8 {
    if one == NONE || one == other {
        other
    } else if other == NONE {
        one
    } else {
        SEVERAL
    }
}

/// The only paint on a cell.
pub(crate) fn only_on(window: &Window, cell: usize) -> u8 {
    let there = window.planes().filter(|(_, plane)| plane[cell] > 0.0);
    there.fold(NONE, |only, (slot, _)| besides(only, slot as u8))
}

/// What is in the film of a texel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnTexel {
    /// The only paint.
    pub only: u8,
    /// Sum of the squares of its paints, quanta.
    squares: f32,
}

/// Looks at the films of these texels.
pub(crate) fn look(texels: &[u32], load: &BrushLoad, found: &mut Vec<OnTexel>) {
    found.clear();
    let nothing = OnTexel {
        only: NONE,
        squares: 0.0,
    };
    found.resize(texels.len(), nothing);
    for slot in 0..SLOTS {
        let Some(film) = load.film_of(slot) else {
            continue;
        };
        for (found, texel) in found.iter_mut().zip(texels) {
            let count = film[*texel as usize];
            if count > 0 {
                found.only = besides(found.only, slot as u8);
                found.squares += count as f32 * count as f32;
            }
        }
    }
}

/// State of a contact's sheets before the exchange, and what the texel gives and takes, quanta.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SheetExchange {
    /// Quanta in the upper sheet.
    pub top: f32,
    /// Quanta of all wet paint.
    pub lying: f32,
    /// Share of it that the bristles shear.
    pub fraction: f32,
    /// Path of the brush, reference cells.
    pub travel: f32,
    /// Quanta that come, that go to the brush, and share of these that leaves the cell.
    pub comes: f32,
    pub goes: f32,
    pub leaves: f32,
    /// Quanta that come over the upper sheet, of other paint.
    pub covered: f32,
}

/// What becomes of the sheets: the shares of upper sheet and body that go to the brush, the share of the rest of the
/// upper sheet that does not sink, and the share of that and the paint that comes which stays on top.
#[inline(always)]
pub(crate) fn parted(sheet: &SheetExchange) -> [f32; 4] {
    let reach = larger(sheet.fraction * sheet.lying, sheet.goes);
    let over = sheet.top / larger(reach, 1.0);
    let off_top = smaller(sheet.goes * smaller(over, 1.0), sheet.top);
    let body = sheet.lying - sheet.top;
    let from_top = off_top / larger(sheet.top, 1.0);
    let from_body = smaller((sheet.goes - off_top) / larger(body, 1.0), 1.0);
    let ploughed = LN_ON_TOP * sheet.travel * larger(1.0 - over, 0.0);
    let kept = exp_f32(ploughed - sheet.covered * (1.0 / COVERS));
    let left = (sheet.top - sheet.leaves * off_top) * kept + sheet.comes;
    let fits = smaller(SHEET_MOST / larger(left, 1.0), 1.0);
    [from_top, from_body, kept, fits]
}

/// Sheets of a core's contacts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sheets {
    found: Vec<Mixtures>,
    /// Results of [`parted`] by contact.
    pub parted: [Vec<f32>; 4],
}

/// What is in the upper sheet of a contact's cell.
#[derive(Clone, Copy, Debug)]
struct Mixtures {
    /// Quanta of all paints.
    top: f32,
    /// The only paint of cell and texel.
    only: u8,
    /// Sums of the squares of the texel's paints, of the sheet's, and of their products.
    squares: [f32; 2],
    products: f32,
}

impl Mixtures {
    /// How far the two mixtures are apart: 1 less the cosine of the angle between them.
    #[inline(always)]
    fn differs(&self) -> f32 {
        let [texel, sheet] = self.squares;
        1.0 - self.products / larger((texel * sheet).sqrt(), 1.0)
    }
}

impl Sheets {
    /// Weighs the upper sheets of cells under texels.
    pub(crate) fn weigh(
        &mut self,
        window: &Window,
        load: &BrushLoad,
        cells: &[u32],
        texels: impl Iterator<Item = (u32, OnTexel)> + Clone,
    ) {
        self.found.clear();
        let new = |(_, OnTexel { only, squares })| Mixtures {
            top: 0.0,
            only,
            squares: [squares, 0.0],
            products: 0.0,
        };
        self.found.extend(texels.clone().map(new));
        for (slot, plane) in window.planes() {
            let (upper, film) = (window.upper(slot), load.film_of(slot));
            let places = cells.iter().zip(texels.clone());
            for (found, (cell, (texel, _))) in self.found.iter_mut().zip(places) {
                let cell = *cell as usize;
                let lies = if plane[cell] > 0.0 { slot as u8 } else { NONE };
                found.only = besides(found.only, lies);
                let top = upper.map_or(0.0, |upper| smaller(upper[cell], plane[cell]));
                let on_texel = film.map_or(0.0, |film| film[texel as usize] as f32);
                found.top += top;
                found.squares[1] += top * top;
                found.products += top * on_texel;
            }
        }
    }

    /// How far the texels' mixtures are from those of the upper sheets, by contact, 0 to 1.
    pub(crate) fn differ(&self) -> impl Iterator<Item = f32> + Clone {
        self.found.iter().map(Mixtures::differs)
    }

    /// Parts them; `sheet` completes what is known of each contact, by its number, the quanta of its upper sheet and how
    /// far the texel's mixture is from it.
    pub(crate) fn part(&mut self, sheet: impl Fn(usize, f32, f32) -> SheetExchange) {
        self.parted.iter_mut().for_each(Vec::clear);
        for (i, found) in self.found.iter().enumerate() {
            let [from_top, from_body, kept, fits] = parted(&sheet(i, found.top, found.differs()));
            let fits = if found.only == SEVERAL { fits } else { 0.0 };
            let planes = self.parted.iter_mut();
            let parted = planes.zip([from_top, from_body, kept, fits]);
            parted.for_each(|(plane, value)| plane.push(value));
        }
    }
}

/// Share of an upper sheet that is left under so many quanta of other paint.
pub(crate) fn left_under(covered: f32) -> f32 {
    exp_f32(-covered * (1.0 / COVERS))
}
