//! The pen in a tablet's events. The range of its rotation is one turn, clockwise seen from above, which begins where the
//! switches point to the right (libinput). Where a driver gives no resolution:
//!
//! | axis | is taken for |
//! | --- | --- |
//! | X, Y | 5080 counts an inch; an area of less than 1 cm or more than 2 m is taken for 25 cm on its longer side |
//! | tilts | degrees, where the range is within ±90, else the range is ±64°, as libinput has it |
//! | distance | the range is 1 cm |

use std::f64::consts::TAU;

use evdev::{AbsoluteAxisCode as Abs, KeyCode as Key};
use maulstick_device::pen::{End, Presence, Reading, STEEPEST_RAD};
use maulstick_types::stylus::axes;

use super::capabilities::{Axis, Capabilities};
use super::frame::{self, kind};
use crate::layout::{COUNTS_M, HIGHEST_M, PRESSED, plausible_m, wrapped};

/// Tools that are a pen, the eraser last.
const TOOLS: [Key; 5] = [
    Key::BTN_TOOL_PEN,
    Key::BTN_TOOL_BRUSH,
    Key::BTN_TOOL_PENCIL,
    Key::BTN_TOOL_AIRBRUSH,
    Key::BTN_TOOL_RUBBER,
];
/// Barrel switches, that nearest to the tip first.
const SWITCHES: [Key; 3] = [Key::BTN_STYLUS, Key::BTN_STYLUS2, BTN_STYLUS3];
/// The third barrel switch, which the crate does not name.
const BTN_STYLUS3: Key = Key(0x149);
/// The tilt at the end of a range without resolution, degrees.
const FARTHEST_DEG: f64 = 64.0;

/// A pen, and the newest state of its axes and keys.
#[derive(Clone, Debug)]
pub struct EvdevPen {
    x: Tracked,
    y: Tracked,
    pressure: Option<Tracked>,
    tilt: Option<[Tracked; 2]>,
    twist: Option<Tracked>,
    distance: Option<Tracked>,
    area_m: [f64; 2],
    has_touch: bool,
    senses: u32,
    /// Keys that are down, of those that matter.
    down: Vec<u16>,
}

/// An axis and its newest value.
#[derive(Clone, Copy, Debug)]
struct Tracked {
    axis: Axis,
    counts: f64,
    value: f64,
}

impl Tracked {
    fn of(capabilities: &Capabilities, code: Abs) -> Option<Self> {
        let axis = capabilities.axis(code)?;
        Some(Self {
            axis,
            counts: axis.counts()?,
            // As the kernel begins: a recording has only what changes.
            value: 0.clamp(axis.range[0], axis.range[1]).into(),
        })
    }

    /// Share of the range, 0 to 1.
    fn share(&self) -> f64 {
        (self.value - f64::from(self.axis.range[0])) / self.counts
    }

    /// Length of its range, m.
    fn length_m(&self) -> Option<f64> {
        (self.axis.resolution > 0).then(|| 1e-3 * self.counts / f64::from(self.axis.resolution))
    }

    /// A tilt, rad.
    fn tilt_rad(&self) -> f64 {
        let [least, most] = self.axis.range.map(f64::from);
        let rad = match self.axis.resolution {
            0 if least < 0.0 && least.abs().max(most) <= 90.0 => self.value.to_radians(),
            0 => (2.0 * self.share() - 1.0) * FARTHEST_DEG.to_radians(),
            resolution => self.value / f64::from(resolution),
        };
        rad.clamp(-STEEPEST_RAD, STEEPEST_RAD)
    }

    /// A rotation, rad, from where the switches point away from the hand.
    fn twist_rad(&self) -> f64 {
        wrapped(-(0.25 + self.share()) * TAU)
    }
}

