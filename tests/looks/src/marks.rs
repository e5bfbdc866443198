//! The measurements: each paints a few strokes and reads films and heights.

use maulstick_rig::UserError;

use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Fill, FillPaint};
use maulstick_types::values::FilmThickness;

use crate::easel::{Easel, Stroke, brush};
use crate::map::{Map, correlation, slope};
use crate::reading::colour::streaks;

/// Name, value, unit.
pub type Number = (&'static str, f64, &'static str);
/// A measurement.
pub type Measure = fn(Trial) -> Result<Vec<Number>, UserError>;

/// Conditions of a measurement.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Side of a cell, mm.
    pub cell_mm: f64,
    /// Painter of the trial.
    pub painter: Painter,
}

/// Painter of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Painter {
    /// One who follows the measurement's instructions.
    Able,
    /// One with too little paint, too heavy a hand or the wrong tool: the seeded fault of each number.
    Faulty,
}

impl Trial {
    /// One of two values, for each painter.
    fn pick<T>(self, able: T, faulty: T) -> T {
        match self.painter {
            Painter::Able => able,
            Painter::Faulty => faulty,
        }
    }
}

/// All of them.
pub const ALL: [Measure; 9] = [
    long_strokes,
    six_loads,
    dry_brush,
    scumble,
    knife,
    separate_loads,
    through_wet,
    three_strokes,
    glosses,
];

const PAINT: &str = "Ultramarine Blue=0.6,Titanium White=0.4";

/// Long strokes of a 14 mm flat, each fully loaded: films, roughness, filling of the tooth. Bristles differ in each, so
/// the numbers are means of several.
pub fn long_strokes(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut flat = brush("flat", 14.0)?;
    flat.load.film_um *= trial.pick(1.0, 0.1);
    let mut easel = Easel::new([190.0, 105.0], trial.cell_mm, "linen", flat)?;
    let heights = [15.0, 40.0, 65.0, 90.0];
    for y in heights {
        easel.load(PAINT)?;
        easel.stroke(&Stroke::along(y, 15.0, 175.0, 0.5))?;
    }
    let (film, ground) = (easel.film(None), easel.ground());
    let strokes = heights.map(|y| long_stroke(&film, &ground, y));
    let mean = |number: usize| {
        let sum: f64 = strokes.iter().map(|stroke| stroke[number].1).sum();
        sum / strokes.len() as f64
    };
    let numbers = strokes[0].iter().enumerate();
    Ok(numbers
        .map(|(number, (name, _, unit))| (*name, mean(number), *unit))
        .collect())
}

/// The numbers of a stroke along x from 15 mm, at a height of `y` mm.
fn long_stroke(film: &Map, ground: &Map, y: f64) -> [Number; 11] {
    let at = |mm: f64| {
        film.cut([15.0 + mm - 1.0, y - 4.0], [15.0 + mm + 1.0, y + 4.0])
            .mean()
    };
    let thick = ([28.0, y - 3.0], [48.0, y + 3.0]);
    let surface = film.plus(ground).cut(thick.0, thick.1);
    let [below, above] = [ground, film].map(|map| map.cut(thick.0, thick.1));
    let fill = slope(&below.cells, &above.cells);
    // Streaks lie along the stroke like threads of the weave, so rows are compared separately.
    let [below, above] = [below, above].map(Map::less_rows);
    let in_rows = slope(&below.cells, &above.cells);
    [
        ("film_um.2mm", at(2.0), "um"),
        ("film_um.10mm", at(10.0), "um"),
        ("film_um.30mm", at(30.0), "um"),
        ("film_um.60mm", at(60.0), "um"),
        ("film_um.150mm", at(150.0), "um"),
        ("tooth_fill", fill, ""),
        ("tooth_fill.in_rows", in_rows, ""),
        ("rough_um.along", rough(&surface, 0), "um"),
        ("rough_um.across", rough(&surface, 1), "um"),
        ("ridges", rough(&surface, 1) / rough(&surface, 0), ""),
        ("towers_um", towers(&surface), "um"),
    ]
}

/// Roughness below 1 mm of wavelength along an axis, rms µm: heights less their running mean.
pub fn rough(map: &Map, axis: usize) -> f64 {
    let half = ((0.5 / map.cell_mm).round() as usize).max(1);
    let (step, lines) = match axis {
        0 => (1, map.size[1]),
        _ => (map.size[0], map.size[0]),
    };
    let length = map.size[axis];
    let (mut sum, mut count) = (0.0, 0.0);
    for line in 0..lines {
        let start = if axis == 0 { line * map.size[0] } else { line };
        let at = |k: usize| f64::from(map.cells[start + k * step]);
        for k in half..length - half {
            let mean = (k - half..=k + half).map(at).sum::<f64>() / (2 * half + 1) as f64;
            sum += (at(k) - mean) * (at(k) - mean);
            count += 1.0;
        }
    }
    f64::sqrt(sum / f64::max(count, 1.0))
}

