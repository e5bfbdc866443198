//! Allowed values of the settings of a rig.

use maulstick_types::limits::{CELLS, CELLS_MAX};
use maulstick_types::nearest::choice;
use maulstick_types::wire::topics::check_name;

use super::check_driver::check_driver;
use super::wrong::{Wrong, line_of};
use super::{
    ACTIONS, BACKENDS, BRUSH_NODE, BrushSection, CanvasSection, DRIVERS, DeviceSection, FORCES,
    GAMUTS, MOST_PAINT_DRAG, RESERVED, RigConfig,
};
use crate::user_error::UserError;

/// Nodes of every rig, and what all brush nodes are called.
const NODES: [&str; 5] = ["paint", "brush", "ui", "player", "recorder"];
/// A quaternion written by hand counts as a unit one within this.
const UNIT_TOLERANCE: f64 = 1e-3;

impl RigConfig {
    pub(super) fn check(&self, text: &str, name: &str) -> Result<(), UserError> {
        let fault = |what: String, key: &str, value: &str| {
            UserError::usage(what).at(format!("{name}:{}", line_of(text, key, value)))
        };
        self.check_names()
            .and_then(|()| self.check_devices())
            .and_then(|()| self.check_brushes())
            .and_then(|()| check_canvas(&self.canvas))
            .map_err(|wrong| wrong.fault(text, name))?;
        choose(
            "behaviour of piles",
            &self.palette.piles,
            &crate::config::PILES,
        )
        .map_err(|(what, help)| fault(what, "piles", "").help(help))?;
        self.light.light().check().map_err(|what| {
            UserError::from(what).at(format!("{name}:{}", line_of(text, "[light]", "")))
        })?;
        self.check_nodes()
            .map_err(|(what, help, node)| fault(what, "[node.", &node).help(help))?;
        choose("backend", &self.paint.backend, &BACKENDS)
            .map_err(|(what, help)| fault(what, "[paint]", "").help(help))?;
        self.paint.room().map_err(|error| {
            fault(error.to_string(), "[paint]", "").help("write sizes as 512M or 2G")
        })?;
        let record = self.record.as_ref();
        record
            .map_or(Ok(()), crate::config::RecordSection::check)
            .map_err(|(key, what, help)| fault(what, key, "").help(help))?;
        let view = &self.view;
        view.check().map_err(|(what, help)| {
            let (key, value) = if GAMUTS.contains(&view.gamut.as_str()) {
                ("profile", &view.profile)
            } else {
                ("gamut", &view.gamut)
            };
            fault(what, key, value).help(help)
        })
    }

    fn check_names(&self) -> Result<(), Wrong> {
        let devices = self.device.iter().map(|device| &device.name);
        let brushes = self.brush.iter().map(|brush| &brush.name);
        for name in [&self.rig.name].into_iter().chain(devices).chain(brushes) {
            check_name(name).map_err(|error| Wrong {
                what: format!("the name {error}"),
                key: "name",
                value: name.clone(),
                help: "choose another name".into(),
            })?;
        }
        Ok(())
    }

    fn check_devices(&self) -> Result<(), Wrong> {
        for (place, device) in self.device.iter().enumerate() {
            let others = self.device[..place].iter().map(|other| &other.name);
            unique("devices", &device.name, others)?;
            self.check_device(device)?;
            check_placement(device)?;
            check_hand(device)?;
            check_driver(device)?;
        }
        Ok(())
    }

    fn check_brushes(&self) -> Result<(), Wrong> {
        for (place, brush) in self.brush.iter().enumerate() {
            let others = self.brush[..place].iter().map(|other| &other.name);
            unique("brushes", &brush.name, others)?;
            check_brush(brush)?;
        }
        Ok(())
    }

    /// Settings are those of a node of this rig, or of all whose names begin with one word.
    pub(super) fn check_nodes(&self) -> Result<(), (String, String, String)> {
        let brushes = self.brush.iter();
        let brushes = brushes.map(|brush| format!("{BRUSH_NODE}{}", brush.name));
        let devices = self.device.iter().map(|device| device.name.clone());
        let own = NODES.map(str::to_owned).into_iter();
        let names: Vec<String> = own.chain(brushes).chain(devices).collect();
        let is_first = |node: &str| {
            names
                .iter()
                .any(|name| name.split('-').next() == Some(node))
        };
        for node in self.node.keys() {
            if !names.contains(node) && !is_first(node) {
                let (what, help) = unknown("node", node, names.iter().map(String::as_str));
                return Err((what, help, node.clone()));
            }
        }
        Ok(())
    }

