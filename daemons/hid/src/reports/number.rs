//! Numbers in reports, as lengths, angles and shares of their range.

use std::f64::consts::{PI, TAU};

use hidreport::VariableField;

use crate::units::{metres, radians};

/// No sensor of an angle has a range of less, rad: 10°.
const NARROWEST_RAD: f64 = PI / 18.0;

/// A number in a report.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    field: VariableField,
    pub(crate) least: f64,
    pub(crate) most: f64,
    /// Size of a count, m, where the unit is one of length.
    pub(crate) metres: Option<f64>,
    /// Size of a physical unit, rad, where it is one of angle.
    pub(crate) radians: Option<f64>,
    /// The physical range.
    pub(crate) physical: Option<[f64; 2]>,
}

impl Number {
    pub(crate) fn new(field: &VariableField) -> Option<Self> {
        if field.bits.is_empty() || field.bits.len() > 32 {
            return None;
        }
        let bits = field.bits.len();
        let (least, most) = (
            i32::from(field.logical_minimum),
            i32::from(field.logical_maximum),
        );
        let (least, most) = (f64::from(least), greatest(least, most, bits));
        if most <= least {
            return None;
        }
        let physical = match (field.physical_minimum, field.physical_maximum) {
            (Some(least), Some(most)) => {
                let (least, most) = (i32::from(least), i32::from(most));
                Some([f64::from(least), greatest(least, most, bits)])
            }
            _ => None,
        };
        let physical = physical.filter(|[low, high]| high > low);
        let unit = field.unit.map_or(0, u32::from);
        let exponent = field.unit_exponent.map_or(0, i32::from);
        // Without a physical range the logical one is it.
        let [low, high] = physical.unwrap_or([least, most]);
        let count = (high - low) / (most - least);
        Some(Self {
            field: field.clone(),
            least,
            most,
            metres: metres(unit, exponent).map(|unit| unit * count),
            radians: radians(unit, exponent),
            physical,
        })
    }

    /// Bytes of a report that has all of the field.
    pub(crate) fn end(&self) -> usize {
        self.field.bits.end.div_ceil(8)
    }

    /// The count, within the logical range.
    pub(crate) fn count(&self, report: &[u8]) -> f64 {
        if report.len() < self.end() {
            return self.least;
        }
        let Ok(value) = self.field.extract(report) else {
            return self.least;
        };
        let value = if self.field.is_signed() {
            f64::from(i32::from(value))
        } else {
            f64::from(u32::from(value))
        };
        value.clamp(self.least, self.most)
    }

    /// Share of the range, 0 to 1.
    pub(crate) fn share(&self, report: &[u8]) -> f64 {
        (self.count(report) - self.least) / (self.most - self.least)
    }

    /// The angles of the least and the greatest count, rad, as far as the descriptor has them: by its unit, or as degrees,
    /// where a range is signed and within ±`within`.
    fn range_rad(&self, within: f64) -> Option<[f64; 2]> {
        let logical = [self.least, self.most];
        let range = self.physical.unwrap_or(logical);
        let turn = |[low, high]: &[f64; 2]| {
            high - low >= NARROWEST_RAD && low.abs().max(high.abs()) <= 1.01 * TAU
        };
        let degrees = |[low, high]: [f64; 2]| {
            let fits = low < 0.0 && low.abs().max(high.abs()) <= within;
            fits.then(|| [low, high].map(f64::to_radians))
        };
        let by_unit = self.radians.map(|unit| range.map(|end| end * unit));
        by_unit
            .filter(turn)
            .or_else(|| degrees(range))
            .or_else(|| degrees(logical))
    }

    /// True if its range has values below 0.
    pub(crate) fn is_signed(&self) -> bool {
        self.least < 0.0 || self.physical.is_some_and(|[low, _]| low < 0.0)
    }

    /// An angle, rad. Where the descriptor does not tell, the range is `whole` rad wide, and `zero` of the way along an
    /// unsigned one is 0.
    pub(crate) fn angle(&self, report: &[u8], within: f64, whole: f64, zero: f64) -> f64 {
        let share = self.share(report);
        if let Some([low, high]) = self.range_rad(within) {
            return low + share * (high - low);
        }
        let zero = if self.is_signed() { 0.5 } else { zero };
        (share - zero) * whole
    }
}

/// The greatest value of a range for a field of so many bits. Where no value is negative, devices write it
/// without room for a sign, and Linux reads it so: it comes here as a negative one of 8, 16 or 32 bits.
fn greatest(least: i32, most: i32, bits: usize) -> f64 {
    let above = match most {
        _ if most >= least || least < 0 => 0_u64,
        -128..0 if bits <= 8 => 1 << 8,
        -32_768..0 => 1 << 16,
        _ => 1 << 32,
    };
    f64::from(most) + above as f64
}