/// The 99.9th percentile of |height − median of its 3×3|, µm.
pub fn towers(map: &Map) -> f64 {
    let [width, height] = map.size;
    let mut off = Vec::new();
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let mut around: Vec<f32> = (0..9)
                .map(|k| map.cells[(y + k / 3 - 1) * width + x + k % 3 - 1])
                .collect();
            let own = around[4];
            around.sort_by(f32::total_cmp);
            off.push((own - around[4]).abs());
        }
    }
    off.sort_by(f32::total_cmp);
    f64::from(off[(off.len() as f64 * 0.999) as usize])
}

/// Six full loads on one petal.
pub fn six_loads(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([50.0, 30.0], trial.cell_mm, "linen", brush("flat", 14.0)?)?;
    for load in 0..6 {
        if load < trial.pick(6, 1) {
            easel.load(PAINT)?;
        }
        easel.stroke(&Stroke::along(15.0, 14.0, 34.0, 0.4))?;
    }
    let (film, ground) = (easel.film(None), easel.ground());
    let middle = ([17.0, 11.0], [30.0, 19.0]);
    let surface = film.plus(&ground).cut(middle.0, middle.1);
    Ok(vec![
        ("six_loads_um", film.cut(middle.0, middle.1).mean(), "um"),
        ("six_loads_towers_um", towers(&surface), "um"),
    ])
}

/// Share of a load used by three strokes of 120 mm.
pub fn three_strokes(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([160.0, 70.0], trial.cell_mm, "linen", brush("flat", 14.0)?)?;
    easel.load(PAINT)?;
    let held = |easel: &mut Easel| {
        let painting = easel.offline.painting_mut();
        painting.commit();
        painting
            .carried()
            .map(|(_, carried)| carried.load.total() as f64)
            .sum::<f64>()
    };
    let before = held(&mut easel);
    for row in 0..3 {
        easel.stroke(&Stroke::along(
            15.0 + 20.0 * f64::from(row),
            20.0,
            trial.pick(140.0, 30.0),
            0.5,
        ))?;
    }
    let after = held(&mut easel);
    Ok(vec![("load_used_share", 1.0 - after / before, "")])
}

/// Cells covered by more than a film, by height of the ground: of all, of the lowest and of the highest tenth; and the
/// ratio of paint on the highest.
pub(crate) fn by_height(film: &Map, ground: &Map) -> [f64; 4] {
    const COVERED_UM: f32 = 1.5;
    let mut order: Vec<usize> = (0..film.cells.len()).collect();
    order.sort_by(|a, b| ground.cells[*a].total_cmp(&ground.cells[*b]));
    let tenth = order.len() / 10;
    let covered = |part: &[usize]| {
        let count = part.iter().filter(|i| film.cells[**i] > COVERED_UM).count();
        count as f64 / part.len() as f64
    };
    let mean = |part: &[usize]| {
        part.iter().map(|i| f64::from(film.cells[*i])).sum::<f64>() / part.len() as f64
    };
    let (low, high) = (&order[..tenth], &order[order.len() - tenth..]);
    [
        covered(&order),
        covered(low),
        covered(high),
        mean(high) / mean(low).max(1e-3),
    ]
}

/// Share of its load on a brush that is nearly empty.
const NEARLY_EMPTY: f64 = 0.15;

/// A nearly empty brush, lightly.
pub fn dry_brush(trial: Trial) -> Result<Vec<Number>, UserError> {
    let flat = brush("flat", 14.0)?.wiped(trial.pick(NEARLY_EMPTY, 1.0));
    let mut easel = Easel::new([115.0, 24.0], trial.cell_mm, "linen", flat)?;
    easel.load(PAINT)?;
    easel.stroke(&Stroke::along(12.0, 15.0, 100.0, trial.pick(0.01, 0.8)))?;
    let part = ([30.0, 8.0], [80.0, 16.0]);
    let (film, ground) = (
        easel.film(None).cut(part.0, part.1),
        easel.ground().cut(part.0, part.1),
    );
    let [all, low, high, ratio] = by_height(&film, &ground);
    Ok(vec![
        ("dry_brush.film", film.mean(), "um"),
        ("dry_brush.covered", all, ""),
        ("dry_brush.covered_low", low, ""),
        ("dry_brush.covered_high", high, ""),
        ("dry_brush.high_by_low", ratio, ""),
    ])
}

