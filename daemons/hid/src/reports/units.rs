//! Units of report descriptors (HID 1.11, section 6.2.2.7): a code of nibbles, and an exponent of ten.

/// Size of one physical unit, m, if the unit is one of length.
#[must_use]
pub fn metres(unit: u32, exponent: i32) -> Option<f64> {
    let base = match unit {
        0x11 => 0.01,
        0x13 => 0.0254,
        _ => return None,
    };
    Some(base * ten_to(exponent)?)
}

/// Size of one physical unit, rad, if the unit is one of angle.
#[must_use]
pub fn radians(unit: u32, exponent: i32) -> Option<f64> {
    let base = match unit {
        0x12 => 1.0,
        0x14 => std::f64::consts::PI / 180.0,
        _ => return None,
    };
    Some(base * ten_to(exponent)?)
}

/// Exponents are nibbles of two's complement, and some devices write them as whole bytes.
fn ten_to(exponent: i32) -> Option<f64> {
    let exponent = match exponent {
        -8..=7 => exponent,
        8..=15 => exponent - 16,
        _ => return None,
    };
    Some(10_f64.powi(exponent))
}
