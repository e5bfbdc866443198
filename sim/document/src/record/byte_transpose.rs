//! Rows of the record that programs of schema 5 wrote: messages of the same length byte by byte, all first bytes, all second
//! bytes, and so on.
//!
//! A group is the number of messages and their length, with index and length of each, as 4 bytes each, and then their bytes.

use super::damaged;
use crate::error::DocumentError;

/// Size of a message's index and length, bytes.
#[cfg(test)]
const HEAD: usize = 12;

/// Length of the first message, including its head, bytes.
#[cfg(test)]
fn first(messages: &[u8]) -> Result<usize, DocumentError> {
    let head = messages.first_chunk::<HEAD>();
    let [.., a, b, c, d] = *head.ok_or_else(|| damaged("is torn"))?;
    let bytes = HEAD + u32::from_le_bytes([a, b, c, d]) as usize;
    if bytes <= messages.len() {
        Ok(bytes)
    } else {
        Err(damaged("is torn"))
    }
}

/// Groups of messages, of messages one after the other, each preceded by its index and length.
///
/// # Errors
/// [`DocumentError::Damaged`] if the last one is torn.
#[cfg(test)]
fn transposed(messages: &[u8]) -> Result<Vec<u8>, DocumentError> {
    let mut groups = Vec::with_capacity(messages.len() + 8);
    let mut rest = messages;
    while !rest.is_empty() {
        let bytes = first(rest)?;
        let mut end = bytes;
        while end < rest.len() && first(&rest[end..])? == bytes {
            end += bytes;
        }
        let (group, after) = rest.split_at(end);
        rest = after;
        groups.extend(((end / bytes) as u32).to_le_bytes());
        groups.extend((bytes as u32).to_le_bytes());
        groups.extend((0..bytes).flat_map(|at| group[at..].iter().step_by(bytes)));
    }
    Ok(groups)
}

/// The messages of [`transposed`].
///
/// # Errors
/// [`DocumentError::Damaged`] for other bytes.
pub(super) fn in_order(groups: &[u8]) -> Result<Vec<u8>, DocumentError> {
    let mut messages = Vec::with_capacity(groups.len());
    let mut rest = groups;
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, e, f, g, h] = *head;
        let count = u32::from_le_bytes([a, b, c, d]) as usize;
        let bytes = u32::from_le_bytes([e, f, g, h]) as usize;
        let all = count.checked_mul(bytes).filter(|all| *all > 0);
        let split = all.and_then(|all| after.split_at_checked(all));
        let (group, after) = split.ok_or_else(|| damaged("is torn"))?;
        rest = after;
        messages.extend((0..count).flat_map(|at| group[at..].iter().step_by(count)));
    }
    match rest {
        [] => Ok(messages),
        _ => Err(damaged("is torn")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_come_back_and_torn_ones_are_told() {
        let mut messages = Vec::new();
        for (index, length) in [3usize, 3, 3, 0, 70, 70, 3].into_iter().enumerate() {
            messages.extend((index as u64).to_le_bytes());
            messages.extend((length as u32).to_le_bytes());
            messages.extend((0..length).map(|at| (at * index) as u8));
        }
        let groups = transposed(&messages).expect("whole");
        assert_eq!(groups.len(), messages.len() + 4 * 8);
        assert_eq!(in_order(&groups).expect("whole"), messages);
        assert!(in_order(&[]).expect("whole").is_empty());
        for end in [1, 11, 14, messages.len() - 1] {
            assert!(transposed(&messages[..end]).is_err(), "{end}");
        }
        for end in [7, 9, groups.len() - 1] {
            assert!(in_order(&groups[..end]).is_err(), "{end}");
        }
        assert!(in_order(&[255; 64]).is_err());
    }
}
