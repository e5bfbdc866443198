//! The tracing pictures of paintings, as the window remembers them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use maulstick_types::quantity;
use maulstick_types::values::Quantity;
use serde::{Deserialize, Serialize};

/// Paintings whose pictures are remembered.
const MOST: usize = 64;
/// Strength of a new one.
const STRENGTH: f32 = 0.5;

quantity! {
    /// Share of the tracing picture that is seen.
    pub(crate) TracingStrength: "strength", 0.0..=1.0, Self::RANGE, "",
    tr_noop!("How much of the tracing picture is seen; it is neither painted nor exported")
}

/// A tracing picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tracing {
    /// File of the picture.
    pub path: PathBuf,
    /// How much of it is seen, a [`TracingStrength`].
    pub strength: f32,
    /// True while it is shown.
    pub shown: bool,
}

impl Default for Tracing {
    fn default() -> Self {
        Self {
            path: PathBuf::new(),
            strength: STRENGTH,
            shown: true,
        }
    }
}

impl Tracing {
    /// Its strength, in range whatever the file of the settings says.
    #[must_use]
    pub fn sound_strength(&self) -> f32 {
        if TracingStrength::check(self.strength.into()).is_ok() {
            self.strength
        } else {
            STRENGTH
        }
    }
}

/// Tracing pictures by the paintings' files; of a painting without a file, by an empty path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tracings(pub(super) BTreeMap<String, Tracing>);

#[cfg(test)]
impl Tracings {
    /// That of a painting without a file.
    pub(crate) fn of(tracing: Tracing) -> Self {
        Self(BTreeMap::from([(String::new(), tracing)]))
    }

    /// That of a painting in a file.
    pub(crate) fn in_file(&self, painting: &str) -> Option<&Tracing> {
        self.0.get(painting)
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Tracing> {
        self.0.values()
    }
}

impl Tracings {
    /// Gives a painting another tracing picture, of the strength of the one before.
    pub(super) fn trace(&mut self, painting: String, path: &Path) {
        let before = self.0.get(&painting);
        let strength = before.map_or(STRENGTH, Tracing::sound_strength);
        if self.0.len() >= MOST && !self.0.contains_key(&painting) {
            // Those of paintings that are no more go first.
            let gone = self.0.keys().find(|file| !Path::new(file).is_file());
            let gone = gone.or(self.0.keys().next());
            if let Some(gone) = gone.cloned() {
                self.0.remove(&gone);
            }
        }
        let tracing = Tracing {
            path: path.to_owned(),
            strength,
            shown: true,
        };
        self.0.insert(painting, tracing);
    }
}
