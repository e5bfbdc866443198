//! The settings of a rig: `rig.toml`, with the defaults of `default.toml`.

mod check;
mod check_driver;
mod device;
mod light;
mod paint;
mod palette;
mod record;
pub mod user_devices;
mod wrong;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use maulstick_types::command::advice::Advice;
use serde::{Deserialize, Serialize};

use crate::user_error::UserError;

pub use device::{
    ACTIONS, DRIVERS, DeviceSection, FORCES, HID_DRIVERS, MOST_PAINT_DRAG, PEN_DRIVERS,
};
pub use light::LightSection;
pub use paint::{BACKENDS, PaintSection, PaintingRoom};
pub use palette::{PILES, PaletteSection};
pub use record::RecordSection;

/// The commented default.
pub const DEFAULT: &str = include_str!("default.toml");
/// Colour spaces that the window and pictures know without a file.
pub const SPACES: [&str; 2] = ["srgb", "display-p3"];
/// Mappings of colours into the gamut of the display.
pub const GAMUTS: [&str; 2] = ["soft", "clamp"];
/// Priority of the mouse over the window.
pub const MOUSE_PRIORITY: i32 = -100;
/// Priority of a pen over the window.
pub const PEN_PRIORITY: i32 = -50;
/// Priority of a device that `rig.toml` does not name.
pub const FOREIGN_PRIORITY: i32 = 0;
/// Names in a rig that are no device's: the launcher's and the nodes' sockets, the mouse and the pen over
/// the window, a take, a recording.
/// Those of brush nodes begin with [`BRUSH_NODE`].
pub const RESERVED: [&str; 7] = ["hub", "paint", "ui", "player", "recorder", "mouse", "pen"];
/// Prefix of the names of brush nodes.
pub const BRUSH_NODE: &str = "brush-";
/// Priority of a played take.
pub const PLAYER_PRIORITY: i32 = i32::MAX;

/// `[rig]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigSection {
    /// Name of the rig.
    pub name: String,
}

impl Default for RigSection {
    fn default() -> Self {
        Self {
            name: "studio".into(),
        }
    }
}

/// `[canvas]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CanvasSection {
    /// Width, mm.
    pub width_mm: f64,
    /// Height, mm.
    pub height_mm: f64,
    /// Side of a cell, mm.
    pub cell_mm: f64,
    /// Name of the tooth.
    pub tooth: String,
    /// Seed of the tooth.
    pub tooth_seed: u64,
    /// Name of the ground, a CSV file of nm,reflectance, or a picture.
    pub ground: String,
    /// Thickness of paint that stays however hard it is brushed, µm.
    pub stain_um: f64,
}

impl Default for CanvasSection {
    fn default() -> Self {
        Self {
            width_mm: 256.0,
            height_mm: 256.0,
            cell_mm: 0.25,
            tooth: "linen".into(),
            tooth_seed: 1,
            ground: "gesso".into(),
            stain_um: 3.0,
        }
    }
}

impl CanvasSection {
    /// Cells across and up.
    #[must_use]
    pub fn cells(&self) -> [u32; 2] {
        [self.width_mm, self.height_mm].map(|mm| (mm / self.cell_mm).round() as u32)
    }
}

/// `[[brush]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrushSection {
    /// Name in the topics.
    pub name: String,
    /// A brush of the library, or a path to a brush file.
    pub kind: String,
    /// Width of the head, mm; that of its file if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_mm: Option<f64>,
    /// Share of the head's length that full pressure presses in.
    #[serde(default = "half")]
    pub depth_share: f64,
}

fn half() -> f64 {
    0.5
}

/// `[view]`: how the window and pictures show colour.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ViewSection {
    /// One of [`SPACES`], or a path to the ICC profile of the display.
    pub profile: String,
    /// One of [`GAMUTS`].
    pub gamut: String,
}

impl Default for ViewSection {
    fn default() -> Self {
        Self {
            profile: "srgb".into(),
            gamut: "soft".into(),
        }
    }
}

impl ViewSection {
    /// The path of the profile where it is a file.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        let known = SPACES.contains(&self.profile.as_str());
        (!known).then(|| Path::new(&self.profile))
    }

    /// Checks the names; a profile that is no known space has to look like a file.
    ///
    /// # Errors
    /// The error, and advice.
    pub fn check(&self) -> Result<(), (String, String)> {
        if !is_path(&self.profile) {
            check::choose("colour space", &self.profile, &SPACES).map_err(|(what, help)| {
                (what, format!("{help}; or give the path of an ICC file"))
            })?;
        }
        check::choose("gamut mapping", &self.gamut, &GAMUTS)
    }
}

