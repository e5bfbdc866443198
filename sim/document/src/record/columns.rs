//! Messages as columns: a row of the record before compression.
//!
//! States of a brush follow each other closely. The numbers of all their solves form one table, the angles of their
//! joints another, each as the difference from the solve before, and the bytes of a table are sorted by significance:
//! this makes a row a third smaller after compression. Messages that are not states, or would not be restored byte for
//! byte, are stored unchanged.
//!
//! Older rows have groups of messages ([`super::byte_transpose`]) in their place. A row of columns begins with 4 bytes
//! that no group begins with; then come the columns, each its length in 4 bytes and its bytes.

use maulstick_types::brush::{BrushState, Contact, Solve};
use maulstick_types::{Flags, Header, Origin, Pose, decode, encode};

use super::damaged;
use crate::error::DocumentError;

/// First bytes of a row of columns: a group of no messages.
const MARK: [u8; 4] = [0; 4];
/// Size of a message's index and length, bytes.
const PREFIX: usize = 12;

/// Kind of a message stored unchanged, with its index and length.
const AS_IT_IS: u8 = 0;
/// Kind of a message that is a brush state.
const STATE: u8 = 1;

/// Number of values of a state besides its solves, and of a solve besides angles and contacts.
const OF_STATE: usize = 11;
const OF_SOLVE: usize = 14;

/// Columns in the order of writing.
#[derive(Default)]
struct Columns {
    kinds: Vec<u8>,
    whole: Vec<u8>,
    /// Columns of states: index; flags, source, epoch, number and times of the header; device, its epoch and sample;
    /// number of solves.
    states: Vec<u8>,
    /// Columns of solves: time, stroke, surface, flags, bits of pose and zoom, numbers of joints and contacts.
    solves: Vec<u8>,
    /// Bits of two angles a joint.
    angles: Vec<u8>,
    /// Spine, joint and bits of the force of each contact.
    contacts: Vec<u8>,
}

/// Size of a value of each column, bytes.
const WIDTHS: [usize; 6] = [1, 1, 8 * OF_STATE, 8 * OF_SOLVE, 4, 8];

/// Last values, from which the next state and solve are differences.
#[derive(Default)]
struct Before {
    state: [u64; OF_STATE],
    solve: [u64; OF_SOLVE],
    angles: Vec<u32>,
}

/// Consecutive messages, each preceded by its index and length, as columns.
///
/// # Errors
/// [`DocumentError::Damaged`] if the last one is torn.
pub(super) fn columns(messages: &[u8]) -> Result<Vec<u8>, DocumentError> {
    let (mut columns, mut before) = (Columns::default(), Before::default());
    let mut rest = messages;
    while !rest.is_empty() {
        let (message, after) = split(rest)?;
        rest = after;
        match state_of(message) {
            Some((index, header, state)) => {
                columns.kinds.push(STATE);
                columns.put(index, &header, &state, &mut before);
            }
            None => {
                columns.kinds.push(AS_IT_IS);
                columns.whole.extend(message);
            }
        }
    }
    let mut row = MARK.to_vec();
    for (column, width) in columns.in_order().into_iter().zip(WIDTHS) {
        row.extend((column.len() as u32).to_le_bytes());
        row.extend((0..width).flat_map(|byte| column.iter().skip(byte).step_by(width)));
    }
    Ok(row)
}

/// The messages of [`columns`]; `None` for a row of groups.
///
/// # Errors
/// [`DocumentError::Damaged`] for other bytes.
pub(super) fn in_order(row: &[u8]) -> Result<Option<Vec<u8>>, DocumentError> {
    let Some(mut rest) = row.strip_prefix(&MARK) else {
        return Ok(None);
    };
    let torn = || damaged("is torn");
    let mut columns = WIDTHS.map(|_| Vec::new());
    for (column, width) in columns.iter_mut().zip(WIDTHS) {
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(torn)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (bytes, after) = after.split_at_checked(length).ok_or_else(torn)?;
        rest = after;
        if !length.is_multiple_of(width) {
            return Err(torn());
        }
        let count = length / width;
        column.extend((0..count).flat_map(|at| bytes.iter().skip(at).step_by(count)));
    }
    let [kinds, whole, states, solves, angles, contacts] = columns.each_ref().map(Vec::as_slice);
    let mut reading = Reading {
        whole,
        states,
        solves,
        angles,
        contacts,
    };
    let (mut messages, mut before) = (Vec::new(), Before::default());
    for kind in kinds {
        match *kind {
            AS_IT_IS => {
                let (message, after) = split(reading.whole)?;
                messages.extend(message);
                reading.whole = after;
            }
            STATE => {
                let (index, bytes) = reading.state(&mut before).ok_or_else(torn)?;
                messages.extend(index.to_le_bytes());
                messages.extend((bytes.len() as u32).to_le_bytes());
                messages.extend(bytes);
            }
            _ => return Err(torn()),
        }
    }
    if reading.is_at_its_end() && rest.is_empty() {
        Ok(Some(messages))
    } else {
        Err(torn())
    }
}