/// White lightly over dried ridges.
pub fn scumble(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([100.0, 64.0], trial.cell_mm, "linen", brush("round", 6.0)?)?;
    for row in 0..12 {
        easel.load("Burnt Umber")?;
        let y = 18.0 + 2.5 * f64::from(row);
        for _ in 0..2 {
            easel.stroke(&Stroke::along(y, 20.0, 80.0, 0.15))?;
        }
    }
    easel.dry()?;
    easel.take_up(
        "white",
        brush("flat", 14.0)?.wiped(trial.pick(NEARLY_EMPTY, 1.0)),
    )?;
    easel.load("Titanium White")?;
    for x in [35.0, 48.0, 61.0] {
        easel.stroke(&Stroke {
            from: [x, 10.0],
            to: [x, 54.0],
            pressure: trial.pick(0.01, 0.8),
            lean_deg: 25.0,
        })?;
    }
    let part = ([30.0, 20.0], [66.0, 44.0]);
    let (film, ground) = (
        easel.film(None).cut(part.0, part.1),
        easel.ground().cut(part.0, part.1),
    );
    let [all, low, high, ratio] = by_height(&film, &ground);
    let mut heights = ground.cells.clone();
    heights.sort_by(f32::total_cmp);
    let relief = heights[heights.len() * 95 / 100] - heights[heights.len() * 5 / 100];
    Ok(vec![
        ("scumble.relief", f64::from(relief), "um"),
        ("scumble.covered", all, ""),
        ("scumble.covered_low", low, ""),
        ("scumble.covered_high", high, ""),
        ("scumble.high_by_low", ratio, ""),
    ])
}

/// A clean knife through a level film.
pub fn knife(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new(
        [90.0, 50.0],
        trial.cell_mm,
        "linen",
        brush(trial.pick("knife", "flat"), 16.0)?,
    )?;
    easel.edit(Fill {
        paint: FillPaint::Mixture {
            mixture: PAINT
                .parse()
                .map_err(|error| UserError::failure(format!("{error}")))?,
        },
        thickness: FilmThickness::new(500e-6)?,
        surface: 0,
    })?;
    easel.stroke(&Stroke::along(25.0, 15.0, 75.0, 0.5))?;
    let part = ([30.0, 22.0], [60.0, 28.0]);
    let (film, ground) = (easel.film(None), easel.ground());
    let surface = film.plus(&ground).cut(part.0, part.1);
    let beads = [17.5, 32.5].map(|y| film.cut([30.0, y - 4.0], [60.0, y + 4.0]));
    let highest = |map: &Map| map.profile(1).into_iter().fold(0.0, f64::max);
    Ok(vec![
        ("knife_left_um", film.cut(part.0, part.1).mean(), "um"),
        ("knife_rough_um", rough(&surface, 0), "um"),
        (
            "knife_bead_um",
            highest(&beads[0]).min(highest(&beads[1])),
            "um",
        ),
    ])
}

/// Streak profiles of separate loads.
pub fn separate_loads(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([70.0, 100.0], trial.cell_mm, "linen", brush("flat", 14.0)?)?;
    let mut profiles = Vec::new();
    for row in 0..4 {
        if trial.painter == Painter::Faulty {
            // Each stroke is the first one on a canvas of its own.
            easel = Easel::new([70.0, 100.0], trial.cell_mm, "linen", brush("flat", 14.0)?)?;
        }
        easel.load(PAINT)?;
        let y = 15.0 + 23.0 * f64::from(row);
        easel.stroke(&Stroke::along(y, 15.0, 55.0, 0.5))?;
        profiles.push(
            easel
                .film(None)
                .cut([28.0, y - 5.0], [45.0, y + 5.0])
                .profile(1),
        );
    }
    let mut most: f64 = 0.0;
    for i in 0..4 {
        for j in 0..i {
            most = most.max(correlation(&profiles[i], &profiles[j]));
        }
    }
    Ok(vec![("streaks.correlation", most, "")])
}

/// Standard deviation of the dry gloss of the measured paints; the faulty painter has one pigment.
pub fn glosses(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([8.0, 8.0], trial.cell_mm, "linen", brush("flat", 4.0)?)?;
    let library =
        PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))?;
    let mut all = Vec::new();
    for paint in library.paints() {
        let name = trial.pick(paint.name.as_str(), "Titanium White");
        easel.load(name)?;
        let slot = easel.slot(name)?;
        all.push(f64::from(easel.look().gloss(slot)));
    }
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let off = all.iter().map(|gloss| (gloss - mean) * (gloss - mean));
    let deviation = (off.sum::<f64>() / all.len() as f64).sqrt();
    Ok(vec![("gloss_span", deviation, "")])
}

/// White through wet blue.
pub fn through_wet(trial: Trial) -> Result<Vec<Number>, UserError> {
    let mut easel = Easel::new([80.0, 50.0], trial.cell_mm, "linen", brush("flat", 14.0)?)?;
    for y in [15.0, 25.0, 35.0] {
        easel.load(trial.pick("Ultramarine Blue", PAINT))?;
        easel.stroke(&Stroke::along(y, 15.0, 65.0, 0.5))?;
    }
    easel.take_up("white", brush("flat", 10.0)?)?;
    easel.load(trial.pick("Titanium White", PAINT))?;
    easel.stroke(&Stroke::along(25.0, 15.0, 65.0, 0.5))?;
    let part = ([38.0, 21.0], [50.0, 29.0]);
    let [blue, white] = [0, 1].map(|slot| easel.upper(slot).cut(part.0, part.1));
    let share = blue.mean() / (blue.mean() + white.mean());
    Ok(vec![
        ("through_wet.blue", share, ""),
        ("through_wet.streaks", streaks(&blue, &white), ""),
    ])
}