/// Policy of starting a node again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Restart {
    /// After a failure, at most three times in ten seconds.
    #[default]
    OnFailure,
    /// Never.
    Never,
}

/// `[node.NAME]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NodeSection {
    /// Policy of starting it again.
    pub restart: Restart,
}

/// A rig.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigConfig {
    /// The rig itself.
    #[serde(default)]
    pub rig: RigSection,
    /// The canvas.
    #[serde(default)]
    pub canvas: CanvasSection,
    /// The palette.
    #[serde(default)]
    pub palette: PaletteSection,
    /// The light.
    #[serde(default)]
    pub light: LightSection,
    /// Devices with a driver of their own.
    #[serde(default)]
    pub device: Vec<DeviceSection>,
    /// Brushes; the first is that of the mouse and of foreign devices.
    #[serde(default)]
    pub brush: Vec<BrushSection>,
    /// The paint.
    #[serde(default)]
    pub paint: PaintSection,
    /// Colour of the window and of pictures.
    #[serde(default)]
    pub view: ViewSection,
    /// A recording of each run, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<RecordSection>,
    /// Nodes by name.
    #[serde(default)]
    pub node: BTreeMap<String, NodeSection>,
    /// Libraries outside of the folders of the system that devices may load. No file of settings says so: the user does,
    /// by `--allow-library`.
    #[serde(skip)]
    pub allowed_libraries: Vec<PathBuf>,
}

impl Default for RigConfig {
    fn default() -> Self {
        #[expect(
            clippy::expect_used,
            reason = "the file is part of the crate and tested"
        )]
        Self::parse(DEFAULT, "default.toml").expect("the built-in default is valid")
    }
}

impl RigConfig {
    /// Reads a file.
    ///
    /// # Errors
    /// A [`UserError`] with the line.
    pub fn read(path: &Path) -> Result<Self, UserError> {
        let text =
            std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
        let mut config = Self::parse(&text, &path.display().to_string())?;
        if let Some(folder) = std::path::absolute(path)
            .ok()
            .as_deref()
            .and_then(Path::parent)
        {
            config.resolve(folder);
        }
        Ok(config)
    }

    /// Resolves the paths of settings relative to the folder of the settings.
    pub(crate) fn resolve(&mut self, folder: &Path) {
        let whole = |path: &mut PathBuf| *path = folder.join(&*path);
        self.paint.paints.iter_mut().for_each(whole);
        self.paint.document.iter_mut().for_each(whole);
        let record = self.record.iter_mut();
        record.for_each(|record| whole(&mut record.folder));
        self.device
            .iter_mut()
            .flat_map(|device| [&mut device.hand, &mut device.replay])
            .flatten()
            .for_each(whole);
        let texts = [
            &mut self.light.illuminant,
            &mut self.light.environment,
            &mut self.view.profile,
            &mut self.canvas.ground,
        ];
        for text in texts
            .into_iter()
            .chain(self.brush.iter_mut().map(|brush| &mut brush.kind))
        {
            let path = Path::new(text.as_str());
            if path.extension().is_some() || path.components().count() > 1 {
                *text = folder.join(path).display().to_string();
            }
        }
    }

    /// Reads a text; `name` is how errors call it.
    ///
    /// # Errors
    /// A [`UserError`] with the line.
    pub fn parse(text: &str, name: &str) -> Result<Self, UserError> {
        let mut config: Self =
            toml::from_str(text).map_err(|error| toml_fault(text, name, &error))?;
        if config.brush.is_empty() {
            config.brush.push(BrushSection {
                name: "main".into(),
                kind: "round".into(),
                size_mm: None,
                depth_share: 0.5,
            });
        }
        if config.palette.wells.is_empty() && !text.contains("wells") {
            config.palette.wells = Self::default().palette.wells;
        }
        config.check(text, name)?;
        for device in &mut config.device {
            let length = check::length(&device.orientation);
            device.orientation = device.orientation.map(|part| part / length);
        }
        Ok(config)
    }

    /// As the file that nodes read.
    ///
    /// # Errors
    /// A [`UserError`] where a value cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, UserError> {
        toml::to_string(self).map_err(|error| UserError::failure(error.to_string()))
    }

    /// The brush called `name`.
    #[must_use]
    pub fn brush_named(&self, name: &str) -> Option<&BrushSection> {
        self.brush.iter().find(|brush| brush.name == name)
    }
}

/// True if a setting that may be a name is a path.
#[must_use]
pub fn is_path(text: &str) -> bool {
    let path = Path::new(text);
    path.extension().is_some() || path.components().count() > 1
}

