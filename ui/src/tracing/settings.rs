//! The tracing pictures of paintings, as the window remembers them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::widgets::context::PanelContext;

/// Paintings whose pictures are remembered.
const MOST: usize = 64;
/// Strength of a new one.
const STRENGTH: f32 = 0.5;

/// A tracing picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tracing {
    /// Its file.
    pub path: PathBuf,
    /// How much of it is seen, 0 to 1.
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
        match self.strength.is_finite() {
            true => self.strength.clamp(0.0, 1.0),
            false => STRENGTH,
        }
    }
}

/// Tracing pictures by the paintings' files; of a painting without a file, by an empty path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tracings(BTreeMap<String, Tracing>);

#[cfg(test)]
impl Tracings {
    /// That of a painting without a file.
    pub(crate) fn of(tracing: Tracing) -> Self {
        Self(BTreeMap::from([(String::new(), tracing)]))
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Tracing> {
        self.0.values()
    }
}

impl PanelContext<'_> {
    /// File of the painting that is open, as its tracing picture is remembered by.
    fn painting(&self) -> String {
        let status = self.rig.paint.as_ref().map(|node| &node.status);
        status.map_or_else(String::new, |status| status.path.clone())
    }

    /// The tracing picture of the painting that is open.
    #[must_use]
    pub fn tracing(&self) -> Option<&Tracing> {
        self.preferences.tracings.0.get(&self.painting())
    }

    /// The same, to be changed.
    pub fn tracing_mut(&mut self) -> Option<&mut Tracing> {
        let painting = self.painting();
        self.preferences.tracings.0.get_mut(&painting)
    }

    /// Gives the painting that is open another tracing picture, of the strength of the one before.
    pub fn trace(&mut self, path: &Path) {
        let strength = self.tracing().map_or(STRENGTH, Tracing::sound_strength);
        let painting = self.painting();
        let tracings = &mut self.preferences.tracings.0;
        if tracings.len() >= MOST && !tracings.contains_key(&painting) {
            // Those of paintings that are no more go first.
            let gone = tracings
                .keys()
                .find(|file| !Path::new(file).is_file())
                .or(tracings.keys().next());
            if let Some(gone) = gone.cloned() {
                tracings.remove(&gone);
            }
        }
        let tracing = Tracing {
            path: path.to_owned(),
            strength,
            shown: true,
        };
        tracings.insert(painting, tracing);
    }

    /// Takes the tracing picture away.
    pub fn untrace(&mut self) {
        let painting = self.painting();
        self.preferences.tracings.0.remove(&painting);
    }
}