    /// Checks a device: its motors follow these numbers.
    fn check_device(&self, device: &DeviceSection) -> Result<(), Wrong> {
        let name = &device.name;
        if RESERVED.contains(&name.as_str()) || name.starts_with(BRUSH_NODE) {
            return Err(Wrong {
                what: format!("the rig itself has something called '{name}'"),
                key: "name",
                value: name.clone(),
                help: format!(
                    "a device cannot be called {} or {BRUSH_NODE}…",
                    RESERVED.join(", ")
                ),
            });
        }
        let wrong = |(what, help), key, value: &str| Wrong {
            what,
            key,
            value: value.to_owned(),
            help,
        };
        choose("driver", &device.driver, &DRIVERS)
            .map_err(|told| wrong(told, "driver", &device.driver))?;
        choose("force", &device.force, &FORCES)
            .map_err(|told| wrong(told, "force", &device.force))?;
        if self.brush_named(&device.brush).is_none() {
            let names = self.brush.iter().map(|brush| brush.name.as_str());
            let told = unknown("brush", &device.brush, names);
            return Err(wrong(told, "brush", &device.brush));
        }
        for action in device.switches.iter().flatten() {
            choose("action of a switch", action, &ACTIONS)
                .map_err(|told| wrong(told, "switches", action))?;
        }
        Ok(())
    }
}

fn check_canvas(canvas: &CanvasSection) -> Result<(), Wrong> {
    for (key, value) in [
        ("width_mm", canvas.width_mm),
        ("height_mm", canvas.height_mm),
    ] {
        let cells = value / canvas.cell_mm;
        if !(canvas.cell_mm > 0.0 && CELLS.contains(&cells)) {
            return Err(Wrong {
                what: format!("{key} = {value} with cells of {} mm", canvas.cell_mm),
                key,
                value: String::new(),
                help: format!("choose a size of 1 to {CELLS_MAX} cells"),
            });
        }
    }
    if (0.0..=1000.0).contains(&canvas.stain_um) {
        return Ok(());
    }
    Err(Wrong {
        what: format!("stain_um = {}", canvas.stain_um),
        key: "stain_um",
        value: String::new(),
        help: "choose 0 to 1000 µm".into(),
    })
}

/// Checks where a device stands on the desk, and what of it is the ferrule.
fn check_placement(device: &DeviceSection) -> Result<(), Wrong> {
    let name = &device.name;
    if !device.position_m.iter().all(|value| value.is_finite()) {
        let help = "write three plain numbers, in metres";
        return Err(Wrong::value(name, "position_m", device.position_m, help));
    }
    let unit = 1.0 - UNIT_TOLERANCE..=1.0 + UNIT_TOLERANCE;
    if !unit.contains(&length(&device.orientation)) {
        let help = "write a quaternion x, y, z, w of length 1; no turn is [0, 0, 0, 1]";
        return Err(Wrong::value(name, "orientation", device.orientation, help));
    }
    if let Some(scale) = device.scale
        && !(SCALES[0]..=SCALES[1]).contains(&scale)
    {
        let help = "choose 0.05 to 20 desk lengths per device length";
        return Err(Wrong::value(name, "scale", scale, help));
    }
    if !device.ferrule_m.iter().all(|value| value.abs() <= 0.5) {
        let help = "write three numbers in metres, none beyond half a metre";
        return Err(Wrong::value(name, "ferrule_m", device.ferrule_m, help));
    }
    if let Some(corners) = device.corners_m
        && !are_corners(&corners)
    {
        let help = "three places in metres, not on one line, as a calibration writes them";
        return Err(Wrong::value(name, "corners_m", corners, help));
    }
    Ok(())
}

