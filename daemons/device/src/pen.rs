//! State of a pen, and the order of its changes.
//!
//! A pen is away, hovers or touches, with its tip or its eraser (usage tables of HID, page 0x0D, as Windows and Linux
//! read them: Invert while the eraser hovers, Eraser while it touches). [`Pen`] adds the changes that a tablet leaves
//! out: a pen that touched is lifted before it goes, and one that was turned round has been away. A silent tablet means
//! that nothing has changed.

/// Steepest tilt of a sample, rad.
pub const STEEPEST_RAD: f64 = 85.0 * std::f64::consts::PI / 180.0;
/// Pressure of a tip that touches without any, a step of the finest pens: pressure 0 is a pen in the air.
pub const LEAST_PRESSURE: f64 = 1.0 / 8192.0;

/// Presence of a pen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Nowhere near.
    Away,
    /// Near enough to be sensed.
    Hovering,
    /// On the tablet.
    Touching,
}

/// The end of a pen that is down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The tip.
    Tip,
    /// The eraser.
    Eraser,
}

/// Reading of a pen at a time, in the tablet's frame: origin at the lower left corner of its active area, x right, y up
/// (away from the hand), z out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Presence.
    pub presence: Presence,
    /// The end that is down.
    pub end: End,
    /// The point under it, m.
    pub point_m: [f64; 2],
    /// Hover height, m; 0 if the tablet does not say, and while it touches.
    pub height_m: f64,
    /// 0 to 1; while it touches at least [`LEAST_PRESSURE`], else 0.
    pub pressure: f64,
    /// By how much its far end leans toward +x and +y, rad, as in
    /// [`StylusPose::Contact`](maulstick_types::stylus::StylusPose::Contact).
    pub tilt_rad: Option<[f64; 2]>,
    /// Rotation about its axis, rad, right-handed about the direction to its far end.
    pub twist_rad: Option<f64>,
    /// A bit a pressed switch, that nearest to the tip first.
    pub switches: u32,
}

impl Reading {
    /// A pen that is nowhere near.
    pub const AWAY: Self = Self {
        presence: Presence::Away,
        end: End::Tip,
        point_m: [0.0; 2],
        height_m: 0.0,
        pressure: 0.0,
        tilt_rad: None,
        twist_rad: None,
        switches: 0,
    };
}

/// Completes a tablet's readings to a sequence that a pen can have moved in.
#[derive(Clone, Debug)]
pub struct Pen {
    newest: Reading,
}

impl Default for Pen {
    fn default() -> Self {
        Self {
            newest: Reading::AWAY,
        }
    }
}

impl Pen {
    /// The newest reading.
    #[must_use]
    pub fn newest(&self) -> &Reading {
        &self.newest
    }

    /// Takes in a reading of the tablet; the pen's resulting readings go to `tell`, one to three.
    pub fn follow(&mut self, said: Reading, tell: &mut impl FnMut(Reading)) {
        if said.presence == Presence::Away {
            self.leave(tell);
            return;
        }
        if said.end != self.newest.end {
            self.leave(tell);
        }
        let (pressure, height_m) = match said.presence {
            Presence::Touching => (said.pressure.clamp(LEAST_PRESSURE, 1.0), 0.0),
            _ => (0.0, said.height_m),
        };
        let followed = Reading {
            pressure,
            height_m,
            ..said
        };
        self.tell(followed, tell);
    }

    /// The pen is gone, or its tablet: it is lifted where it was, and leaves. A pen that is away already sends nothing.
    pub fn leave(&mut self, tell: &mut impl FnMut(Reading)) {
        if self.newest.presence == Presence::Touching {
            let lifted = Reading {
                presence: Presence::Hovering,
                pressure: 0.0,
                ..self.newest
            };
            self.tell(lifted, tell);
        }
        if self.newest.presence == Presence::Hovering {
            let gone = Reading {
                presence: Presence::Away,
                switches: 0,
                ..self.newest
            };
            self.tell(gone, tell);
        }
    }

    fn tell(&mut self, reading: Reading, tell: &mut impl FnMut(Reading)) {
        self.newest = reading;
        tell(reading);
    }
}
