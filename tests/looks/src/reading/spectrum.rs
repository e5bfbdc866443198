//! Power of a relief by wavelength.

use std::f64::consts::TAU;

use maulstick_num::{cos, sin};

use crate::map::Map;

/// The lines of a map along an axis, each less its mean and under a Hann window.
fn lines(map: &Map, axis: usize) -> Vec<Vec<f64>> {
    let length = map.size[axis];
    let (step, next) = [(1, map.size[0]), (map.size[0], 1)][axis];
    let hann = |k: usize| 0.5 - 0.5 * cos(TAU * (k as f64 + 0.5) / length as f64);
    let line = |number: usize| -> Vec<f64> {
        let cells = (0..length).map(|k| f64::from(map.cells[number * next + k * step]));
        let mean = cells.clone().sum::<f64>() / length as f64;
        let windowed = cells.enumerate().map(|(k, value)| (value - mean) * hann(k));
        windowed.collect()
    };
    (0..map.size[1 - axis]).map(line).collect()
}

/// Mean power of the lines along an axis at each of these whole numbers of waves: the squares of the values' shares.
pub(crate) fn power(map: &Map, axis: usize, waves: impl Iterator<Item = usize>) -> Vec<f64> {
    let (lines, length) = (lines(map, axis), map.size[axis]);
    // A Hann window leaves 3/8 of the power.
    let scale = 2.0 / (0.375 * (length * length) as f64 * lines.len().max(1) as f64);
    let of = |wave: usize| {
        let turns = (0..length).map(|k| TAU * (wave * k % length) as f64 / length as f64);
        let turns: Vec<[f64; 2]> = turns.map(|turn| [cos(turn), sin(turn)]).collect();
        let line = |line: &Vec<f64>| {
            let sum = |i: usize| -> f64 { line.iter().zip(&turns).map(|(v, t)| v * t[i]).sum() };
            sum(0) * sum(0) + sum(1) * sum(1)
        };
        scale * lines.iter().map(line).sum::<f64>()
    };
    waves.map(of).collect()
}

/// Root mean square of the waves along an axis from `from_mm` up to `to_mm` long, in the map's unit.
#[must_use]
pub fn band_rms(map: &Map, axis: usize, [from_mm, to_mm]: [f64; 2]) -> f64 {
    let length_mm = map.size[axis] as f64 * map.cell_mm;
    let least = (length_mm / to_mm).ceil() as usize;
    let most = ((length_mm / from_mm).floor() as usize).min(map.size[axis] / 2);
    power(map, axis, least..=most).iter().sum::<f64>().sqrt()
}

/// Power along an axis at waves of `wave_mm`, within a twentieth, by that of the waves a quarter longer and shorter: 1
/// where nothing repeats.
#[must_use]
pub fn peak(map: &Map, axis: usize, wave_mm: f64) -> f64 {
    let length_mm = map.size[axis] as f64 * map.cell_mm;
    let mean = |low: f64, high: f64| {
        let most = map.size[axis] / 2;
        let from = ((length_mm / wave_mm * low).round() as usize).clamp(1, most);
        let to = ((length_mm / wave_mm * high).round() as usize).clamp(from, most);
        let found = power(map, axis, from..=to);
        found.iter().sum::<f64>() / found.len() as f64
    };
    let beside = 0.5 * (mean(0.75, 0.9) + mean(1.1, 1.25));
    mean(0.95, 1.05) / beside.max(1e-12)
}
