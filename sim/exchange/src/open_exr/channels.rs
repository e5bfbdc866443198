//! The channels of a painting in an OpenEXR file.

use std::collections::BTreeSet;

use maulstick_types::scene::PaintSlot;

/// Greatest length of a paint's name, letters: a channel's name has 255 bytes.
const NAME_MAX: usize = 200;

/// Content of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Red, green or blue.
    Colour(usize),
    Height,
    Gloss,
    /// Wet paint of a slot.
    Wet(usize),
    /// Dry paint of a slot.
    Dry(usize),
}

/// Channels in the order of the file, which is that of their names' bytes.
pub(super) fn channels(paints: &[PaintSlot]) -> Vec<(String, Source)> {
    let mut channels: Vec<(String, Source)> = ["R", "G", "B"]
        .into_iter()
        .enumerate()
        .map(|(i, name)| (name.to_owned(), Source::Colour(i)))
        .collect();
    channels.push(("height".to_owned(), Source::Height));
    channels.push(("gloss".to_owned(), Source::Gloss));
    let names = paints.iter().map(|slot| slot.name.as_str());
    for (slot, name) in safe_names(names).into_iter().enumerate() {
        channels.push((format!("wet.{name}"), Source::Wet(slot)));
        channels.push((format!("dry.{name}"), Source::Dry(slot)));
    }
    channels.sort_by(|(one, _), (other, _)| one.as_bytes().cmp(other.as_bytes()));
    channels
}

/// Names of letters, digits, `-` and `_` alone, because a dot would begin another layer; of two equal results the later
/// one gets a number.
fn safe_names<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let safe = |c: char| match c {
        c if c.is_ascii_alphanumeric() || c == '-' => c,
        _ => '_',
    };
    let mut unused = |name: &str| {
        let name: String = name.chars().take(NAME_MAX).map(safe).collect();
        let numbered = (2u32..).map(|number| format!("{name}_{number}"));
        let mut candidates = std::iter::once(name.clone()).chain(numbered);
        let free = candidates.find(|candidate| !taken.contains(candidate));
        let free = free.unwrap_or(name);
        taken.insert(free.clone());
        free
    };
    names.map(&mut unused).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_and_stay_different() {
        let names = [
            "Phthalo Blue",
            "Phthalo.Blue",
            "Noir d’ivoire",
            "phthalo blue",
        ];
        let expected = [
            "Phthalo_Blue",
            "Phthalo_Blue_2",
            "Noir_d_ivoire",
            "phthalo_blue",
        ];
        assert_eq!(safe_names(names.into_iter()), expected);
    }

    #[test]
    fn channels_are_in_the_order_of_their_names() {
        let paint = |name: &str| PaintSlot {
            name: name.to_owned(),
            masstone: [0.0; 3],
            tint: [0.0; 3],
            file_hash: 0,
        };
        let channels = channels(&[paint("Yellow"), paint("Blue")]);
        let names: Vec<&str> = channels.iter().map(|(name, _)| name.as_str()).collect();
        let expected = "B G R dry.Blue dry.Yellow gloss height wet.Blue wet.Yellow";
        assert_eq!(names.join(" "), expected);
        assert_eq!(channels[2].1, Source::Colour(0));
        assert_eq!(channels[7].1, Source::Wet(1));
    }
}
