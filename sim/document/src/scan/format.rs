//! The page size: "The Database Header", SQLite file format, section 1.3.

use std::io::{Read, Seek};

use super::leaf::{Leaf, be16};
use super::store::read_at;

/// SQLite's default page size, bytes: the assumption for a file without any evidence.
const DEFAULT: usize = 4096;
/// All page sizes, bytes.
const SIZES: [usize; 8] = [512, 1024, 2048, 4096, 8192, 16_384, 32_768, LARGEST];
/// The largest of them, which each divides.
const LARGEST: usize = 65_536;
/// Blocks of [`LARGEST`] bytes by which a page size is found: 256 MiB.
const SAMPLES_TO_FIND: u64 = 4096;
/// Blocks by which the word of a header that looks well is tested: 4 MiB.
const SAMPLES_TO_TEST: u64 = 64;
/// Fewest bytes of a page that SQLite uses.
const LEAST_USABLE: usize = 480;

/// The size of the pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageSize {
    /// Bytes of a page: a power of two from 512 to 65536.
    pub bytes: usize,
    /// Source of the size.
    pub from: PageSizeFrom,
}

impl PageSize {
    /// The page size of a main file of `length` bytes that starts with `header`, if its WAL, whose
    /// header is whole, has pages of `promised` bytes.
    ///
    /// A header that looks well is not believed where leaf pages of another size parse far better:
    /// with twice the true size half of them still do.
    pub(super) fn find<F: Read + Seek>(
        file: &mut F,
        length: u64,
        header: &[u8],
        promised: Option<usize>,
    ) -> Self {
        if let Some(bytes) = of_header(header) {
            let scores = Scores::take(file, length, SAMPLES_TO_TEST);
            if scores.best().1 <= 2 * scores.of(bytes) {
                let from = PageSizeFrom::Header;
                return Self { bytes, from };
            }
        }
        if let Some(bytes) = promised {
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
    /// That header is damaged or wrong; the WAL's, which has a checksum, gives the size.
    Wal,
    /// It is the one with which most pages parse.
    Guess,
}

/// True if a page can have so many bytes.
pub(super) fn is_page_size(bytes: usize) -> bool {
    SIZES.contains(&bytes)
}

/// True if the constant fields of a database's header are valid.
pub(super) fn header_stands(header: &[u8]) -> bool {
    header.starts_with(b"SQLite format 3\0") && header.get(21..24) == Some(&[64, 32, 32])
}

/// The page size in a database's header; nothing where the header is damaged.
fn of_header(header: &[u8]) -> Option<usize> {
    let bytes = match usize::from(be16(header, 16)?) {
        1 => LARGEST,
        bytes => bytes,
    };
    (header_stands(header) && is_page_size(bytes)).then_some(bytes)
}

/// Bytes at the end of each page that a database's header keeps from rows; 0 if the header is damaged.
pub(super) fn reserved(header: &[u8]) -> usize {
    match header.get(20) {
        Some(&bytes) if header_stands(header) => usize::from(bytes),
        _ => 0,
    }
}

/// Bytes of a page that rows may use, if the header says that `reserved` are kept from them. The header is ignored if
/// leaf pages parse better with 0.
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

/// Shows `see` every page in evenly spaced blocks of a file that has the type byte of a leaf, with
/// each of `sizes`, of which it is told the place.
fn each_leaf<F: Read + Seek>(
    file: &mut F,
    length: u64,
    samples: u64,
    sizes: &[usize],
    mut see: impl FnMut(usize, &Leaf<&[u8]>),
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
                    see(place, &leaf);
                }
            }
        }
    }
}
