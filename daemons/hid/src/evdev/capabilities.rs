//! Axes and keys of an event device, and the same as bytes.

use evdev::{AbsoluteAxisCode, KeyCode};

/// The first bytes.
const MARK: &[u8; 4] = b"evd1";
/// Bytes of an axis.
const AXIS_BYTES: usize = 14;

/// Range of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// `ABS_*`.
    pub code: u16,
    /// Least and greatest value.
    pub range: [i32; 2],
    /// Counts a millimetre, or a radian of tilts and rotations; 0 if the device does not say.
    pub resolution: i32,
}

impl Axis {
    /// Its values from least to greatest, counts; `None` if there is but one.
    #[must_use]
    pub fn counts(&self) -> Option<f64> {
        let [least, most] = self.range.map(f64::from);
        (most > least).then_some(most - least)
    }
}

/// Axes and keys of a device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Capabilities {
    /// Axes.
    pub axes: Vec<Axis>,
    /// `KEY_*` and `BTN_*`.
    pub keys: Vec<u16>,
}

impl Capabilities {
    /// An axis, if the device has it and it can move.
    #[must_use]
    pub fn axis(&self, code: AbsoluteAxisCode) -> Option<Axis> {
        let mut axes = self.axes.iter();
        let found = axes.find(|axis| axis.code == code.0).copied();
        found.filter(|axis| axis.counts().is_some())
    }

    /// True if the device has a key.
    #[must_use]
    pub fn has(&self, key: KeyCode) -> bool {
        self.keys.contains(&key.0)
    }

    /// As bytes, little endian: a mark, the number of axes, each axis (code, least, most, resolution), the keys.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MARK.to_vec();
        let count = u16::try_from(self.axes.len()).unwrap_or(u16::MAX);
        bytes.extend(count.to_le_bytes());
        for axis in self.axes.iter().take(count.into()) {
            bytes.extend(axis.code.to_le_bytes());
            for number in [axis.range[0], axis.range[1], axis.resolution] {
                bytes.extend(number.to_le_bytes());
            }
        }
        bytes.extend(self.keys.iter().flat_map(|key| key.to_le_bytes()));
        bytes
    }

    /// Reads those bytes; `None` if they are others.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let rest = bytes.strip_prefix(MARK)?;
        let (count, rest) = rest.split_first_chunk()?;
        let length = usize::from(u16::from_le_bytes(*count)) * AXIS_BYTES;
        let (axes, keys) = rest.split_at_checked(length)?;
        let word = |bytes: &[u8]| Some(u16::from_le_bytes(bytes.try_into().ok()?));
        let number = |bytes: &[u8]| Some(i32::from_le_bytes(bytes.try_into().ok()?));
        let axis = |bytes: &[u8]| {
            Some(Axis {
                code: word(&bytes[..2])?,
                range: [number(&bytes[2..6])?, number(&bytes[6..10])?],
                resolution: number(&bytes[10..])?,
            })
        };
        Some(Self {
            axes: axes.chunks_exact(AXIS_BYTES).filter_map(axis).collect(),
            keys: keys.chunks_exact(2).filter_map(word).collect(),
        })
    }
}

/// The numbers of the bits that are set: hexadecimal words of 64 bits, the highest first.
pub(super) fn bits(text: &str) -> Vec<u16> {
    let words = text.split_whitespace().rev().enumerate();
    let of = |(place, word): (usize, &str)| {
        let word = u64::from_str_radix(word, 16).unwrap_or(0);
        let set = (0..64_u16).filter(move |bit| word >> bit & 1 == 1);
        let first = u16::try_from(64 * place).unwrap_or(u16::MAX);
        set.map(move |bit| first.saturating_add(bit))
    };
    words.flat_map(of).collect()
}
