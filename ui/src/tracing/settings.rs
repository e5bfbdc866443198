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

    /// That of a painting in a file.
    pub(crate) fn in_file(&self, painting: &str) -> Option<&Tracing> {
        self.0.get(painting)
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Tracing> {
        self.0.values()
    }
}

impl PanelContext<'_> {
    /// File of the painting that is open, by which its tracing picture is remembered; `None` while it is not known.
    fn painting(&self) -> Option<String> {
        let status = self.rig.live.paint.as_ref().map(|node| &node.status);
        status.map(|status| status.path.clone())
    }

    /// The tracing picture of the painting that is open.
    #[must_use]
    pub fn tracing(&self) -> Option<&Tracing> {
        self.preferences.tracings.0.get(&self.painting()?)
    }

    /// The same, to be changed.
    pub fn tracing_mut(&mut self) -> Option<&mut Tracing> {
        let painting = self.painting()?;
        self.preferences.tracings.0.get_mut(&painting)
    }

    /// Gives the painting that is open another tracing picture, of the strength of the one before.
    pub fn trace(&mut self, path: &Path) {
        let strength = self.tracing().map_or(STRENGTH, Tracing::sound_strength);
        let Some(painting) = self.painting() else {
            return;
        };
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
        if let Some(painting) = self.painting() {
            self.preferences.tracings.0.remove(&painting);
        }
    }

    /// A painting goes on in another file: so does its tracing picture.
    pub fn carry_tracing(&mut self, from: &str, to: &str) {
        let tracings = &mut self.preferences.tracings.0;
        if let Some(tracing) = tracings.remove(from) {
            tracings.insert(to.to_owned(), tracing);
        }
    }

    /// Another sketch begins: the picture of the one before is not its own.
    pub fn forget_sketch(&mut self) {
        self.preferences.tracings.0.remove("");
    }
}
