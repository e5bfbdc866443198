//! How a Phantom learns where it is.
//!
//! Of the styles that a model has, the one that asks least of the user is taken: it finds its marks by
//! itself, or the stylus is put into the inkwell, or its encoders are set to zero as the arm stands. The
//! last is done only where the user says that the arm stands in its reset position, by the stylus's
//! first button: zero anywhere else would have it push at random. While a device does not know where
//! it is, it is out of range and gives no force.
//!
//! All of it is done within a frame, by the thread that has it: a frame and an update are never under
//! way together.

use super::abi::{calibration, style};
use super::session::Session;

/// How a model is calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// By itself.
    Auto,
    /// In the inkwell.
    Inkwell,
    /// As the arm stands.
    EncoderReset,
}

impl Style {
    /// The one of a mask that asks least of the user.
    #[must_use]
    pub fn of(mask: i32) -> Option<Self> {
        [Self::Auto, Self::Inkwell, Self::EncoderReset]
            .into_iter()
            .find(|style| mask as u32 & style.bit() != 0)
    }

    fn bit(self) -> u32 {
        match self {
            Self::Auto => style::AUTO,
            Self::Inkwell => style::INKWELL,
            Self::EncoderReset => style::ENCODER_RESET,
        }
    }
}

/// How a device stands with its calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It is not known yet, or about to be updated.
    Unknown,
    /// It knows where it is.
    Calibrated,
    /// It waits for the stylus in the inkwell.
    Inkwell,
    /// It waits until it has found its marks.
    Marks,
    /// It waits for the button, the arm in its reset position.
    Reset,
    /// We cannot calibrate it.
    Foreign,
}

impl Standing {
    const ALL: [Self; 6] = [
        Self::Unknown,
        Self::Calibrated,
        Self::Inkwell,
        Self::Marks,
        Self::Reset,
        Self::Foreign,
    ];

    /// The one of a number, as `as u8` makes it.
    #[must_use]
    pub fn numbered(number: u8) -> Self {
        let standing = Self::ALL.get(usize::from(number));
        standing.copied().unwrap_or(Self::Unknown)
    }

    /// What the user is to do, if it is up to the user.
    #[must_use]
    pub fn words(self) -> Option<&'static str> {
        Some(match self {
            Self::Unknown | Self::Calibrated => return None,
            Self::Inkwell => "the device is not calibrated: put the stylus into the inkwell",
            Self::Marks => {
                "the device is not calibrated: move the stylus slowly through all of its reach"
            }
            Self::Reset => {
                "the device is not calibrated: put its arm into the reset position of its manual and press the stylus's first button"
            }
            Self::Foreign => {
                "the device is not calibrated: calibrate it by the vendor's setup program"
            }
        })
    }
}

/// Bit of the stylus's first button.
const BUTTON: i32 = 1;
/// Frames without force before an update.
const SETTLING: u32 = 2;

/// The calibration of a device.
#[derive(Debug)]
pub struct Calibration {
    style: Option<Style>,
    standing: Standing,
    /// Frames before the update that is to come.
    settling: Option<u32>,
    /// Whether the button was down: one that is held at opening says nothing.
    was_down: bool,
}

impl Calibration {
    /// By the best of the styles of a mask.
    #[must_use]
    pub fn new(mask: i32) -> Self {
        Self {
            style: Style::of(mask),
            standing: Standing::Unknown,
            settling: None,
            was_down: true,
        }
    }

    /// Looks at the state, where the session wants it, and does what can be done; within a frame that
    /// says these buttons.
    pub fn follow(&mut self, session: &Session, buttons: i32) {
        let is_down = buttons & BUTTON != 0;
        let was_down = std::mem::replace(&mut self.was_down, is_down);
        let is_pressed = is_down && !was_down;
        let is_due = session.takes_look();
        let is_new = match self.settling {
            Some(0) => {
                self.settling = None;
                self.update(session);
                true
            }
            Some(left) => {
                self.settling = Some(left - 1);
                return;
            }
            None if is_pressed && self.standing == Standing::Reset => {
                self.update(session);
                true
            }
            None => false,
        };
        if !is_new && !is_due {
            return;
        }
        let state = session.library.check_calibration();
        let updates = matches!(self.style, Some(Style::Auto | Style::Inkwell));
        if state == calibration::NEEDS_UPDATE && updates && !is_new {
            self.settling = Some(SETTLING);
        }
        self.standing = self.standing(state);
        session.stand(self.standing);
    }

    /// Updates it by its style; one that the library refuses is none.
    fn update(&mut self, session: &Session) {
        let Some(style) = self.style else { return };
        // What went wrong so far is not put down to it.
        session.trouble();
        session.library.update_calibration(style.bit());
        if !session.answers() {
            self.style = None;
        }
    }

    fn standing(&self, state: u32) -> Standing {
        match (state, self.style) {
            (calibration::OK, _) => Standing::Calibrated,
            (
                calibration::NEEDS_UPDATE | calibration::NEEDS_MANUAL_INPUT,
                Some(Style::EncoderReset),
            ) => Standing::Reset,
            (calibration::NEEDS_UPDATE, Some(_)) => Standing::Unknown,
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Inkwell)) => Standing::Inkwell,
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Auto)) => Standing::Marks,
            _ => Standing::Foreign,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_style_that_asks_least_is_taken() {
        let styles = [0, 1, 2, 3, 4, 5, 6, 7].map(Style::of);
        let (encoder, auto, inkwell) = (
            Some(Style::EncoderReset),
            Some(Style::Auto),
            Some(Style::Inkwell),
        );
        assert_eq!(
            styles,
            [None, encoder, auto, auto, inkwell, inkwell, auto, auto]
        );
    }

    #[test]
    fn standings_have_numbers() {
        for standing in Standing::ALL {
            assert_eq!(Standing::numbered(standing as u8), standing);
        }
        assert_eq!(Standing::numbered(99), Standing::Unknown);
    }
}
