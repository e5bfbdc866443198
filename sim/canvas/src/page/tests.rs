//! Pages leave memory and come back.

use std::any::{Any, TypeId};

use super::*;
use crate::planes::{Planes, TILE_CELLS};

/// Pages whose one plane holds their number.
struct Numbers;

impl Backing for Numbers {
    fn read(&self, id: u64, _: TypeId) -> Result<Box<dyn Any>, PageError> {
        match id {
            13 => Err(PageError::Storage("page 13 is damaged".into())),
            _ => Ok(Box::new(plane(id))),
        }
    }
}

fn plane(number: u64) -> Planes {
    Planes::from_iter([(0, vec![number as f32; TILE_CELLS].into())])
}

const BYTES: usize = TILE_CELLS * 4;

#[test]
fn stored_pages_leave_when_memory_gets_short_and_come_back() {
    let pager = Pager::backed(Arc::new(Numbers), 4 * BYTES, 1);
    let pages: Vec<Page<Planes>> = (1..=10)
        .map(|number| Page::new(&pager, Arc::new(plane(number)), None))
        .collect();
    assert_eq!(pager.counts().resident, 10 * BYTES, "none is stored");
    pages.iter().for_each(|page| page.note_stored(100));
    assert_eq!(pager.counts().stored, 1000);
    let more = Page::new(&pager, Arc::new(plane(11)), None);
    assert!(pager.counts().resident <= 4 * BYTES);
    assert_eq!(more.resident_bytes(), BYTES, "the newest is not stored");
    for (page, number) in pages.iter().zip(1..) {
        assert_eq!(page.get()[0].1[7], number as f32);
        assert!(pager.counts().resident <= 5 * BYTES);
    }
    assert!(pager.counts().fetched >= 6 && pager.fault().is_none());
}

/// A disk that fails.
struct Failing;

impl Backing for Failing {
    fn read(&self, _: u64, _: TypeId) -> Result<Box<dyn Any>, PageError> {
        Err(PageError::Storage("the disk fails".into()))
    }

    fn is_at_hand(&self) -> bool {
        false
    }
}

#[test]
fn no_page_leaves_memory_while_the_disk_fails() {
    let pager = Pager::backed(Arc::new(Failing), BYTES, 1);
    let pages: Vec<Page<Planes>> = (1..=10)
        .map(|number| Page::new(&pager, Arc::new(plane(number)), None))
        .inspect(|page| page.note_stored(100))
        .collect();
    assert!(pages.iter().all(|page| page.resident_bytes() == BYTES));
}

#[test]
fn what_nobody_remembers_may_be_deleted_and_what_is_damaged_is_told() {
    let pager = Pager::backed(Arc::new(Numbers), usize::MAX, 1);
    let page = Page::new(&pager, Arc::new(plane(1)), None);
    page.note_stored(50);
    let unsaved = Page::new(&pager, Arc::new(plane(2)), Some(&page));
    let newest = Page::new(&pager, Arc::new(plane(3)), Some(&unsaved));
    for later in [&unsaved, &newest] {
        assert!(later.base().is_some_and(|base| base.is(&page)));
    }
    drop(newest);
    let clone = page.clone();
    drop(page);
    assert!(pager.take_dead().is_empty());
    drop(clone);
    assert!(unsaved.base().is_none());
    drop(unsaved);
    assert_eq!(pager.take_dead(), [1]);
    assert_eq!((pager.counts().stored, pager.counts().resident), (0, 0));
    assert!(Page::<Planes>::stored(&pager, 13, 9).get().is_empty());
    assert_eq!(pager.fault(), Some("page 13 is damaged"));
}