/// The first message, with its index and length, and the rest.
fn split(messages: &[u8]) -> Result<(&[u8], &[u8]), DocumentError> {
    let length = messages
        .get(8..PREFIX)
        .and_then(|bytes| bytes.first_chunk::<4>());
    let length = length.map(|length| PREFIX + u32::from_le_bytes(*length) as usize);
    let split = length.and_then(|length| messages.split_at_checked(length));
    split.ok_or_else(|| damaged("is torn"))
}

/// Index, header and content of a message that is a state and can be restored byte for byte.
fn state_of(message: &[u8]) -> Option<(u64, Header, BrushState)> {
    let (index, message) = (message.first_chunk::<8>()?, &message[PREFIX..]);
    let (header, state) = decode::<BrushState>(message).ok()?;
    let again = bytes_of(&header, &state)?;
    (again == message).then_some((u64::from_le_bytes(*index), header, state))
}

fn bytes_of(header: &Header, state: &BrushState) -> Option<Vec<u8>> {
    let Header {
        flags,
        seq,
        event_ns,
        sent_ns,
        ..
    } = *header;
    encode(&header.origin(), flags, seq, event_ns, sent_ns, state).ok()
}

/// Appends numbers as differences from those before.
fn put<const N: usize>(column: &mut Vec<u8>, now: [u64; N], before: &mut [u64; N]) {
    let pairs = now.iter().zip(before.iter());
    column.extend(pairs.flat_map(|(now, before)| now.wrapping_sub(*before).to_le_bytes()));
    *before = now;
}

/// Reads what [`put`] wrote.
fn take<const N: usize>(column: &mut &[u8], before: &mut [u64; N]) -> Option<[u64; N]> {
    for before in before.iter_mut() {
        let (difference, rest) = column.split_first_chunk::<8>()?;
        *before = before.wrapping_add(u64::from_le_bytes(*difference));
        *column = rest;
    }
    Some(*before)
}

impl Columns {
    fn in_order(self) -> [Vec<u8>; WIDTHS.len()] {
        [
            self.kinds,
            self.whole,
            self.states,
            self.solves,
            self.angles,
            self.contacts,
        ]
    }

    fn put(&mut self, index: u64, header: &Header, state: &BrushState, before: &mut Before) {
        let numbers = [
            index,
            u64::from(header.flags.0),
            u64::from(header.source),
            u64::from(header.epoch),
            header.seq,
            header.event_ns,
            header.sent_ns,
            u64::from(state.device),
            u64::from(state.device_epoch),
            state.device_seq,
            state.solves.len() as u64,
        ];
        put(&mut self.states, numbers, &mut before.state);
        for solve in &state.solves {
            let [x, y, z] = solve.pose.position_m.map(f64::to_bits);
            let [a, b, c, d] = solve.pose.orientation.map(f64::to_bits);
            let numbers = [
                solve.event_ns,
                solve.stroke,
                u64::from(solve.surface),
                u64::from(solve.flags),
                x,
                y,
                z,
                a,
                b,
                c,
                d,
                solve.zoom.to_bits(),
                solve.angles_rad.len() as u64,
                solve.contacts.len() as u64,
            ];
            put(&mut self.solves, numbers, &mut before.solve);
            let angles = solve.angles_rad.as_flattened();
            before.angles.resize(angles.len(), 0);
            for (angle, before) in angles.iter().zip(&mut before.angles) {
                let bits = angle.to_bits();
                self.angles.extend(bits.wrapping_sub(*before).to_le_bytes());
                *before = bits;
            }
            for contact in &solve.contacts {
                self.contacts.extend(contact.spine.to_le_bytes());
                self.contacts.extend(contact.joint.to_le_bytes());
                self.contacts
                    .extend(contact.force_n.to_bits().to_le_bytes());
            }
        }
    }
}

/// Unread parts of the columns.
struct Reading<'a> {
    whole: &'a [u8],
    states: &'a [u8],
    solves: &'a [u8],
    angles: &'a [u8],
    contacts: &'a [u8],
}

