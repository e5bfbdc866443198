//! Colours as three mantissas and their common exponent: Ward 1991, *Real pixels*, as in Radiance's files.

/// Exponent of 1/256, by which mantissas are whole.
const BIAS: i32 = 128 + 8;
/// Radiance below which all is black.
const DARKEST: f32 = 1e-30;

/// Bytes of a colour; what is negative or NaN is 0.
pub(super) fn encode(colour: &[f32; 3]) -> [u8; 4] {
    let colour = colour.map(|v| if v > 0.0 { v } else { 0.0 });
    let most = colour.into_iter().fold(0.0, f32::max);
    if most < DARKEST {
        return [0; 4];
    }
    // The exponent at which the largest mantissa is of 128 to 255.
    let bits = ((most.to_bits() >> 23) & 0xff) as i32 - 126;
    let exponent = bits + i32::from((most * power(8 - bits)).round() > 255.0);
    let [r, g, b] = colour.map(|v| (v * power(8 - exponent)).round().min(255.0) as u8);
    [r, g, b, (exponent + 128).min(255) as u8]
}

/// Colour of bytes.
pub(super) fn decode([r, g, b, exponent]: &[u8; 4]) -> [f32; 3] {
    if *exponent == 0 {
        return [0.0; 3];
    }
    let unit = power(i32::from(*exponent) - BIAS);
    [r, g, b].map(|v| f32::from(*v) * unit)
}

/// 2 to the power `n`, within the normal numbers.
fn power(n: i32) -> f32 {
    f32::from_bits(((n.clamp(-126, 127) + 127) as u32) << 23)
}
