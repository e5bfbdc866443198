//! The painter's force settings and the latched fault; both outlive the daemon.

use maulstick_haptics::{Fault, Switch};
use maulstick_types::haptics::ForceOrder;
use maulstick_types::stylus::StylusStatus;

use crate::force_state_file::{ForceState, ForceStateFile};
use crate::servo::force_control::ForceControl;

/// Force settings of a device.
pub(super) struct ForceSettings {
    file: ForceStateFile,
    control: ForceControl,
    fault: Option<Fault>,
}

impl ForceSettings {
    /// The settings of a state file, and the fault that it says is to be latched.
    pub(super) fn read(file: ForceStateFile) -> (Self, Option<Fault>) {
        let state = file.read();
        let control = ForceControl {
            switch: state.switch,
            strength: state.strength,
            guidance: state.guidance,
            ..ForceControl::default()
        };
        let settings = Self {
            file,
            control,
            fault: None,
        };
        (settings, state.fault)
    }

    /// The settings, as the servo takes them.
    pub(super) fn control(&self) -> ForceControl {
        self.control
    }

    /// The latched fault.
    pub(super) fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// True while force is on.
    pub(super) fn is_on(&self) -> bool {
        self.control.switch == Switch::On
    }

    /// Reports the settings in a status.
    pub(super) fn report(&self, status: &mut StylusStatus) {
        status.is_on = self.is_on();
        (status.strength, status.guidance) = (self.control.strength, self.control.guidance);
    }

    /// Latches the fault of a servo that was re-armed so often, unless one is latched or the force was re-armed since;
    /// true if it did.
    pub(super) fn latch(&mut self, fault: Fault, rearms: u64) -> bool {
        if self.fault.is_some() || rearms != self.control.rearms {
            return false;
        }
        self.fault = Some(fault);
        self.write();
        true
    }

    /// Carries out an order about the settings; true if that changes them.
    pub(super) fn obey(&mut self, order: &ForceOrder) -> bool {
        let control = &mut self.control;
        match *order {
            ForceOrder::Off => std::mem::replace(&mut control.switch, Switch::Off) != Switch::Off,
            ForceOrder::On => std::mem::replace(&mut control.switch, Switch::On) != Switch::On,
            ForceOrder::Strength { share } => {
                let share = share_of(share);
                std::mem::replace(&mut control.strength, share) != share
            }
            ForceOrder::Guidance { share } => {
                let share = share_of(share);
                std::mem::replace(&mut control.guidance, share) != share
            }
            ForceOrder::Rearm => {
                control.rearms += 1;
                self.fault = None;
                true
            }
            ForceOrder::Drive { .. } => false,
        }
    }

    /// Writes settings and fault to the state file.
    pub(super) fn write(&self) {
        let state = ForceState {
            switch: self.control.switch,
            strength: self.control.strength,
            guidance: self.control.guidance,
            fault: self.fault,
        };
        if let Err(error) = self.file.write(&state) {
            tracing::warn!("orders do not outlive this daemon: {error}");
        }
    }
}

/// A share from 0 to 1; NaN counts as 0.
pub(super) fn share_of(share: f64) -> f64 {
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_stays_latched_until_it_is_rearmed_and_one_from_before_that_is_ignored() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = ForceStateFile::of(folder.path(), "phantom", 7);
        let (mut settings, latched) = ForceSettings::read(file.clone());
        assert_eq!(latched, None);
        assert!(settings.latch(Fault::TooFast, 0));
        assert!(!settings.latch(Fault::Oscillation, 0), "one is latched");
        assert_eq!(file.read().fault, Some(Fault::TooFast));
        assert!(settings.obey(&ForceOrder::Rearm));
        assert_eq!(settings.fault(), None);
        assert!(!settings.latch(Fault::TooFast, 0), "of before");
        assert!(settings.latch(Fault::NotANumber, 1));
    }

    #[test]
    fn shares_are_bounded_and_say_whether_they_are_new() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = ForceStateFile::of(folder.path(), "phantom", 7);
        let (mut settings, _) = ForceSettings::read(file);
        for (asked, given, is_new) in [(2.0, 1.0, false), (0.5, 0.5, true), (f64::NAN, 0.0, true)] {
            let order = ForceOrder::Strength { share: asked };
            assert_eq!(settings.obey(&order), is_new, "{asked}");
            assert_eq!(settings.control().strength, given);
        }
    }
}
