//! Leaf page of a table: "B-tree Pages", SQLite file format, section 1.6.

use std::ops::Range;

use super::record::{self, varint};

/// The type byte of a leaf page of a table.
pub(super) const TABLE_LEAF: u8 = 0x0D;
/// Bytes of a leaf's header.
const HEADER: usize = 8;
/// Bytes of the database's header, which precedes the b-tree's on page 1.
const DATABASE_HEADER: usize = 100;

/// Leaf page of a table; the last page of a cut file may be short.
pub(super) struct Leaf<B> {
    bytes: B,
    header: usize,
    cells: usize,
}

/// Position of a row on its page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cell {
    /// The row's key.
    pub(super) rowid: i64,
    /// Bytes of the whole record.
    pub(super) payload: u64,
    /// The part of the record on this page.
    pub(super) local: Range<usize>,
    /// Overflow page on which the record continues; 0 if it is complete.
    pub(super) overflow: u32,
    /// The end of the cell on this page.
    end: usize,
}

impl<B: AsRef<[u8]>> Leaf<B> {
    /// `None` if the type byte is another. The number of cells is limited to those that fit on the page.
    pub(super) fn parse(page: B, number: u32) -> Option<Self> {
        let header = if number == 1 { DATABASE_HEADER } else { 0 };
        let bytes = page.as_ref();
        if *bytes.get(header)? != TABLE_LEAF {
            return None;
        }
        let room = bytes.len().saturating_sub(header + HEADER) / 2;
        let cells = usize::from(be16(bytes, header + 3)?).min(room);
        Some(Self {
            bytes: page,
            header,
            cells,
        })
    }

    /// Number of rows by the header of the page.
    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    pub(super) fn bytes(&self, range: Range<usize>) -> Option<&[u8]> {
        self.bytes.as_ref().get(range)
    }

    /// Cell `number` of a page with `usable` bytes; `None` if it is not on the page.
    pub(super) fn cell(&self, number: usize, usable: usize) -> Option<Cell> {
        let bytes = self.bytes.as_ref();
        let pointers = self.header + HEADER;
        let at = usize::from(be16(bytes, pointers + 2 * number)?);
        if at < pointers + 2 * self.cells {
            return None;
        }
        let (payload, length) = varint(bytes.get(at..)?)?;
        let at = at + length;
        let (rowid, length) = varint(bytes.get(at..)?)?;
        let at = at + length;
        let local = at..at + local_bytes(payload, usable);
        let whole = local.len() as u64 == payload;
        let end = if whole { local.end } else { local.end + 4 };
        let cell = Cell {
            rowid: rowid.cast_signed(),
            payload,
            overflow: if whole { 0 } else { be32(bytes, local.end)? },
            local,
            end,
        };
        (end <= bytes.len().min(usable)).then_some(cell)
    }

    /// Evidence for `usable` bytes of the page: 0 if a cell is invalid, 2 if all are valid, 3 if they also reach to the
    /// end, like the first cell written to a page.
    pub(super) fn score(&self, usable: usize) -> u64 {
        let mut reach = 0;
        for number in 0..self.cells {
            let Some(cell) = self.cell(number, usable) else {
                return 0;
            };
            let local = self.bytes(cell.local).unwrap_or_default();
            if !record::plausible(cell.payload, local) {
                return 0;
            }
            reach = reach.max(cell.end);
        }
        match reach {
            0 => 0,
            _ if reach == usable => 3,
            _ => 2,
        }
    }
}

/// Local bytes, on the leaf itself, of a record of `payload` bytes, on a page with `usable` bytes: U, X, M and K of the
/// file format's section 1.6.
fn local_bytes(payload: u64, usable: usize) -> usize {
    let most = usable.saturating_sub(35);
    match usize::try_from(payload) {
        Ok(payload) if payload <= most => payload,
        _ => {
            let least = (usable.saturating_sub(12) * 32 / 255).saturating_sub(23);
            let run = usable.saturating_sub(4).max(1) as u64;
            let over = payload.saturating_sub(least as u64) % run;
            let local = least + over as usize;
            if local <= most { local } else { least }
        }
    }
}

/// A big-endian 16-bit number at `at`.
pub(super) fn be16(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..)?.first_chunk()?;
    Some(u16::from_be_bytes(*bytes))
}

/// A big-endian 32-bit number at `at`.
pub(super) fn be32(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_be_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On pages of 4096 bytes a record of up to 4061 bytes is local, a longer one leaves 489 to
    /// 4061 bytes, such that the last overflow page is full where that is possible.
    #[test]
    fn a_long_record_leaves_part_on_the_leaf() {
        for (payload, local) in [
            (10, 10),
            (4061, 4061),
            (4062, 489),
            (489 + 4092, 489),
            (490 + 4092, 490),
            (4061 + 4092, 4061),
            (4062 + 4092, 489),
        ] {
            assert_eq!(local_bytes(payload, 4096), local, "{payload}");
        }
        assert!(local_bytes(u64::MAX, 0) <= 4);
    }
}
