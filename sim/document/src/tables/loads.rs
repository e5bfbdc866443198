//! Load of a brush as bytes: little-endian numbers of 32 bits, compressed.
//!
//! Number of texels, number of slots, steps (two numbers, the low word first); the films of all paints; then for each
//! slot its number, its films and its paint inside; then the angles of the permanent set as floats, if there are any.

use maulstick_canvas::quantum::SLOTS;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::{STRIPS_MOST, TEXELS_PER_STRIP};

use super::defect::Defect;

/// Greatest number of texels of a head, for the greatest number of strips of a brush.
const TEXELS_MAX: usize = STRIPS_MOST * TEXELS_PER_STRIP;

/// Pairs of angles of a permanent set at most: more than a head has joints, with its core and their anchors.
const SET_MAX: usize = 2048;

/// A load as bytes.
///
/// # Errors
/// The error of the compressor.
pub fn encode(load: &BrushLoad, level: i32) -> std::io::Result<Vec<u8>> {
    let slots: Vec<usize> = (0..SLOTS).filter(|slot| load.has(*slot)).collect();
    let steps = load.steps();
    let mut words = vec![
        load.texels() as u32,
        slots.len() as u32,
        steps as u32,
        (steps >> 32) as u32,
    ];
    words.extend(load.films());
    for slot in slots {
        words.push(slot as u32);
        words.extend(load.film_of(slot).unwrap_or_default());
        words.extend(load.inside(slot).unwrap_or_default());
    }
    words.extend(load.set.as_flattened().iter().map(|angle| angle.to_bits()));
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    zstd::bulk::compress(&bytes, level)
}

/// Reads a load.
///
/// # Errors
/// [`Defect`].
pub fn decode(bytes: &[u8]) -> Result<BrushLoad, Defect> {
    let most = 4 * (4 + (2 * SLOTS + 1) * (TEXELS_MAX + 1) + 2 * SET_MAX);
    let bytes = zstd::bulk::decompress(bytes, most)?;
    let four = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let words: Vec<u32> = bytes.chunks_exact(4).map(four).collect();
    let (head, mut rest) = words.split_at_checked(4).ok_or(Defect::Load)?;
    let texels = head[0] as usize;
    let mut take = |count: usize| -> Result<Vec<u32>, Defect> {
        let (taken, left) = rest.split_at_checked(count).ok_or(Defect::Load)?;
        rest = left;
        Ok(taken.to_vec())
    };
    let films = take(texels)?;
    let mut planes = Vec::new();
    for _ in 0..head[1].min(SLOTS as u32) {
        let slot = take(1)?[0] as usize;
        planes.push((slot, [take(texels)?, take(texels)?]));
    }
    let steps = u64::from(head[2]) | u64::from(head[3]) << 32;
    let mut load = BrushLoad::of_planes(steps, films, planes).ok_or(Defect::Load)?;
    let (set, odd) = rest.as_chunks::<2>();
    load.set = set.iter().map(|pair| pair.map(f32::from_bits)).collect();
    if !odd.is_empty()
        || load.set.len() > SET_MAX
        || !load
            .set
            .as_flattened()
            .iter()
            .all(|angle| angle.is_finite())
    {
        return Err(Defect::Load);
    }
    Ok(load)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_comes_back_and_damage_is_seen() {
        let mut load = BrushLoad::clean(40);
        (0..600).for_each(|texel| load.add_film(3 + texel % 2, texel, (texel * texel) as u32));
        load.count_films();
        (0..9).for_each(|_| load.count_step());
        load.set = vec![[0.01, -0.02], [0.0, 0.03]];
        let bytes = encode(&load, 1).expect("bytes");
        assert_eq!(decode(&bytes).expect("whole"), load);
        assert!(decode(&bytes[..bytes.len() - 9]).is_err());
        assert!(decode(&zstd::bulk::compress(&[1; 100], 1).expect("bytes")).is_err());
    }
}
