//! The page size: "The Database Header", SQLite file format, section 1.3.

use std::io::{Read, Seek};

use super::io::read_at;
use super::leaf::{Leaf, be16};

/// Page size that is assumed without any evidence, bytes: SQLite's default.
const DEFAULT: usize = 4096;
/// All page sizes, bytes.
const SIZES: [usize; 8] = [512, 1024, 2048, 4096, 8192, 16_384, 32_768, LARGEST];
/// Largest page size, bytes; a multiple of all others.
const LARGEST: usize = 65_536;
/// Number of blocks of [`LARGEST`] bytes that are read to find a page size: 256 MiB.
const SAMPLES_TO_FIND: u64 = 4096;
/// Number of blocks that are read to test a header that looks valid: 4 MiB.
const SAMPLES_TO_TEST: u64 = 64;
/// Smallest number of bytes of a page that SQLite uses.
const LEAST_USABLE: usize = 480;

/// Size of the pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageSize {
    /// Bytes of a page: a power of two from 512 to 65536.
    pub bytes: usize,
    /// Source of the size.
    pub from: PageSizeFrom,
}

impl PageSize {
    /// Page size of a main file of `length` bytes that starts with `header`; `wal_page_size` is that of an intact WAL
    /// header.
    ///
    /// A valid-looking header is ignored if leaf pages of another size parse far better: with twice the true size half
    /// of them still do.
    pub(super) fn find<F: Read + Seek>(
        file: &mut F,
        length: u64,
        header: &[u8],
        wal_page_size: Option<usize>,
    ) -> Self {
        if let Some(bytes) = of_header(header) {
            let scores = Scores::take(file, length, SAMPLES_TO_TEST);
            if scores.best().1 <= 2 * scores.of(bytes) {
                let from = PageSizeFrom::Header;
                return Self { bytes, from };
            }
        }
        if let Some(bytes) = wal_page_size {
            let from = PageSizeFrom::Wal;
            return Self { bytes, from };
        }
        let bytes = match Scores::take(file, length, SAMPLES_TO_FIND).best() {
            (_, 0) => DEFAULT,
            (bytes, _) => bytes,
        };
        let from = PageSizeFrom::Guess;
        Self { bytes, from }
    }
}

/// Source of a page size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PageSizeFrom {
    /// The main file's header says so.
    Header,
    /// The header is damaged or wrong; the WAL's, which has a checksum, gives the size.
    Wal,
    /// The size with which most pages parse.
    Guess,
}

/// True if SQLite has pages of this size.
pub(super) fn is_page_size(bytes: usize) -> bool {
    SIZES.contains(&bytes)
}

/// True if the constant fields of a database's header are valid.
pub(super) fn is_header_valid(header: &[u8]) -> bool {
    header.starts_with(b"SQLite format 3\0") && header.get(21..24) == Some(&[64, 32, 32])
}

/// Page size in a database's header; `None` if the header is damaged.
fn of_header(header: &[u8]) -> Option<usize> {
    let bytes = match usize::from(be16(header, 16)?) {
        1 => LARGEST,
        bytes => bytes,
    };
    (is_header_valid(header) && is_page_size(bytes)).then_some(bytes)
}

/// Bytes at the end of each page that a database's header reserves; 0 if the header is damaged.
pub(super) fn reserved(header: &[u8]) -> usize {
    match header.get(20) {
        Some(&bytes) if is_header_valid(header) => usize::from(bytes),
        _ => 0,
    }
}

/// Bytes of a page that rows may use, if the header reserves `reserved` of them. The header is ignored if leaf pages
/// parse better with 0.
pub(super) fn usable<F: Read + Seek>(
    file: &mut F,
    length: u64,
    page_size: usize,
    reserved: usize,
) -> usize {
    let usable = page_size.saturating_sub(reserved);
    if reserved == 0 || usable < LEAST_USABLE {
        return page_size;
    }
    let (mut with, mut without) = (0, 0);
    each_leaf(file, length, SAMPLES_TO_TEST, &[page_size], |_, leaf| {
        with += leaf.score(usable);
        without += leaf.score(page_size);
    });
    if without > with { page_size } else { usable }
}

/// Number of leaf pages that parse with each page size.
struct Scores([u64; SIZES.len()]);

impl Scores {
    fn take<F: Read + Seek>(file: &mut F, length: u64, samples: u64) -> Self {
        let mut scores = [0; SIZES.len()];
        each_leaf(file, length, samples, &SIZES, |size, leaf| {
            scores[size] += leaf.score(SIZES[size]);
        });
        Self(scores)
    }

    fn of(&self, bytes: usize) -> u64 {
        let at = SIZES.iter().position(|size| *size == bytes);
        at.map_or(0, |at| self.0[at])
    }

    /// The size with the highest score, the smallest of several, and that score.
    fn best(&self) -> (usize, u64) {
        let each = SIZES.into_iter().zip(self.0);
        each.fold((DEFAULT, 0), |best, (size, score)| {
            if score > best.1 { (size, score) } else { best }
        })
    }
}

/// Visits every page with the type byte of a leaf in evenly spaced blocks of a file, for each of `sizes`; `visit` gets
/// the index of the size.
fn each_leaf<F: Read + Seek>(
    file: &mut F,
    length: u64,
    samples: u64,
    sizes: &[usize],
    mut visit: impl FnMut(usize, &Leaf<&[u8]>),
) {
    let blocks = length.div_ceil(LARGEST as u64);
    let stride = blocks.div_ceil(samples).max(1);
    for sample in 0..blocks.div_ceil(stride) {
        let offset = sample * stride * LARGEST as u64;
        let bytes = read_at(file, offset, LARGEST).unwrap_or_default();
        for (place, &size) in sizes.iter().enumerate() {
            for (page, number) in bytes.chunks_exact(size).zip(1..) {
                let number = if offset == 0 { number } else { u32::MAX };
                if let Some(leaf) = Leaf::parse(page, number) {
                    visit(place, &leaf);
                }
            }
        }
    }
}