impl Reading<'_> {
    fn is_at_its_end(&self) -> bool {
        let left = [
            self.whole,
            self.states,
            self.solves,
            self.angles,
            self.contacts,
        ];
        left.iter().all(|column| column.is_empty())
    }

    /// Index and bytes of the next state; `None` if it is torn.
    fn state(&mut self, before: &mut Before) -> Option<(u64, Vec<u8>)> {
        let [
            index,
            flags,
            source,
            epoch,
            seq,
            event_ns,
            sent_ns,
            device,
            device_epoch,
            device_seq,
            count,
        ] = take(&mut self.states, &mut before.state)?;
        let word = |number: u64| u32::try_from(number).ok();
        let mut solves = Vec::new();
        for _ in 0..count {
            solves.push(self.solve(before)?);
        }
        let state = BrushState {
            device: word(device)?,
            device_epoch: word(device_epoch)?,
            device_seq,
            solves,
        };
        let origin = Origin {
            source: word(source)?,
            epoch: word(epoch)?,
        };
        let flags = Flags(flags.try_into().ok()?);
        let bytes = encode(&origin, flags, seq, event_ns, sent_ns, &state).ok()?;
        Some((index, bytes))
    }

    fn solve(&mut self, before: &mut Before) -> Option<Solve> {
        let [
            event_ns,
            stroke,
            surface,
            flags,
            x,
            y,
            z,
            a,
            b,
            c,
            d,
            zoom,
            joints,
            contacts,
        ] = take(&mut self.solves, &mut before.solve)?;
        let (joints, contacts) = (
            usize::try_from(joints).ok()?,
            usize::try_from(contacts).ok()?,
        );
        let (angles, rest) = self.angles.split_at_checked(joints.checked_mul(8)?)?;
        self.angles = rest;
        let (words, _) = angles.as_chunks::<4>();
        before.angles.resize(words.len(), 0);
        for (before, difference) in before.angles.iter_mut().zip(words) {
            *before = before.wrapping_add(u32::from_le_bytes(*difference));
        }
        let (pairs, _) = before.angles.as_chunks::<2>();
        let angles_rad = pairs.iter().map(|pair| pair.map(f32::from_bits)).collect();
        let (touching, rest) = self.contacts.split_at_checked(contacts.checked_mul(8)?)?;
        self.contacts = rest;
        let (touching, _) = touching.as_chunks::<8>();
        let contact = |[a, b, c, d, e, f, g, h]: &[u8; 8]| Contact {
            spine: u16::from_le_bytes([*a, *b]),
            joint: u16::from_le_bytes([*c, *d]),
            force_n: f32::from_bits(u32::from_le_bytes([*e, *f, *g, *h])),
        };
        Some(Solve {
            event_ns,
            stroke,
            surface: u32::try_from(surface).ok()?,
            flags: u32::try_from(flags).ok()?,
            pose: Pose {
                position_m: [x, y, z].map(f64::from_bits),
                orientation: [a, b, c, d].map(f64::from_bits),
            },
            zoom: f64::from_bits(zoom),
            angles_rad,
            contacts: touching.iter().map(contact).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn solve() -> impl Strategy<Value = Solve> {
        let numbers = (any::<u64>(), 0u64..3, 0u32..2, 0u32..32);
        let poses = (any::<[f64; 3]>(), any::<[f64; 4]>(), any::<f64>());
        let angles = prop::collection::vec(any::<[f32; 2]>(), 0..20);
        let contacts = prop::collection::vec((any::<u16>(), any::<u16>(), any::<f32>()), 0..5);
        let solve = (numbers, poses, angles, contacts);
        solve.prop_map(
            |(numbers, (position_m, orientation, zoom), angles_rad, contacts)| Solve {
                event_ns: numbers.0,
                stroke: numbers.1,
                surface: numbers.2,
                flags: numbers.3,
                pose: Pose {
                    position_m,
                    orientation,
                },
                zoom,
                angles_rad,
                contacts: contacts
                    .into_iter()
                    .map(|(spine, joint, force_n)| Contact {
                        spine,
                        joint,
                        force_n,
                    })
                    .collect(),
            },
        )
    }

    fn with_prefix(index: u64, bytes: &[u8]) -> Vec<u8> {
        let mut message = index.to_le_bytes().to_vec();
        message.extend((bytes.len() as u32).to_le_bytes());
        message.extend(bytes);
        message
    }

    /// A state, or bytes that are not one.
    fn message() -> impl Strategy<Value = Vec<u8>> {
        let state = (
            any::<[u64; 5]>(),
            any::<[u32; 4]>(),
            prop::collection::vec(solve(), 0..4),
        );
        let state = state.prop_map(|(wide, narrow, solves)| {
            let origin = Origin {
                source: narrow[0],
                epoch: narrow[1],
            };
            let state = BrushState {
                device: narrow[2],
                device_epoch: narrow[3],
                device_seq: wide[0],
                solves,
            };
            let bytes = encode(&origin, Flags::REPLAY, wide[1], wide[2], wide[3], &state);
            with_prefix(wide[4], &bytes.expect("it fits"))
        });
        let other = (any::<u64>(), prop::collection::vec(any::<u8>(), 0..60));
        prop_oneof![3 => state, 1 => other.prop_map(|(index, bytes)| with_prefix(index, &bytes))]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]

        #[test]
        fn messages_come_back_byte_for_byte(messages in prop::collection::vec(message(), 0..12)) {
            let all = messages.concat();
            let row = columns(&all).expect("whole");
            prop_assert_eq!(in_order(&row).expect("whole"), Some(all.clone()));
            if let Some(torn) = all.len().checked_sub(1) {
                prop_assert!(columns(&all[..torn]).is_err());
            }
            for end in (MARK.len()..row.len()).step_by(7) {
                prop_assert!(in_order(&row[..end]).is_err(), "{}", end);
            }
        }

        #[test]
        fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            in_order(&bytes).ok();
            in_order(&[&MARK[..], &bytes].concat()).ok();
        }
    }

    #[test]
    fn groups_of_before_are_left_to_their_reader() {
        assert_eq!(in_order(&[1, 0, 0, 0, 12, 0, 0, 0]).expect("another"), None);
    }
}
