//! Quantities and places in the words of a log.

use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::{BrushName, TICKS_A_SECOND, Ticks};
use maulstick_types::{Mixture, Region};

/// A surface by its number.
#[must_use]
pub fn surface(id: u32) -> String {
    match id {
        CANVAS => "canvas".to_owned(),
        PALETTE => "palette".to_owned(),
        other => format!("surface {other}"),
    }
}

/// A surface, or a part of it.
pub(super) fn place(id: u32, region: Option<&Region>) -> String {
    let of = surface(id);
    region.map_or_else(|| of.clone(), |region| format!("{of} within {region}"))
}

/// The brush whose steps are meant, if not those of all.
pub(super) fn of_brush(brush: Option<&BrushName>) -> String {
    brush.map_or_else(String::new, |brush| format!(" the newest step of {brush}"))
}

/// A mixture by the shares of its paints.
#[must_use]
pub fn mixture(mixture: &Mixture) -> String {
    let all: f64 = mixture.parts.iter().map(|part| part.share).sum();
    match &mixture.parts[..] {
        [only] => only.paint.clone(),
        parts => {
            let part = parts.iter().map(|part| {
                let share = percent(part.share / all);
                format!("{share} {}", part.paint)
            });
            part.collect::<Vec<_>>().join(", ")
        }
    }
}

/// A duration.
pub(super) fn time(ticks: Ticks) -> String {
    let seconds = f64::from(ticks.get()) / f64::from(TICKS_A_SECOND);
    format!("{} s", number(seconds))
}

/// A share in per cent.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", (share * 1e3).round() / 10.0)
}

/// A length in µm.
pub(super) fn um(metres: f64) -> f64 {
    number(metres * 1e6)
}

/// A length in mm.
pub(super) fn mm(metres: f64) -> f64 {
    number(metres * 1e3)
}

/// A number to a hundredth, without the noise of its last digits.
pub(super) fn number(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}
