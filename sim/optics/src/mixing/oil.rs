//! Share of oil in a paint from the tube, by its pigment.
//!
//! A pigment that takes up much oil makes a rich paint, which dries glossy; a lean one, whose pigment stands close,
//! dries matt (critical pigment volume concentration). Pigments are grouped as Winsor & Newton group their oil colours:
//! at most 50 %, 50 to 70 %, and 70 % or more.

/// Share of oil of an ordinary paint, and of one with unknown pigments, by volume.
pub const USUAL: f64 = 0.6;
/// Colour indices of lean and of rich paints; all others lie between.
const LEAN: [&str; 3] = ["PB29", "PB33", "PW1"];
const RICH: [&str; 11] = [
    "PBr7", "PB15", "PG7", "PG36", "PR83", "PV19", "PR122", "PB28", "PB36", "PV23", "PY129",
];

/// Share of oil in the paint with this colour index, by volume; several pigments have their mean.
#[must_use]
pub fn oil_share(colour_index: &str) -> f64 {
    let pigments = colour_index.split([',', '+', '/', ' ']);
    let shares: Vec<f64> = pigments
        .filter(|pigment| !pigment.is_empty())
        .map(|pigment| {
            let own = pigment.split(':').next().unwrap_or_default();
            if LEAN.contains(&own) {
                0.45
            } else if RICH.contains(&own) {
                0.75
            } else {
                USUAL
            }
        })
        .collect();
    if shares.is_empty() {
        return USUAL;
    }
    shares.iter().sum::<f64>() / shares.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lean_and_rich_pigments_are_known() {
        let shares = ["PB29", "PW6", "PB15:4", "PB29+PB15:1", "", "?"].map(oil_share);
        assert_eq!(shares, [0.45, 0.6, 0.75, 0.6, 0.6, 0.6]);
    }
}
