//! Settings that the window remembers, in a file of the user, apart from any painting.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use maulstick_device::pressure_curve::rises;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_ui_kit::units::Units;

use maulstick_window_pen::mouse::grip::Grip;

use crate::input::keymap::Keymap;
use crate::reference::settings::ReferencePreferences;
use crate::settings::brush_load::BrushLoad;
use crate::settings::look::{TEXT_SIZES, Theme};
use crate::settings::paint_sets::PaintSet;
use crate::settings::presets::{BeforePreset, Preset, classic};
use crate::settings::window_side::WindowSide;
use crate::tracing::settings::Tracings;

/// Recent paintings that are remembered.
const RECENT: usize = 12;

/// Settings that the window remembers. In the file the parts of window and brushes stand beside the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Size, sides and theme of the window.
    #[serde(flatten)]
    pub window: WindowPreferences,
    /// Brushes and paints.
    #[serde(flatten)]
    pub brushes: BrushPreferences,
    /// True once the painter has painted here: the first line of help is no longer needed.
    pub has_painted: bool,
    /// All axes that pens over the window have sensed, bits of `axes`.
    pub pen_senses: u32,
    /// Shortcuts of actions.
    pub keys: Keymap,
    /// Paintings that were open, the newest first.
    pub recent: Vec<PathBuf>,
    /// Folder of motions; absent for the usual one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motions: Option<PathBuf>,
    /// Reference picture and its window.
    pub reference: ReferencePreferences,
    /// Tracing pictures of the paintings.
    pub tracings: Tracings,
}

/// Settings of the window itself: where its parts stand, and how they look.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of its own, and a key of the file"
)]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WindowPreferences {
    /// True while the panels are shown.
    pub panels: bool,
    /// Side at which the panels stand; absent for that of the rack.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub panel_side: Option<WindowSide>,
    /// Titles of the panels that are unfolded.
    pub open: Vec<String>,
    /// True for a left-handed painter: palette at the right, rack at the left.
    pub left_handed: bool,
    /// True while the desk is seen in a mirror; not kept.
    #[serde(skip)]
    pub mirrored: bool,
    /// True while the window is too narrow for rack and panels; not kept.
    #[serde(skip)]
    pub is_narrow: bool,
    /// Width and height of the window, points.
    pub size: [f32; 2],
    /// Factor on the size of texts and controls.
    pub text_size: f32,
    /// Theme of panels and dialogs.
    pub theme: Theme,
    /// Language of the window, by its code; absent for the system's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub language: Option<String>,
    /// Units of lengths.
    pub units: Units,
}

/// Settings of brushes and paints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BrushPreferences {
    /// The painter's own brush files, in the order of the rack.
    pub own_brushes: Vec<PathBuf>,
    /// Load of the brush, or the one asked for; not stored, for a brush begins clean.
    #[serde(skip)]
    pub loading: BrushLoad,
    /// The brushes as they were last in the hand, by their names in the rig; without paint.
    pub in_hand: BTreeMap<String, Preset>,
    /// Grip of the mouse on the brush.
    pub mouse: Grip,
    /// Pressure of the mouse and tuning of the brush before a preset set them, which end with its brush.
    pub before_preset: Option<BeforePreset>,
    /// Points (sensed, given) of the pressure of pens over the window; none for the pressure as it is.
    pub pen_curve: Vec<[f64; 2]>,
    /// Widths at which brushes were last used, by their kind, mm.
    pub widths_mm: BTreeMap<String, f64>,
    /// Brushes that are ready with their paint.
    pub presets: Vec<Preset>,
    /// The painter's sets of paints.
    pub paint_sets: Vec<PaintSet>,
}

impl Default for WindowPreferences {
    fn default() -> Self {
        Self {
            panels: false,
            panel_side: None,
            open: vec!["Brush".to_owned(), "Tubes".to_owned()],
            left_handed: false,
            mirrored: false,
            is_narrow: false,
            size: [1280.0, 800.0],
            text_size: 1.0,
            theme: Theme::default(),
            language: None,
            units: Units::default(),
        }
    }
}

impl Default for BrushPreferences {
    fn default() -> Self {
        Self {
            own_brushes: Vec::new(),
            loading: BrushLoad::default(),
            in_hand: BTreeMap::new(),
            mouse: Grip::default(),
            before_preset: None,
            pen_curve: Vec::new(),
            widths_mm: BTreeMap::new(),
            presets: classic(),
            paint_sets: Vec::new(),
        }
    }
}

