//! A paint model's own planes as bytes.
//!
//! For each plane, in order of their shapes: its kind, the bytes of a value (4: floating point), and its values a cell,
//! as three numbers of 16 bits; then its bytes, each as the difference from that of the same plane of an older page.

use std::io::Read;

use maulstick_canvas::own_plane::{LAYERS_MOST, OwnPlane, OwnShape, ValueType};
use maulstick_canvas::planes::{Planes, TILE_CELLS};

use crate::tables::defect::Defect;

/// Size of a plane's header, bytes.
const HEAD: usize = 6;
/// Greatest size of all planes of a page, bytes.
const ALL_MOST: usize = 1 << 28;
/// Greatest size of planes that are not layers, bytes.
const OTHERS_MOST: usize = 1 << 20;

/// Greatest size of the planes of a mask's slots on a page: each paint may be in each layer.
pub(super) fn most(mask: u64) -> usize {
    let layers = mask.count_ones() as usize * LAYERS_MOST;
    (OTHERS_MOST + layers * (HEAD + TILE_CELLS * 4)).min(ALL_MOST)
}

fn older<'a>(base: Option<&'a Planes>, shape: &OwnShape) -> Option<&'a [u8]> {
    let mut planes = base?.own().iter();
    let found = planes.find(|plane| plane.shape == *shape);
    found.map(|plane| &*plane.bytes)
}

/// Bytes with those of an older page subtracted or added.
fn changed(bytes: &[u8], older: Option<&[u8]>, by: fn(u8, u8) -> u8) -> Vec<u8> {
    match older {
        Some(older) => bytes.iter().zip(older).map(|(a, b)| by(*a, *b)).collect(),
        None => bytes.to_vec(),
    }
}

/// Appends the model's own planes.
pub(super) fn append(planes: &Planes, base: Option<&Planes>, to: &mut Vec<u8>) {
    for plane in planes.own() {
        let OwnShape {
            kind,
            values,
            per_cell,
        } = plane.shape;
        for number in [kind, values.bytes() as u16, per_cell] {
            to.extend(number.to_le_bytes());
        }
        let older = older(base, &plane.shape);
        to.extend(changed(&plane.bytes, older, u8::wrapping_sub));
    }
}

/// Reads the head of a plane; `None` at the end.
fn head(from: &mut impl Read) -> std::io::Result<Option<[u8; HEAD]>> {
    let mut head = [0; HEAD];
    match from.read(&mut head[..1])? {
        0 => Ok(None),
        _ => from.read_exact(&mut head[1..]).map(|()| Some(head)),
    }
}

/// Reads what [`append`] wrote.
///
/// # Errors
/// [`Defect`].
pub(super) fn read(from: &mut impl Read, base: Option<&Planes>) -> Result<Vec<OwnPlane>, Defect> {
    let mut planes: Vec<OwnPlane> = Vec::new();
    while let Some(head) = head(from).map_err(|_| Defect::Torn)? {
        let [kind, size, per_cell] =
            [0, 2, 4].map(|at| u16::from_le_bytes([head[at], head[at + 1]]));
        let values = match size {
            1 => ValueType::U8,
            2 => ValueType::U16,
            4 => ValueType::F32,
            _ => return Err(Defect::Torn),
        };
        let shape = OwnShape {
            kind,
            values,
            per_cell,
        };
        let rises = planes.last().is_none_or(|last| last.shape < shape);
        if !rises || per_cell == 0 || shape.tile_bytes() > OTHERS_MOST {
            return Err(Defect::Torn);
        }
        let mut own = vec![0; shape.tile_bytes()];
        from.read_exact(&mut own).map_err(|_| Defect::Torn)?;
        let own = changed(&own, older(base, &shape), u8::wrapping_add);
        // Such a plane is never written: a file could pack any number of them into a few bytes.
        if own.iter().all(|byte| *byte == 0) {
            return Err(Defect::Empty);
        }
        planes.push(OwnPlane {
            shape,
            bytes: own.into(),
        });
    }
    Ok(planes)
}
