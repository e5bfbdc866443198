//! How a Phantom learns where it is.
//!
//! Of the styles that a model has, the one that asks least of the user is taken: it finds its marks by
//! itself, or the stylus is put into the inkwell, or its encoders are set to zero as the arm stands,
//! which has to be done before the scheduler starts. While it does not know where it is, it is out of
//! range and gives no force.

use super::abi::{calibration, style};
use super::session::{Calibrated, Session};
use crate::driver::Trouble;

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

/// The encoders can be set to zero only as the device is opened.
const LOST_ZERO: Trouble = Trouble {
    what: "the encoders of the haptic device have lost their zero",
    code: 0,
    help: "hold its arm in the reset position of its manual: it is opened again and set to zero there",
};

/// What the user is told.
pub type Words = &'static str;

/// The calibration of a device.
#[derive(Debug)]
pub struct Calibration {
    style: Option<Style>,
    told: Option<Words>,
}

impl Calibration {
    /// By the best of the styles of a mask.
    #[must_use]
    pub fn new(mask: i32) -> Self {
        Self {
            style: Style::of(mask),
            told: None,
        }
    }

    /// What is to be done before the scheduler starts.
    ///
    /// # Errors
    /// [`Trouble`] where the encoders cannot be set to zero.
    pub fn before_start(&self, session: &Session) -> Result<(), Trouble> {
        let library = session.library;
        let mut state = library.check_calibration();
        if state != calibration::OK
            && let Some(style @ Style::EncoderReset) = self.style
        {
            library.update_calibration(style.bit());
            state = library.check_calibration();
            if state != calibration::OK {
                return Err(session.trouble().unwrap_or(LOST_ZERO));
            }
        }
        session.set_calibrated(match state {
            calibration::OK => Calibrated::Yes,
            _ => Calibrated::No,
        });
        session.trouble().map_or(Ok(()), Err)
    }

    /// Looks at the state, and does what can be done; `settle` waits until no frame is on its way that
    /// has not seen that the device does not know where it is. Returns what to tell the user.
    ///
    /// # Errors
    /// [`Trouble`] where the device has to be opened anew.
    pub fn look(
        &mut self,
        session: &Session,
        settle: impl FnOnce(),
    ) -> Result<Option<Words>, Trouble> {
        let library = session.library;
        let mut state = library.check_calibration();
        if state != calibration::OK {
            session.set_calibrated(Calibrated::No);
        }
        if state == calibration::NEEDS_UPDATE {
            match self.style {
                Some(Style::EncoderReset) => return Err(LOST_ZERO),
                Some(style) => {
                    settle();
                    library.update_calibration(style.bit());
                    state = library.check_calibration();
                }
                None => {}
            }
        }
        if let Some(trouble) = session.trouble() {
            return Err(trouble);
        }
        if state == calibration::OK {
            session.set_calibrated(Calibrated::Yes);
            return Ok(self.told.take().map(|_| "the device is calibrated"));
        }
        let words = self.words(state);
        let is_new = self.told != words;
        self.told = words.or(self.told);
        Ok(words.filter(|_| is_new))
    }

    /// What the user is to do, if it is up to the user.
    fn words(&self, state: u32) -> Option<Words> {
        match (state, self.style) {
            // The next look does it.
            (calibration::NEEDS_UPDATE, Some(_)) => None,
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Inkwell)) => {
                Some("the device is not calibrated: put the stylus into the inkwell")
            }
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::Auto)) => Some(
                "the device is not calibrated: move the stylus slowly through all of its reach",
            ),
            (calibration::NEEDS_MANUAL_INPUT, Some(Style::EncoderReset)) => Some(
                "the device is not calibrated: hold its arm in the reset position of its manual and start anew",
            ),
            _ => Some("the device is not calibrated: calibrate it by the vendor's setup program"),
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