impl Preferences {
    /// The defaults but for the window itself.
    #[cfg(test)]
    pub(crate) fn of_window(window: WindowPreferences) -> Self {
        Self {
            window,
            ..Self::default()
        }
    }

    /// File for this user; `None` if the system has no such folder.
    #[must_use]
    pub fn place() -> Option<PathBuf> {
        let folders = directories::ProjectDirs::from("", "", "maulstick")?;
        Some(folders.config_dir().join("window.toml"))
    }

    /// Reads the file; defaults if there is none.
    ///
    /// # Errors
    /// A [`UserError`] if the file cannot be read or understood; the defaults are used then, and the next save replaces the
    /// file.
    pub fn read(path: &Path) -> Result<Self, UserError> {
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(UserError::reading(path, &error)),
        };
        let mut preferences: Self = toml::from_str(&text).map_err(|error| {
            UserError::failure(tr!(
                "the window's habits cannot be read; it begins with the defaults"
            ))
            .at(format!("{}: {}", path.display(), error.message()))
        })?;
        let sane = |side: f32| side.is_finite() && (200.0..=20_000.0).contains(&side);
        if !preferences.window.size.iter().all(|side| sane(*side)) {
            preferences.window.size = WindowPreferences::default().size;
        }
        if !TEXT_SIZES.contains(&preferences.window.text_size) {
            preferences.window.text_size = 1.0;
        }
        preferences.brushes.mouse = preferences.brushes.mouse.sane();
        if !rises(&preferences.brushes.pen_curve) {
            preferences.brushes.pen_curve.clear();
        }
        Ok(preferences)
    }

    /// Keeps them.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be written.
    pub fn keep(&self, path: &Path) -> Result<(), UserError> {
        let failed = |error: std::io::Error| UserError::writing(path, &error);
        let text = toml::to_string(self)
            .map_err(|error| UserError::failure(tr!("habits that are no TOML: {error}", error)))?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        write_whole(path, Kind::Own, |file| file.write_all(text.as_bytes())).map_err(failed)
    }

    /// Remembers that a painting was open.
    pub fn opened(&mut self, painting: &Path) {
        self.recent.retain(|known| known != painting);
        self.recent.insert(0, painting.to_owned());
        self.recent.truncate(RECENT);
    }

    /// True if the palette is seen at the right and the rack at the left.
    #[must_use]
    pub fn rack_is_left(&self) -> bool {
        self.window.left_handed != self.window.mirrored
    }

    /// True if a panel is unfolded.
    #[must_use]
    pub fn is_open(&self, panel: &str) -> bool {
        self.window.open.iter().any(|open| open == panel)
    }

    /// Unfolds a panel, or folds it.
    pub fn unfold(&mut self, panel: &str, open: bool) {
        self.window.open.retain(|known| known != panel);
        if open {
            self.window.open.push(panel.to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_read_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep/window.toml");
        assert_eq!(
            Preferences::read(&path).expect("none"),
            Preferences::default()
        );
        let mut preferences = Preferences::of_window(WindowPreferences {
            left_handed: true,
            ..WindowPreferences::default()
        });
        preferences.unfold("Light", true);
        for number in 0..20 {
            preferences.opened(Path::new(&format!("/{}.maul", number % 15)));
        }
        assert_eq!(preferences.recent.len(), RECENT);
        assert_eq!(preferences.recent[0], Path::new("/4.maul"));
        preferences.keep(&path).expect("kept");
        assert_eq!(Preferences::read(&path).expect("read"), preferences);
    }

    #[test]
    fn a_file_that_is_none_is_told_with_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("window.toml");
        std::fs::write(&path, "panels = 7").expect("written");
        let fault = Preferences::read(&path).expect_err("no truth value");
        assert!(fault.to_string().contains("window.toml"), "{fault}");
        std::fs::write(
            &path,
            "size = [nan, 1e9]\ntext_size = 0.0\nunknown = 1\n[mouse]\npressure = 7.0\nturn_deg = nan",
        )
        .expect("written");
        let preferences = Preferences::read(&path).expect("of a newer window");
        assert_eq!(preferences, Preferences::default());
    }
}
