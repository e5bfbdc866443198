//! Corners of a device in a file of settings, of which nothing else is touched.

use std::io::Write as _;
use std::path::Path;

use glam::DVec3;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::{RigConfig, UserError, user_devices};
use toml_edit::{Array, DocumentMut, Item, TableLike, TomlError, Value};

/// Reason why corners cannot be written into a text.
#[derive(Clone, Debug, thiserror::Error)]
enum TextError {
    /// It is no TOML.
    #[error(transparent)]
    Toml(#[from] TomlError),
    /// It has no such device.
    #[error("there is no [[device]] called '{0}' any more")]
    NoDevice(String),
}

/// The corners of a device in settings, whichever they are.
pub(super) fn read(path: &Path, name: &str) -> Option<[[f64; 3]; 3]> {
    let own = user_devices::read(path).ok();
    let devices = own.or_else(|| Some(RigConfig::read(path).ok()?.device))?;
    devices.iter().find(|device| device.name == name)?.corners_m
}

/// Writes the corners of a device into the settings, and nothing else of them.
pub(super) fn write(path: &Path, device: &str, corners: &[DVec3; 3]) -> Result<(), UserError> {
    // Changes made to the file meanwhile stay.
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    let place = path.display().to_string();
    let text = with_corners(&text, device, corners).map_err(|error| {
        UserError::failure(error.to_string())
            .at(place.clone())
            .help("see what was changed in the file")
    })?;
    if user_devices::parse(&text, path).is_err() {
        RigConfig::parse(&text, &place)?;
    }
    write_whole(path, Kind::Own, |file| file.write_all(text.as_bytes()))
        .map_err(|error| UserError::writing(path, &error))
}

/// The settings with other corners of a device, to a thousandth of a millimetre; comments and all else
/// are as they were.
fn with_corners(text: &str, device: &str, corners: &[DVec3; 3]) -> Result<String, TextError> {
    let mut settings: DocumentMut = text.parse()?;
    let missing = || TextError::NoDevice(device.to_owned());
    let is_meant = |table: &dyn TableLike| table.get("name").and_then(Item::as_str) == Some(device);
    match settings.get_mut("device").ok_or_else(missing)? {
        Item::ArrayOfTables(tables) => {
            let mut tables = tables.iter_mut();
            let table = tables.find(|table| is_meant(*table)).ok_or_else(missing)?;
            set(table, corners);
        }
        Item::Value(Value::Array(tables)) => {
            let mut tables = tables.iter_mut().filter_map(Value::as_inline_table_mut);
            let table = tables.find(|table| is_meant(*table)).ok_or_else(missing)?;
            set(table, corners);
        }
        _ => return Err(missing()),
    }
    Ok(settings.to_string())
}

fn set(table: &mut dyn TableLike, corners: &[DVec3; 3]) {
    const KEY: &str = "corners_m";
    let round = |metres: f64| (metres * 1e6).round() * 1e-6;
    let corner = |corner: &DVec3| {
        let metres = corner.to_array().map(round);
        // A multiple of a power of ten is not always the nearest number to its digits.
        Value::from_iter(metres.map(|metres| format!("{metres:.6}").parse().unwrap_or(metres)))
    };
    let mut value = Value::Array(Array::from_iter(corners.iter().map(corner)));
    match table.get_mut(KEY).and_then(Item::as_value_mut) {
        Some(before) => {
            *value.decor_mut() = before.decor().clone();
            *before = value;
        }
        None => {
            table.insert(KEY, Item::Value(value));
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_rig::config::DEFAULT;

    use super::*;

    const CORNERS: [DVec3; 3] = [
        DVec3::new(-0.064_000_4, -0.048, 0.0),
        DVec3::new(0.064, -0.048, 1e-9),
        DVec3::new(-0.064, 0.048, 0.02),
    ];
    const LINE: &str =
        "corners_m = [[-0.064, -0.048, 0.0], [0.064, -0.048, 0.0], [-0.064, 0.048, 0.02]]";

    #[test]
    fn only_the_corners_change() {
        let written = with_corners(DEFAULT, "phantom", &CORNERS).expect("written");
        let added: Vec<&str> = written
            .lines()
            .filter(|line| !DEFAULT.contains(line))
            .collect();
        assert_eq!(added, [LINE]);
        let without = written.replace(&format!("{LINE}\n"), "");
        assert_eq!(without, DEFAULT);
        let config = RigConfig::parse(&written, "rig.toml").expect("valid");
        assert_eq!(config.device[0].corners_m.map(|c| c[2][2]), Some(0.02));
        // And again, with what was written beside it.
        let before = written.replace(LINE, &format!("{LINE} # by hand"));
        let moved = CORNERS.map(|corner| corner + DVec3::Z * 0.1);
        let again = with_corners(&before, "phantom", &moved).expect("written");
        assert_eq!(again.matches("\ncorners_m").count(), 1);
        let line = again.lines().find(|line| line.starts_with("corners_m"));
        let (_, comment) = line
            .and_then(|line| line.split_once('#'))
            .expect("a comment");
        assert_eq!(comment, " by hand");
        let config = RigConfig::parse(&again, "rig.toml").expect("valid");
        assert_eq!(config.device[0].corners_m.map(|c| c[2][2]), Some(0.12));
    }

    #[test]
    fn of_several_devices_the_meant_one_is_fitted_in_whatever_way_they_are_written() {
        let inline = "device = [ # two\n  {name = 'a', driver = 'polhem', brush = 'main'},\n  \
                      {name = 'b', driver = 'polhem', brush = 'main'}, # the second\n]\n";
        let written = with_corners(inline, "b", &CORNERS).expect("written");
        let config = RigConfig::parse(&written, "rig.toml").expect("valid");
        assert!(config.device[0].corners_m.is_none() && config.device[1].corners_m.is_some());
        let comments = |text: &str| -> Vec<String> {
            let comments = text.lines().filter_map(|line| line.split_once('#'));
            comments.map(|(_, comment)| comment.to_owned()).collect()
        };
        assert_eq!(comments(&written), comments(inline));
        for (text, name) in [(inline, "c"), ("", "a"), ("device = 3", "a")] {
            let wrong = with_corners(text, name, &CORNERS).expect_err(text);
            assert!(matches!(wrong, TextError::NoDevice(own) if own == name));
        }
    }
}