/// Checks what a device gives to the hand and takes from it.
fn check_hand(device: &DeviceSection) -> Result<(), Wrong> {
    let name = &device.name;
    if !(device.max_force_n.is_finite() && device.max_force_n >= 0.0) {
        let help = "choose 0 or more newtons; the device's own limit holds too";
        return Err(Wrong::value(name, "max_force_n", device.max_force_n, help));
    }
    if !(0.0..=MOST_PAINT_DRAG).contains(&device.paint_drag) {
        let help = "choose 0 to 10 times the paint's own drag; 1 is its true size";
        return Err(Wrong::value(name, "paint_drag", device.paint_drag, help));
    }
    if !(0.0..=1.0).contains(&device.relief) {
        let help = "choose 0, a flat canvas, to 1, relief of its true height";
        return Err(Wrong::value(name, "relief", device.relief, help));
    }
    if !is_curve(&device.pressure_curve) {
        let help = "points [sensed, given] that rise from [0, 0] to [1, 1], at most 32";
        let curve = &device.pressure_curve;
        return Err(Wrong::value(name, "pressure_curve", curve, help));
    }
    Ok(())
}

/// Desk lengths per device length.
const SCALES: [f64; 2] = [0.05, 20.0];

/// True if three points span a plane: sides of 5 mm to 10 m, at least 10 degrees apart.
fn are_corners(corners: &[[f64; 3]; 3]) -> bool {
    let side = |to: usize| [0, 1, 2].map(|i| corners[to][i] - corners[0][i]);
    let (a, b) = (side(1), side(2));
    let dot = |u: &[f64; 3], v: &[f64; 3]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
    let (long, wide) = (dot(&a, &a).sqrt(), dot(&b, &b).sqrt());
    let sides = [long, wide]
        .iter()
        .all(|side| (0.005..=10.0).contains(side));
    sides && dot(&a, &b).abs() < 0.985 * long * wide
}

/// True if points rise from (0, 0) to (1, 1).
fn is_curve(points: &[[f64; 2]]) -> bool {
    let rises = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1];
    (2..=32).contains(&points.len())
        && points.first() == Some(&[0.0, 0.0])
        && points.last() == Some(&[1.0, 1.0])
        && points.windows(2).all(rises)
}

fn unique<'a>(
    kind: &str,
    name: &str,
    mut others: impl Iterator<Item = &'a String>,
) -> Result<(), Wrong> {
    if others.any(|other| other == name) {
        return Err(Wrong {
            what: format!("two {kind} are called '{name}'"),
            key: "name",
            value: name.to_owned(),
            help: "give each its own name".into(),
        });
    }
    Ok(())
}

pub(super) fn length(quaternion: &[f64; 4]) -> f64 {
    quaternion
        .iter()
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt()
}

fn check_brush(brush: &BrushSection) -> Result<(), Wrong> {
    if let Some(size_mm) = brush.size_mm
        && !(0.1..=300.0).contains(&size_mm)
    {
        let help = "choose 0.1 to 300";
        return Err(Wrong::value(&brush.name, "size_mm", size_mm, help));
    }
    if !(0.0..=0.9).contains(&brush.depth_share) {
        let (share, help) = (brush.depth_share, "choose 0 to 0.9");
        return Err(Wrong::value(&brush.name, "depth_share", share, help));
    }
    Ok(())
}

fn unknown<'a>(kind: &str, name: &str, names: impl Iterator<Item = &'a str>) -> (String, String) {
    (
        format!("there is no {kind} called '{name}'"),
        choice(name, names),
    )
}

