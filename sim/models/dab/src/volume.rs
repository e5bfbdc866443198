//! Volumes: whole units of paint on a cell, 8 bits a layer (Baxter 2004, § 4.4).
//!
//! Paint is counted in quanta by slot as in every model; dAb moves it in units of [`UNIT`] of them. Additive colour is
//! linear in the volumes of the paints, so the RGB textures follow from the counts.

/// Quanta of a unit: .76 µm on a cell, a difference that is not visible.
pub const UNIT: f32 = 512.0;
/// Most units of a layer: 195 µm. Any excess on a brush's surface waits there as in the reservoir.
pub const MOST: f32 = 255.0;
/// Units of the surface layer in one unit of the reservoir.
pub const RESERVOIR_UNIT: f32 = 32.0;
/// Units of an opaque layer, 1/O_t of eq. 4.1: 49 µm.
pub const OPAQUE: f32 = 64.0;

/// Units of a number of quanta; more than a layer's capacity counts as full.
#[must_use]
pub fn units(quanta: f32) -> u8 {
    (quanta / UNIT) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volumes_saturate_and_do_not_wrap() {
        assert_eq!([0.0, UNIT - 1.0, UNIT, 3.5 * UNIT].map(units), [0, 0, 1, 3]);
        assert_eq!(
            [255.0 * UNIT, 256.0 * UNIT, 1e12, -5.0].map(units),
            [255, 255, 255, 0]
        );
    }
}
