//! The key expressions of a rig, built and read in one place.

/// The topics of one rig, all below `maulstick/<rig>/`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topics {
    prefix: String,
}

/// A name that no topic can carry.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not 1 to 32 letters, digits, '_' or '-'")]
pub struct NameError(pub String);

/// Checks the name of a rig, device, brush or node: 1 to 32 letters, digits, `_` and `-`.
///
/// # Errors
/// [`NameError`].
pub fn check_name(name: &str) -> Result<(), NameError> {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if (1..=32).contains(&name.len()) && name.chars().all(fits) {
        Ok(())
    } else {
        Err(NameError(name.to_owned()))
    }
}

macro_rules! topics {
    ($( $(#[$meta:meta])* $method:ident ( $($arg:ident),* ) = $pattern:literal; )*) => {
        impl Topics {
            $(
                $(#[$meta])*
                #[must_use]
                pub fn $method(&self $(, $arg: &str)*) -> String {
                    format!("{}{}", self.prefix, format_args!($pattern))
                }
            )*
        }
    };
}

topics! {
    /// Samples of a device: [`StylusSample`](crate::stylus::StylusSample).
    sample(device) = "stylus/{device}/sample";
    /// Properties of a device: [`StylusInfo`](crate::stylus::StylusInfo), cached.
    stylus_info(device) = "stylus/{device}/info";
    /// Status of a device: [`StylusStatus`](crate::stylus::StylusStatus).
    stylus_status(device) = "stylus/{device}/status";
    /// Position of a played take: [`TakeStatus`](crate::stylus::TakeStatus).
    take_status(device) = "stylus/{device}/take";
    /// Samples of the free hand: [`ControlSample`](crate::control::ControlSample).
    control(device) = "control/{device}/sample";
    /// Contact model for the hand: [`ContactModel`](crate::haptics::ContactModel).
    contact_model(device) = "haptics/{device}/model";
    /// Guide of the hand: [`GuideModel`](crate::haptics::GuideModel).
    guide(device) = "haptics/{device}/guide";
    /// Force of moving paint on the hand: [`FluidForce`](crate::haptics::FluidForce).
    fluid_force(device) = "haptics/{device}/fluid";
    /// Switch and strength of a device's force, a query:
    /// [`ForceRequest`](crate::haptics::ForceRequest).
    force(device) = "haptics/{device}/force";
    /// A brush file: [`BrushDef`](crate::brush::BrushDef), cached.
    brush_def(brush) = "brush/{brush}/def";
    /// Solved states: [`BrushState`](crate::brush::BrushState).
    brush_state(brush) = "brush/{brush}/state";
    /// Credit to devices: [`BrushConsumed`](crate::brush::BrushConsumed).
    brush_consumed(brush) = "brush/{brush}/consumed";
    /// The paint on a brush: [`BrushLook`](crate::brush::BrushLook), cached.
    brush_look(brush) = "brush/{brush}/look";
    /// Relief below a brush: [`BrushRelief`](crate::brush::BrushRelief).
    brush_relief(brush) = "brush/{brush}/relief";
    /// Credit to brushes: [`PaintConsumed`](crate::paint::PaintConsumed).
    paint_consumed() = "paint/consumed";
    /// The desk: [`Scene`](crate::scene::Scene), cached.
    scene() = "scene";
    /// The journal: [`JournalEntry`](crate::paint::JournalEntry).
    journal() = "paint/journal";
    /// Frames, a query: [`FrameRequest`](crate::paint::FrameRequest).
    frame() = "paint/frame";
    /// Small pictures of versions, a query: [`ThumbnailRequest`](crate::paint::ThumbnailRequest).
    thumbnail() = "paint/thumbnail";
    /// Status of the paint node: [`PaintStatus`](crate::paint::PaintStatus).
    paint_status() = "paint/status";
    /// Frames that the window has completed: [`Presented`](crate::window::Presented).
    presented() = "ui/presented";
    /// Orders of a window that are not done yet: [`PendingOrders`](crate::window::PendingOrders).
    pending_orders() = "ui/pending";
    /// Commands, a query: [`CommandRequest`](crate::command::CommandRequest).
    command(node) = "command/{node}";
    /// Lost messages, a query: [`GapRequest`](crate::command::GapRequest) on the stream's own key.
    gap(stream) = "gap/{stream}";
    /// Status of a node: [`NodeStatus`](crate::node::NodeStatus).
    node_status(node) = "node/{node}/status";
    /// The liveliness token of a node.
    node(node) = "node/{node}";
}

impl Topics {
    /// The topics of the rig called `rig`.
    #[must_use]
    pub fn new(rig: &str) -> Self {
        Self {
            prefix: format!("maulstick/{rig}/"),
        }
    }

    /// Prefix of every topic of the rig.
    #[must_use]
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// The topic without the rig's prefix.
    #[must_use]
    pub fn relative<'a>(&self, key: &'a str) -> Option<&'a str> {
        key.strip_prefix(&self.prefix)
    }

    /// The node of a token.
    #[must_use]
    pub fn node_of<'a>(&self, key: &'a str) -> Option<&'a str> {
        self.relative(key)?.strip_prefix("node/")
    }

    /// The middle of a three-part topic: `phantom` of `…/stylus/phantom/sample`.
    #[must_use]
    pub fn middle<'a>(&self, key: &'a str) -> Option<&'a str> {
        let mut parts = self.relative(key)?.split('/');
        match (parts.next(), parts.next(), parts.next(), parts.next()) {
            (Some(_), Some(middle), Some(_), None) => Some(middle),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn builds_and_reads_topics() {
        let topics = Topics::new("studio");
        let key = topics.sample("phantom");
        assert_eq!(key, "maulstick/studio/stylus/phantom/sample");
        assert_eq!(topics.middle(&key), Some("phantom"));
        assert_eq!(topics.middle(&topics.scene()), None);
        assert_eq!(topics.node_of(&topics.node("paint")), Some("paint"));
        assert_eq!(topics.node_of(&key), None);
        assert_eq!(Topics::new("other").middle(&key), None);
    }

    #[test]
    fn refuses_names_that_are_no_key() {
        for name in ["", "a/b", "a*", "@x", "ä", &"x".repeat(33)] {
            assert!(check_name(name).is_err(), "{name}");
        }
        assert_eq!(check_name("phantom-2"), Ok(()));
    }
}
