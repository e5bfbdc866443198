//! Units in which the window shows lengths. Thicknesses of films stay in micrometres.

use serde::{Deserialize, Serialize};

/// Units of lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Units {
    /// Millimetres for brushes, centimetres for canvases.
    #[default]
    Metric,
    /// Inches for both.
    Inches,
}

impl Units {
    /// Both, as a painter reads them.
    pub const WORDS: [(Self, &'static str); 2] = [
        (Self::Metric, tr_noop!("mm and cm")),
        (Self::Inches, tr_noop!("Inches")),
    ];

    /// Unit of small lengths: millimetres of one, displayed digits after the point, and its sign.
    #[must_use]
    pub fn small(self) -> (f64, usize, &'static str) {
        match self {
            Self::Metric => (1.0, 2, " mm"),
            Self::Inches => (25.4, 3, " in"),
        }
    }

    /// Unit of large lengths: metres of one, and its sign.
    #[must_use]
    pub fn large(self) -> (f64, &'static str) {
        match self {
            Self::Metric => (0.01, "cm"),
            Self::Inches => (0.0254, "in"),
        }
    }

    /// A width of a brush in words.
    #[must_use]
    pub fn width(self, width_mm: f64) -> String {
        let (unit_mm, decimals, sign) = self.small();
        let fine = 10f64.powi(decimals as i32);
        format!("{}{sign}", (width_mm / unit_mm * fine).round() / fine)
    }

    /// A number of large units for typing, from centimetres.
    #[must_use]
    pub fn typed(self, cm: f64) -> String {
        let (unit_m, _) = self.large();
        format!("{}", (cm / unit_m).round() / 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_said_in_either_unit() {
        assert_eq!(Units::Metric.width(12.5), "12.5 mm");
        assert_eq!(Units::Inches.width(12.7), "0.5 in");
        assert_eq!(Units::Metric.typed(29.7), "29.7");
        assert_eq!(Units::Inches.typed(29.7), "11.69");
    }
}
