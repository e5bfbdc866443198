//! Fields whose form in a text differs from that on the wire: a region is `X,Y,WxH`, a mixture
//! `Cobalt Blue=0.7,Titanium White=0.3`.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

/// Parses a text by `FromStr`.
pub(super) struct Text<T>(&'static str, std::marker::PhantomData<T>);

impl<T: FromStr<Err: fmt::Display>> Visitor<'_> for Text<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        text.parse().map_err(E::custom)
    }
}

/// A text where a person writes, the fields themselves on the wire.
pub(super) fn text<'de, T, D>(from: D) -> Result<T, D::Error>
where
    T: FromStr<Err: fmt::Display> + Deserialize<'de>,
    D: Deserializer<'de>,
{
    if from.is_human_readable() {
        from.deserialize_any(Text("a text", std::marker::PhantomData))
    } else {
        T::deserialize(from)
    }
}

/// [`text`] for a key that may be absent.
pub(super) fn optional<'de, T, D>(from: D) -> Result<Option<T>, D::Error>
where
    T: FromStr<Err: fmt::Display> + Deserialize<'de>,
    D: Deserializer<'de>,
{
    if from.is_human_readable() {
        text(from).map(Some)
    } else {
        Option::deserialize(from)
    }
}

/// The canvas, of which scripts speak.
pub(super) fn canvas() -> u32 {
    maulstick_types::scene::CANVAS
}

/// Options that all edits of a surface have on the command line.
#[cfg(feature = "cli")]
pub(super) fn surface() -> impl clap::builder::TypedValueParser<Value = u32> {
    use clap::builder::TypedValueParser as _;
    use maulstick_types::scene::{CANVAS, PALETTE};

    let palette = clap::builder::BoolishValueParser::new();
    palette.map(|palette| if palette { PALETTE } else { CANVAS })
}
