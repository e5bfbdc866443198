//! Peers in other languages, built where their libraries are installed.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use maulstick_device::Take;
use maulstick_rig::UserError;
use maulstick_types::stylus::StylusPose;

/// Strokes painted by libmypaint.
const SOURCE: &str = include_str!("libmypaint.c");
/// Its smudging brush, of Debian's `mypaint-brushes`.
const BRUSH: &str = "/usr/share/mypaint-data/1.0/brushes/classic/modelling.myb";
/// Side of the canvas, pixels.
const SIDE: f64 = 1024.0;
/// Side of a pixel, m.
const PIXEL_M: f64 = 2.5e-4;
/// Radius of the brush, pixels.
const RADIUS: &str = "20";
/// Hue and saturation of the paints that strokes take in turn.
const PAINTS: [[f64; 2]; 4] = [[0.63, 0.9], [0.0, 0.8], [0.12, 0.7], [0.48, 0.5]];

/// libmypaint with the strokes of a take.
#[derive(Debug)]
pub(crate) struct Libmypaint {
    program: PathBuf,
    events: PathBuf,
}

impl Libmypaint {
    /// Builds it in a folder; none where libmypaint, its brushes or a C compiler are missing.
    pub(crate) fn build(place: &Path, take: &Take) -> Option<Self> {
        let (source, program) = (place.join("libmypaint.c"), place.join("libmypaint"));
        let events = place.join("events.txt");
        std::fs::write(&source, SOURCE).ok()?;
        std::fs::write(&events, events_of(take)).ok()?;
        let flags = Command::new("pkg-config")
            .args(["--cflags", "--libs", "libmypaint"])
            .output()
            .ok()?;
        let flags = String::from_utf8(flags.stdout).ok()?;
        let built = Command::new("cc")
            .arg("-O2")
            .arg("-o")
            .args([&program, &source])
            .args(flags.split_whitespace())
            .arg("-lm")
            .stderr(Stdio::null())
            .status()
            .ok()?;
        (built.success() && Path::new(BRUSH).exists()).then_some(Self { program, events })
    }

    /// Paints the strokes once.
    pub(crate) fn paint(&self) -> Result<(), UserError> {
        let fault = |error: std::io::Error| UserError::failure(error.to_string());
        let events = std::fs::File::open(&self.events).map_err(fault)?;
        let mut command = Command::new(&self.program);
        let status = command
            .args([BRUSH, &SIDE.to_string(), RADIUS])
            .stdin(events)
            .status()
            .map_err(fault)?;
        if status.success() {
            Ok(())
        } else {
            Err(UserError::failure("libmypaint cannot paint the recording"))
        }
    }
}

/// The samples in contact, as libmypaint.c reads them.
fn events_of(take: &Take) -> String {
    let (mut events, mut before, mut strokes) = (Vec::new(), None, 0);
    for sample in &take.samples {
        let StylusPose::Contact {
            point_m, pressure, ..
        } = sample.sample.pose
        else {
            continue;
        };
        if sample.sample.in_air() {
            before = None;
            continue;
        }
        let seconds = match before.replace(sample.time_ns) {
            Some(before) => (sample.time_ns - before) as f64 * 1e-9,
            None => {
                strokes += 1;
                -1.0
            }
        };
        let [hue, saturation] = PAINTS[(strokes - 1) % PAINTS.len()];
        let [x, y] = [point_m[0], -point_m[1]].map(|m| m / PIXEL_M + 0.5 * SIDE);
        events.push(format!("{x} {y} {pressure} {seconds} {hue} {saturation}"));
    }
    events.join("\n")
}
