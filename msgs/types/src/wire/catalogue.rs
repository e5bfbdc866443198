//! Every message of the rig with its topic, for `maulstick schema`, takes and decoders.

use crate::wire::codec::Message;
use crate::wire::header::DecodeError;
use crate::wire::schema::Schema;
use crate::{brush, command, control, haptics, node, paint, scene, stylus, window};

/// One message of the rig.
#[derive(Debug)]
pub struct CatalogueEntry {
    /// Name of the message.
    pub name: &'static str,
    /// Version of its field table.
    pub version: u16,
    /// Largest body, bytes.
    pub max_bytes: usize,
    /// True for a message of the [contract](crate::STYLUS_CONTRACT).
    pub in_contract: bool,
    /// Topics below `maulstick/<rig>/` that carry it.
    pub topics: &'static [&'static str],
    /// Its field table.
    pub schema: fn() -> &'static Schema,
    /// Decodes a body of a version and says what is in it, for `echo` and for tests.
    pub show: fn(u16, &[u8]) -> Result<String, DecodeError>,
}

fn show<M: Message + std::fmt::Debug>(version: u16, body: &[u8]) -> Result<String, DecodeError> {
    M::decode_body(version, body).map(|message| format!("{message:#?}"))
}

macro_rules! entry {
    ($message:ty, $($topic:literal),*) => {
        CatalogueEntry {
            name: <$message as Message>::NAME,
            version: <$message as Message>::VERSION,
            max_bytes: <$message as Message>::MAX_BYTES,
            in_contract: <$message as Message>::IN_CONTRACT,
            topics: &[$($topic),*],
            schema: <$message as Message>::schema,
            show: show::<$message>,
        }
    };
}

/// All messages, in order of the way through the rig.
pub static CATALOGUE: &[CatalogueEntry] = &[
    entry!(stylus::StylusSample, "stylus/<device>/sample"),
    entry!(stylus::StylusInfo, "stylus/<device>/info"),
    entry!(stylus::StylusStatus, "stylus/<device>/status"),
    entry!(stylus::TakeStatus, "stylus/<device>/take"),
    entry!(control::ControlSample, "control/<device>/sample"),
    entry!(haptics::ContactModel, "haptics/<device>/model"),
    entry!(haptics::GuideModel, "haptics/<device>/guide"),
    entry!(haptics::FluidForce, "haptics/<device>/fluid"),
    entry!(haptics::ForceRequest, "haptics/<device>/force (query)"),
    entry!(haptics::ForceReply, "haptics/<device>/force (reply)"),
    entry!(brush::BrushDef, "brush/<brush>/def"),
    entry!(brush::BrushState, "brush/<brush>/state"),
    entry!(brush::BrushConsumed, "brush/<brush>/consumed"),
    entry!(brush::BrushLook, "brush/<brush>/look"),
    entry!(brush::BrushRelief, "brush/<brush>/relief"),
    entry!(paint::PaintConsumed, "paint/consumed"),
    entry!(scene::Scene, "scene"),
    entry!(paint::JournalEntry, "paint/journal"),
    entry!(paint::FrameRequest, "paint/frame (query)"),
    entry!(paint::FrameReply, "paint/frame (reply)"),
    entry!(paint::PaintStatus, "paint/status"),
    entry!(paint::ThumbnailRequest, "paint/thumbnail (query)"),
    entry!(paint::ThumbnailReply, "paint/thumbnail (reply)"),
    entry!(window::Presented, "ui/presented"),
    entry!(node::NodeStatus, "node/<node>/status"),
    entry!(window::PendingOrders, "ui/pending"),
    entry!(command::CommandRequest, "command/<node> (query)"),
    entry!(command::CommandReply, "command/<node> (reply)"),
    entry!(command::GapRequest, "gap/<stream> (query)"),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn no_two_messages_share_a_hash() {
        let hashes: BTreeSet<u32> = CATALOGUE
            .iter()
            .map(|entry| (entry.schema)().hash)
            .collect();
        assert_eq!(hashes.len(), CATALOGUE.len());
    }
}