pub(super) fn choose(
    kind: &str,
    name: &str,
    names: &[&'static str],
) -> Result<(), (String, String)> {
    if names.contains(&name) {
        Ok(())
    } else {
        Err(unknown(kind, name, names.iter().copied()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::DEFAULT;

    fn error(from: &str, to: &str) -> String {
        assert!(DEFAULT.contains(from), "{from}");
        RigConfig::parse(&DEFAULT.replace(from, to), "rig.toml")
            .expect_err(to)
            .to_string()
    }

    #[test]
    fn impossible_numbers_are_refused() {
        assert!(error("width_mm = 256", "width_mm = -1").contains("width_mm"));
        assert!(error("cell_mm = 0.25", "cell_mm = 0").contains("cells"));
        assert!(error("size_mm = 10", "size_mm = nan").contains("size_mm"));
        assert!(error("name = \"studio\"", "name = \"./studio\"").contains("./studio"));
        assert!(error("width_mm = 256", "width_mm = \"wide\"").contains("rig.toml:10"));
        assert!(error("[rig]", "[rig").contains("rig.toml:5"));
    }

    #[test]
    fn numbers_that_no_motor_may_get_are_refused_with_their_line() {
        for force in ["-1", "-1e-9", "nan", "inf"] {
            let text = error("max_force_n = 3.0", &format!("max_force_n = {force}"));
            assert!(
                text.contains("max_force_n") && text.contains("rig.toml:37"),
                "{text}"
            );
        }
        for turn in [
            "0, 0, 0, 0",
            "0, 0, 0, 2",
            "1, 0, 0, 1",
            "nan, 0, 0, 1",
            "0, 0, 0, inf",
        ] {
            let text = error(
                "orientation = [0, 0, 0, 1]",
                &format!("orientation = [{turn}]"),
            );
            assert!(
                text.contains("orientation") && text.contains("rig.toml:36"),
                "{text}"
            );
        }
        for (line, help) in [
            ("scale = 0", "0.05"),
            ("scale = nan", "0.05"),
            ("paint_drag = 11", "true size"),
            ("paint_drag = nan", "true size"),
            ("relief = 1.1", "true height"),
            ("relief = -0.1", "true height"),
            ("relief = nan", "true height"),
            ("ferrule_m = [0, 0, 3]", "half a metre"),
            ("ferrule_m = [0, nan, 0]", "half a metre"),
            ("corners_m = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]", "one line"),
            ("corners_m = [[0, 0, 0], [0, 0, 0], [0, 1, 0]]", "one line"),
            ("pressure_curve = [[0, 0]]", "rise"),
            (
                "pressure_curve = [[0, 0], [0.5, 0.6], [0.4, 0.7], [1, 1]]",
                "rise",
            ),
            ("pressure_curve = [[0, 0], [0.5, nan], [1, 1]]", "rise"),
            ("switches = [\"undo\", \"cluch\"]", "'clutch'"),
        ] {
            let text = error("max_force_n = 3.0", &format!("{line}\nmax_force_n = 3.0"));
            let key = line.split(' ').next().expect("a key");
            let told = if key == "switches" { "cluch" } else { key };
            assert!(text.contains(told) && text.contains(help), "{text}");
            assert!(text.contains("rig.toml:37"), "{text}");
        }
        for place in ["nan, 0, 0", "0, inf, 0", "0, 0, -inf"] {
            let text = error("position_m = [0, 0, 0]", &format!("position_m = [{place}]"));
            assert!(
                text.contains("position_m") && text.contains("rig.toml:35"),
                "{text}"
            );
        }
    }

    #[test]
    fn a_turn_written_with_few_digits_becomes_a_unit_one() {
        let turned = DEFAULT.replace("[0, 0, 0, 1]", "[0.7071, 0, 0, 0.7071]");
        let config = RigConfig::parse(&turned, "rig.toml").expect("valid");
        assert!((length(&config.device[0].orientation) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn names_that_would_collide_in_the_rig_are_refused() {
        for name in [
            "hub",
            "paint",
            "ui",
            "player",
            "recorder",
            "mouse",
            "brush-main",
            "brush-x",
        ] {
            let text = error("name = \"phantom\"", &format!("name = \"{name}\""));
            assert!(
                text.contains(&format!("'{name}'")) && text.contains("rig.toml:31"),
                "{text}"
            );
        }
        let twice = |section: &str| {
            let start = DEFAULT.find(section).expect("a section");
            let end = DEFAULT[start..]
                .find("\n\n")
                .map_or(DEFAULT.len(), |end| start + end);
            let text = format!("{DEFAULT}\n{}\n", &DEFAULT[start..end]);
            RigConfig::parse(&text, "rig.toml").expect_err(section).what
        };
        assert_eq!(twice("[[device]]"), "two devices are called 'phantom'");
        assert_eq!(twice("[[brush]]"), "two brushes are called 'main'");
    }
}
