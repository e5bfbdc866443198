//! Frames of a WAL: "The Write-Ahead Log", SQLite file format, section 4.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use super::io::read_at;
use super::leaf::be32;
use super::page_size::is_page_size;

/// Bytes of the WAL's header.
const HEADER: usize = 32;
/// Bytes of a frame before its page.
const FRAME_HEADER: usize = 24;
/// Magic number without its last bit, which is 1 if checksums are over big-endian words.
const MAGIC: u32 = 0x377f_0682;
/// Version of the format, the only one so far.
const VERSION: u32 = 3_007_000;

type Checksum = [u32; 2];
type Salts = [u32; 2];

/// State of the WAL.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WalState {
    /// Committed frames before any damage, which SQLite would read.
    pub frames_good: u64,
    /// Committed frames with a matching checksum behind a damaged one.
    pub frames_past_damage: u64,
    /// True if bytes of this WAL are damaged, as far as detectable: a power cut during a commit looks the same, and a
    /// damaged end looks like an unfinished commit.
    pub damaged: bool,
}

/// Intact header of a WAL.
pub(super) struct Header {
    /// Bytes of a page.
    pub(super) page_size: usize,
    big_endian: bool,
    salts: Salts,
    checksum: Checksum,
}

impl Header {
    pub(super) fn read<F: Read + Seek>(wal: &mut F) -> Option<Self> {
        let bytes = read_at(wal, 0, HEADER).ok()?;
        let magic = be32(&bytes, 0)?;
        let header = Self {
            page_size: usize::try_from(be32(&bytes, 8)?).ok()?,
            big_endian: magic & 1 == 1,
            salts: pair(&bytes, 16)?,
            checksum: pair(&bytes, 24)?,
        };
        let is_valid = magic & !1 == MAGIC
            && be32(&bytes, 4)? == VERSION
            && is_page_size(header.page_size)
            && sum([0, 0], bytes.get(..24)?, header.big_endian) == header.checksum;
        is_valid.then_some(header)
    }
}

/// Positions of the pages in a WAL: offsets of a page's bytes, of its latest committed frame.
#[derive(Debug, Default)]
pub(super) struct Frames {
    /// Frames without damage before them.
    pub(super) good: BTreeMap<u32, u64>,
    /// Frames behind a damaged one.
    pub(super) past_damage: BTreeMap<u32, u64>,
    /// Number of pages of the database since the latest good commit; 0 without one.
    pub(super) database_pages: u32,
    /// State of the WAL.
    pub(super) state: WalState,
}

impl Frames {
    /// Reads a WAL of `length` bytes, with pages of `page_size` bytes.
    ///
    /// The checksum of a frame continues the stored one of the previous frame, so frames after a damaged one can be
    /// checked, too. They count as past damage together with uncommitted ones before it. Without a header the salts are
    /// those of the first two neighbours of which the second is intact, since frames of earlier runs of the log are
    /// only behind those of the latest.
    pub(super) fn read<F: Read + Seek>(
        wal: &mut F,
        length: u64,
        header: Option<&Header>,
        page_size: usize,
    ) -> Self {
        let big_endian = header.is_some_and(|header| header.big_endian);
        let mut salts = header.map(|header| header.salts);
        let mut before = header.map(|header| (header.salts, header.checksum));
        let mut frames = Self::default();
        let mut waiting = Vec::new();
        let mut broken = header.is_none();
        let mut damaged = false;
        let mut offset = HEADER as u64;
        let step = FRAME_HEADER + page_size;
        while offset < length {
            let Ok(bytes) = read_at(wal, offset, step) else {
                // The disk cannot read this part; the next one may be readable.
                damaged = true;
                broken = true;
                before = None;
                offset += step as u64;
                continue;
            };
            let (Some(frame), true) = (Frame::parse(&bytes), bytes.len() == step) else {
                break;
            };
            let ours = salts.unwrap_or(frame.salts) == frame.salts;
            let whole = ours && frame.follows(before, &bytes, big_endian);
            if whole {
                salts = Some(frame.salts);
                waiting.push((frame.page, offset + FRAME_HEADER as u64));
                if frame.commits > 0 {
                    let count = waiting.len() as u64;
                    if broken {
                        frames.past_damage.extend(waiting.drain(..));
                        frames.state.frames_past_damage += count;
                    } else {
                        frames.good.extend(waiting.drain(..));
                        frames.database_pages = frame.commits;
                        frames.state.frames_good += count;
                    }
                }
            } else {
                broken = true;
                damaged |= ours && salts.is_some();
            }
            before = Some((frame.salts, frame.checksum));
            offset += step as u64;
        }
        frames.state.damaged = damaged || frames.state.frames_past_damage > 0;
        frames
    }
}

/// Header of a frame.
struct Frame {
    page: u32,
    /// Number of pages of the database after the commit that this frame ends; 0 if it does not end one.
    commits: u32,
    salts: Salts,
    checksum: Checksum,
}

impl Frame {
    fn parse(bytes: &[u8]) -> Option<Self> {
        Some(Self {
            page: be32(bytes, 0)?,
            commits: be32(bytes, 4)?,
            salts: pair(bytes, 8)?,
            checksum: pair(bytes, 16)?,
        })
    }

    /// True if the frame with `bytes` is intact, by the salts and the checksum stored before it.
    fn follows(&self, before: Option<(Salts, Checksum)>, bytes: &[u8], big_endian: bool) -> bool {
        let Some((salts, checksum)) = before else {
            return false;
        };
        let (Some(head), Some(page)) = (bytes.get(..8), bytes.get(FRAME_HEADER..)) else {
            return false;
        };
        let checksum = sum(sum(checksum, head, big_endian), page, big_endian);
        self.page != 0 && salts == self.salts && checksum == self.checksum
    }
}

fn pair(bytes: &[u8], at: usize) -> Option<[u32; 2]> {
    Some([be32(bytes, at)?, be32(bytes, at + 4)?])
}

/// Checksum that continues `start` over pairs of words: "Checksum Algorithm", section 4.2.
fn sum(start: Checksum, bytes: &[u8], big_endian: bool) -> Checksum {
    let mut sum = start;
    let (words, _) = bytes.as_chunks::<4>();
    let word = |word: [u8; 4]| {
        if big_endian {
            u32::from_be_bytes(word)
        } else {
            u32::from_le_bytes(word)
        }
    };
    for words in words.as_chunks::<2>().0 {
        sum[0] = sum[0].wrapping_add(word(words[0])).wrapping_add(sum[1]);
        sum[1] = sum[1].wrapping_add(word(words[1])).wrapping_add(sum[0]);
    }
    sum
}
