//! Calibration of a Phantom.
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
use super::calibration_state::CalibrationState;
use super::session::Session;

/// Calibration style of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// The device finds its marks by itself.
    Auto,
    /// The stylus is put into the inkwell.
    Inkwell,
    /// The encoders are set to zero as the arm stands.
    EncoderReset,
}

impl Style {
    /// The style of a mask that asks least of the user.
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

/// Bit of the stylus's first button.
const BUTTON: i32 = 1;
/// Frames without force before an update.
const SETTLING: u32 = 2;

/// The calibration of a device.
#[derive(Debug)]
pub struct Calibration {
    style: Option<Style>,
    state: CalibrationState,
    /// Frames left before the update.
    settling: Option<u32>,
    /// Button state of the last frame; a button that is held at opening does not count as pressed.
    was_down: bool,
}

impl Calibration {
    /// A calibration by the best of the styles of a mask.
    #[must_use]
    pub fn new(mask: i32) -> Self {
        Self {
            style: Style::of(mask),
            state: CalibrationState::Unknown,
            settling: None,
            was_down: true,
        }
    }

    /// Checks the calibration when the session asks for it, and updates it if possible; within a frame in
    /// which `buttons` are pressed.
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
            None if is_pressed && self.state == CalibrationState::Reset => {
                self.update(session);
                true
            }
            None => false,
        };
        if !is_new && !is_due {
            return;
        }
        let answer = session.library.check_calibration();
        let updates = matches!(self.style, Some(Style::Auto | Style::Inkwell));
        if answer == calibration::NEEDS_UPDATE && updates && !is_new {
            self.settling = Some(SETTLING);
        }
        self.state = self.state_of(answer);
        session.set_calibration(self.state);
    }

    /// Updates the calibration by its style; a style that the library refuses is dropped.
    fn update(&mut self, session: &Session) {
        let Some(style) = self.style else { return };
        // Earlier errors are not put down to the update.
        session.take_error();
        session.library.update_calibration(style.bit());
        if !session.answers() {
            self.style = None;
        }
    }

    fn state_of(&self, answer: u32) -> CalibrationState {
        match (answer, self.style) {
            (calibration::OK, _) => CalibrationState::Calibrated,
            (
                calibration::NEEDS_UPDATE | calibration::NEEDS_MANUAL_INPUT,
                Some(Style::EncoderReset),
            ) => CalibrationState::Reset,
            (calibration::NEEDS_UPDATE, Some(_)) => CalibrationState::Unknown,
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Inkwell)) => CalibrationState::Inkwell,
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Auto)) => CalibrationState::Marks,
            _ => CalibrationState::Foreign,
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
}