impl EvdevPen {
    /// The pen of a device; `None` if it has none, or does not say where it is.
    #[must_use]
    pub fn of(capabilities: &Capabilities) -> Option<Self> {
        let axis = |code| Tracked::of(capabilities, code);
        if !TOOLS.iter().any(|tool| capabilities.has(*tool)) {
            return None;
        }
        let (x, y) = (axis(Abs::ABS_X)?, axis(Abs::ABS_Y)?);
        let sides = [x, y].map(|side| side.length_m().unwrap_or(side.counts / COUNTS_M));
        let (pressure, twist) = (axis(Abs::ABS_PRESSURE), axis(Abs::ABS_Z));
        let tilt = axis(Abs::ABS_TILT_X).zip(axis(Abs::ABS_TILT_Y));
        let has_switch = SWITCHES.iter().any(|switch| capabilities.has(*switch));
        let mut senses = axes::POSITION | axes::PROXIMITY;
        for (is_sensed, axis) in [
            (pressure.is_some(), axes::PRESSURE),
            (tilt.is_some(), axes::TILT),
            (twist.is_some(), axes::TWIST),
            (has_switch, axes::SWITCHES),
        ] {
            senses |= if is_sensed { axis } else { 0 };
        }
        Some(Self {
            x,
            y,
            pressure,
            tilt: tilt.map(|(x, y)| [x, y]),
            twist,
            distance: axis(Abs::ABS_DISTANCE),
            area_m: plausible_m(sides, [x.counts, y.counts]),
            has_touch: capabilities.has(Key::BTN_TOUCH),
            senses,
            down: Vec::new(),
        })
    }

    /// Width and height of the active area, m.
    #[must_use]
    pub fn area_m(&self) -> [f64; 2] {
        self.area_m
    }

    /// Axes that the pen senses, see [`axes`].
    #[must_use]
    pub fn senses(&self) -> u32 {
        self.senses
    }

    /// Reads the events of one time.
    pub fn decode(&mut self, events: &[u8]) -> Option<Reading> {
        let mut is_any = false;
        for event in frame::events(events) {
            match event.kind {
                kind::ABS => self.move_axis(event.code, event.value),
                kind::KEY => {
                    self.down.retain(|key| *key != event.code);
                    if event.value != 0 {
                        self.down.push(event.code);
                    }
                }
                _ => continue,
            }
            is_any = true;
        }
        is_any.then(|| self.reading())
    }

    fn move_axis(&mut self, code: u16, value: i32) {
        let [tilt_x, tilt_y] = match &mut self.tilt {
            Some([x, y]) => [Some(x), Some(y)],
            None => [None, None],
        };
        let axes = [Some(&mut self.x), Some(&mut self.y), tilt_x, tilt_y];
        let others = [&mut self.pressure, &mut self.twist, &mut self.distance].map(Option::as_mut);
        let mut all = axes.into_iter().chain(others).flatten();
        if let Some(moved) = all.find(|tracked| tracked.axis.code == code) {
            let [least, most] = moved.axis.range;
            moved.value = value.clamp(least, most).into();
        }
    }

    fn is_down(&self, key: Key) -> bool {
        self.down.contains(&key.0)
    }

    fn reading(&self) -> Reading {
        let pressure = self.pressure.map(|pressure| pressure.share());
        let touches = if self.has_touch {
            self.is_down(Key::BTN_TOUCH)
        } else {
            pressure.is_some_and(|pressure| pressure > 0.0)
        };
        let presence = match (TOOLS.iter().any(|tool| self.is_down(*tool)), touches) {
            (false, _) => Presence::Away,
            (true, false) => Presence::Hovering,
            (true, true) => Presence::Touching,
        };
        let end = if self.is_down(Key::BTN_TOOL_RUBBER) {
            End::Eraser
        } else {
            End::Tip
        };
        let height_m = self.distance.map_or(0.0, |distance| {
            distance.share() * distance.length_m().unwrap_or(HIGHEST_M).min(HIGHEST_M)
        });
        let switches = SWITCHES.iter().enumerate();
        Reading {
            presence,
            end,
            // A tablet counts toward the hand.
            point_m: [
                self.x.share() * self.area_m[0],
                (1.0 - self.y.share()) * self.area_m[1],
            ],
            height_m,
            pressure: pressure.unwrap_or(PRESSED),
            tilt_rad: self.tilt.map(|[x, y]| [x.tilt_rad(), -y.tilt_rad()]),
            twist_rad: self.twist.map(|twist| twist.twist_rad()),
            switches: switches.fold(0, |all, (bit, key)| {
                all | u32::from(self.is_down(*key)) << bit
            }),
        }
    }
}
