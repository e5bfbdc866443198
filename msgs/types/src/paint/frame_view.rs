//! A [`FrameReply`](crate::paint::FrameReply) read where it lies: its tiles are not copied.

use serde::Deserialize;

use crate::Message as _;
use crate::paint::{FrameHolds, FrameReply};
use crate::wire::codec::{body_of, borrow_limited};
use crate::wire::header::{DecodeError, Header};

/// A [`FrameTile`](crate::paint::FrameTile) in the bytes of its reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub struct FrameTileView<'a> {
    /// Column of the tile.
    pub x: u32,
    /// Row of the tile, 0 at the bottom.
    pub y: u32,
    /// Its planes.
    pub planes: &'a [u8],
}

/// A [`FrameReply`] in its bytes; the fields are those of the message, in its order.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct FrameView<'a> {
    /// The surface.
    pub surface: u32,
    /// Epoch of the paint node.
    pub epoch: u32,
    /// Version to ask from the next time.
    pub version: u64,
    /// The level of the tiles.
    pub level: u32,
    /// Cells of the surface at this level, across and up.
    pub cells: [u32; 2],
    /// The journal entries below this index are in the picture.
    pub journal: u64,
    /// The brush states that are in the picture.
    pub holds: Vec<FrameHolds>,
    /// True if further tiles wait for the next request.
    pub more: bool,
    /// The tiles.
    #[serde(borrow)]
    pub tiles: Vec<FrameTileView<'a>>,
    /// Grows when the light changes.
    pub look: u64,
}

impl<'a> FrameView<'a> {
    /// Reads header and body.
    ///
    /// # Errors
    /// As [`decode`](crate::decode) of the message.
    pub fn of(bytes: &'a [u8]) -> Result<(Header, Self), DecodeError> {
        const LIMIT: usize = FrameReply::MAX_BYTES;
        let (header, body) = body_of::<FrameReply>(bytes)?;
        Ok((
            header,
            borrow_limited::<Self, LIMIT>(FrameReply::NAME, body)?,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::FrameTile;
    use crate::{Flags, Origin, decode, encode};

    #[test]
    fn a_view_holds_what_the_message_holds() {
        let me = Origin {
            source: 1,
            epoch: 2,
        };
        let tile = |x: u32, planes: &[u8]| FrameTile {
            x,
            y: x + 7,
            planes: planes.to_vec().into(),
        };
        let reply = FrameReply {
            surface: 1,
            epoch: 2,
            version: 3,
            level: 4,
            cells: [5, 6],
            journal: 7,
            holds: vec![FrameHolds {
                brush: 8,
                epoch: 9,
                next: 10,
            }],
            more: true,
            tiles: vec![tile(1, &[1, 2, 3]), tile(2, &[]), tile(3, &[9; 300])],
            look: 11,
        };
        let bytes = encode(&me, Flags::NONE, 0, 0, 0, &reply).expect("encoded");
        let (header, view) = FrameView::of(&bytes).expect("its own bytes");
        assert_eq!(
            header,
            decode::<FrameReply>(&bytes).expect("its own bytes").0
        );
        let tiles = view.tiles.iter().map(|tile| FrameTile {
            x: tile.x,
            y: tile.y,
            planes: tile.planes.to_vec().into(),
        });
        let owned = FrameReply {
            surface: view.surface,
            epoch: view.epoch,
            version: view.version,
            level: view.level,
            cells: view.cells,
            journal: view.journal,
            holds: view.holds.clone(),
            more: view.more,
            tiles: tiles.collect(),
            look: view.look,
        };
        assert_eq!(owned, reply);
        let within = bytes.as_ptr_range();
        let last = view.tiles.last().expect("three").planes.as_ptr_range();
        assert!(within.start < last.start && last.end <= within.end);
        assert!(FrameView::of(&bytes[..bytes.len() - 1]).is_err());
        let longer = [&bytes[..], &[0]].concat();
        let own = decode::<FrameReply>(&longer).expect_err("longer");
        assert_eq!(FrameView::of(&longer), Err(own));
    }
}
