//! Calibration state of a device, as the session publishes it.

/// Calibration of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibrationState {
    /// Not known yet, or about to be updated.
    Unknown,
    /// Calibrated.
    Calibrated,
    /// Waiting for the stylus in the inkwell.
    Inkwell,
    /// Waiting until the device has found its marks.
    Marks,
    /// Waiting for the button, with the arm in its reset position.
    Reset,
    /// Beyond the styles that are supported here.
    Foreign,
}

impl CalibrationState {
    const ALL: [Self; 6] = [
        Self::Unknown,
        Self::Calibrated,
        Self::Inkwell,
        Self::Marks,
        Self::Reset,
        Self::Foreign,
    ];

    /// The state with the number that `as u8` gives.
    #[must_use]
    pub fn numbered(number: u8) -> Self {
        let state = Self::ALL.get(usize::from(number));
        state.copied().unwrap_or(Self::Unknown)
    }

    /// Instruction to the user, if there is something to do.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_have_numbers() {
        for state in CalibrationState::ALL {
            assert_eq!(CalibrationState::numbered(state as u8), state);
        }
        assert_eq!(CalibrationState::numbered(99), CalibrationState::Unknown);
    }
}
