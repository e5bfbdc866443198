//! Share of oil in a paint from the tube, by its pigment.
//!
//! A pigment that takes up much oil makes a rich paint, which dries glossy; a lean one, whose pigment stands close,
//! dries matt. Winsor & Newton group oil colours by their oil: at most 50 % (ultramarine, manganese blue, flake white),
//! 50 to 70 % (cadmiums, chromium oxide, ivory black), 70 % or more (siennas, burnt umber, phthalo blue and green,
//! alizarin, rose, cobalt), as artcenterinformation.com lists them (2012). Other pigments count as of the middle group.

/// Share of oil in a paint of the middle group, and in one with unknown pigments.
pub const USUAL: f64 = 0.6;
/// Shares of oil in a lean and in a rich paint, within their groups.
const LEAN_SHARE: f64 = 0.45;
const RICH_SHARE: f64 = 0.75;
/// Colour indices of lean and of rich paints.
const LEAN: [&str; 3] = ["PB29", "PB33", "PW1"];
const RICH: [&str; 7] = ["PBr7", "PB15", "PG7", "PG36", "PR83", "PV19", "PB28"];

/// Share of oil in the paint with this colour index; several pigments have their mean.
#[must_use]
pub fn oil_share(colour_index: &str) -> f64 {
    let pigments = colour_index.split([',', '+', '/', ' ']);
    let shares: Vec<f64> = pigments
        .filter(|pigment| !pigment.is_empty())
        .map(|pigment| {
            let own = pigment.split(':').next().unwrap_or_default();
            if LEAN.contains(&own) {
                LEAN_SHARE
            } else if RICH.contains(&own) {
                RICH_SHARE
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