/// A fault of the TOML reader, with its line, and the nearest key where a key is unknown.
#[must_use]
pub fn toml_fault(text: &str, name: &str, error: &toml::de::Error) -> UserError {
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let line = text[..start].matches('\n').count() + 1;
    let message = error.message();
    let fault =
        UserError::usage(message.lines().next().unwrap_or(message)).at(format!("{name}:{line}"));
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match quoted.as_slice() {
        [key, keys @ ..] if message.starts_with("unknown field") && !keys.is_empty() => UserError {
            place: fault.place,
            ..UserError::unknown(format!("unknown key '{key}'"), key, keys.iter().copied())
        },
        _ => fault.advise(Advice::DefaultSettings),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a default that is written otherwise is refused with its line, and what is quoted.
    fn refused(from: &str, to: &str, line: u32, quoted: [&str; 2]) {
        assert!(DEFAULT.contains(from), "{from}");
        let parsed = RigConfig::parse(&DEFAULT.replace(from, to), "rig.toml");
        let error = parsed.expect_err(to);
        assert_eq!(error.place, Some(format!("rig.toml:{line}")), "{error}");
        let text = error.to_string();
        assert!(quoted.iter().all(|name| text.contains(name)), "{text}");
    }

    #[test]
    fn the_default_is_valid_and_survives_writing() {
        let config = RigConfig::default();
        assert_eq!(config.canvas.cells(), [1024, 1024]);
        assert_eq!(config.canvas, CanvasSection::default());
        let again = RigConfig::parse(&config.to_toml().expect("text"), "rig.toml");
        assert_eq!(again, Ok(config));
    }

    #[test]
    fn a_misspelt_name_gets_its_line_and_the_nearest() {
        for (from, to, line, quoted) in [
            (
                "cell_mm = 0.25 ",
                "cel_mm = 0.25 ",
                12,
                ["'cel_mm'", "'cell_mm'"],
            ),
            (
                "driver = \"simulated\"",
                "driver = \"simulted\"",
                32,
                ["'simulted'", "'simulated'"],
            ),
            (
                "brush = \"main\"",
                "brush = \"mian\"",
                34,
                ["'mian'", "'main'"],
            ),
            (
                "force = \"linear\"",
                "force = \"linaer\"",
                38,
                ["'linaer'", "'linear'"],
            ),
            ("[node.paint]", "[node.piant]", 90, ["'piant'", "'paint'"]),
            (
                "[node.paint]",
                "[node.brush-mian]",
                90,
                ["'brush-mian'", "'brush-main'"],
            ),
            (
                "profile = \"srgb\"",
                "profile = \"sgrb\"",
                80,
                ["'srgb'", "ICC"],
            ),
            (
                "gamut = \"soft\"",
                "gamut = \"sfot\"",
                81,
                ["'sfot'", "'soft'"],
            ),
        ] {
            refused(from, to, line, quoted);
        }
    }

    #[test]
    fn known_nodes() {
        for node in ["brush", "brush-main", "ui", "player", "recorder", "phantom"] {
            let text = DEFAULT.replace("[node.paint]", &format!("[node.{node}]"));
            assert!(RigConfig::parse(&text, "rig.toml").is_ok(), "{node}");
        }
    }

    #[test]
    fn the_display_may_have_a_profile_of_its_own() {
        let parse = |profile: &str| {
            let text = DEFAULT.replace("profile = \"srgb\"", &format!("profile = \"{profile}\""));
            RigConfig::parse(&text, "rig.toml").map(|config| config.view.file().map(PathBuf::from))
        };
        assert_eq!(parse("display-p3"), Ok(None));
        for path in [
            "eizo.icc",
            "/usr/share/color/icc/left display.icm",
            "profiles/eizo",
        ] {
            assert_eq!(parse(path), Ok(Some(PathBuf::from(path))));
        }
    }

    #[test]
    fn no_file_says_which_libraries_are_trusted() {
        let trusting = format!("allowed_libraries = [\"/tmp/a.so\"]\n{DEFAULT}");
        assert!(RigConfig::parse(&trusting, "rig.toml").is_err());
        let mut config = RigConfig::default();
        config.allowed_libraries.push("/tmp/a.so".into());
        assert!(!config.to_toml().expect("text").contains("a.so"));
        let arm = DeviceSection::new("arm", "polhem", "main");
        let with = config.with_device(arm).expect("it fits");
        assert_eq!(with.allowed_libraries, config.allowed_libraries);
    }
}
