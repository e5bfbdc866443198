//! Pages according to the trees of the tables and the list of free pages: "B-tree Pages" and "The Freelist", SQLite
//! file format, sections 1.6 and 1.5.

use std::collections::BTreeSet;
use std::io::{Read, Seek};

use super::leaf::{TABLE_LEAF, be16, be32};
use super::page_size::is_header_valid;
use super::store::{Origin, Store};

/// The type byte of an interior page of a table.
const TABLE_INTERIOR: u8 = 0x05;
/// Bytes of an interior page's header.
const HEADER: usize = 12;
/// Bytes of the database's header, which precedes the b-tree's on page 1.
const DATABASE_HEADER: usize = 100;

/// Free pages; `None` if the header or the list is damaged: a wrong list would hide rows.
pub(super) fn free_pages<F: Read + Seek>(store: &mut Store<F>) -> Option<BTreeSet<u32>> {
    let header = store.page(1, Origin::Wal)?;
    if !is_header_valid(&header) {
        return None;
    }
    let most = store.usable() / 4 - 2;
    let (mut trunk, count) = (be32(&header, 32)?, be32(&header, 36)? as usize);
    let mut free = BTreeSet::new();
    while trunk != 0 {
        if trunk < 2 || free.len() >= count || !free.insert(trunk) {
            return None;
        }
        let page = store.page(trunk, Origin::Wal)?;
        let leaves = be32(&page, 4)? as usize;
        if leaves > most {
            return None;
        }
        for place in 0..leaves {
            let leaf = be32(&page, 8 + 4 * place)?;
            if leaf < 2 || !free.insert(leaf) {
                return None;
            }
        }
        trunk = be32(&page, 0)?;
    }
    (free.len() == count).then_some(free)
}

/// Children of an interior page of a table; `None` if the page is of another type.
pub(super) fn children(page: &[u8], number: u32) -> Option<Vec<u32>> {
    let header = if number == 1 { DATABASE_HEADER } else { 0 };
    if *page.get(header)? != TABLE_INTERIOR {
        return None;
    }
    let cells = usize::from(be16(page, header + 3)?);
    let left = (0..cells).map_while(|cell| {
        let at = be16(page, header + HEADER + 2 * cell)?;
        be32(page, usize::from(at))
    });
    let mut children: Vec<u32> = left.collect();
    children.extend(be32(page, header + 8));
    Some(children)
}

/// True if the page belongs to a table, as a leaf or an interior page.
pub(super) fn is_of_table(page: &[u8], number: u32) -> bool {
    let header = if number == 1 { DATABASE_HEADER } else { 0 };
    matches!(page.get(header), Some(&(TABLE_LEAF | TABLE_INTERIOR)))
}
