//! Force settings and latched faults that survive a daemon restart, in a file of the rig's folder.
//! They hold for one run of the rig; the next begins with force on.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use maulstick_haptics::{Fault, Switch};
use maulstick_rig::files::{Kind, write_whole};

/// State of a device's force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceState {
    /// Force on or off.
    pub switch: Switch,
    /// Share of the models' force that is given, 0 to 1.
    pub strength: f64,
    /// Share of the guides' force that is given, 0 to 1.
    pub guidance: f64,
    /// Latched fault.
    pub fault: Option<Fault>,
}

impl ForceState {
    /// The state at the start of a rig.
    pub const INITIAL: Self = Self {
        switch: Switch::On,
        strength: 1.0,
        guidance: 1.0,
        fault: None,
    };
    /// The state in place of an unreadable file: no force until somebody switches it on and re-arms it.
    const UNKNOWN: Self = Self {
        switch: Switch::Off,
        strength: 1.0,
        guidance: 1.0,
        fault: Some(Fault::UnknownState),
    };
}

/// The word in place of a fault.
const NO_FAULT: &str = "none";
/// The word of each fault.
const FAULTS: [(&str, Fault); 4] = [
    ("not-a-number", Fault::NotANumber),
    ("too-fast", Fault::TooFast),
    ("shaking", Fault::Oscillation),
    ("unknown-state", Fault::UnknownState),
];

/// The state file of a device.
#[derive(Clone, Debug)]
pub struct ForceStateFile {
    path: PathBuf,
    /// Number of the rig's run.
    run: u64,
}

impl ForceStateFile {
    /// The file of `device` in a rig's folder.
    #[must_use]
    pub fn of(folder: &Path, device: &str, run: u64) -> Self {
        Self {
            path: folder.join(format!("{device}.force")),
            run,
        }
    }

    /// Reads the state.
    #[must_use]
    pub fn read(&self) -> ForceState {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => self.parse(&text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => ForceState::INITIAL,
            Err(_) => ForceState::UNKNOWN,
        }
    }

    fn parse(&self, text: &str) -> ForceState {
        let words: Vec<&str> = text.split_whitespace().collect();
        let [run, switch, strength, guidance, fault] = words[..] else {
            return ForceState::UNKNOWN;
        };
        match run.parse::<u64>() {
            Ok(run) if run == self.run => {}
            Ok(_) => return ForceState::INITIAL,
            Err(_) => return ForceState::UNKNOWN,
        }
        let fault = match fault {
            NO_FAULT => None,
            word => match FAULTS.iter().find(|(known, _)| *known == word) {
                Some((_, fault)) => Some(*fault),
                None => return ForceState::UNKNOWN,
            },
        };
        let share = |word: &str| {
            let share = word.parse().ok();
            share.filter(|share| (0.0..=1.0).contains(share))
        };
        match (switch, share(strength), share(guidance)) {
            ("on" | "off", Some(strength), Some(guidance)) => ForceState {
                switch: if switch == "on" {
                    Switch::On
                } else {
                    Switch::Off
                },
                strength,
                guidance,
                fault,
            },
            _ => ForceState::UNKNOWN,
        }
    }

    /// Writes the state.
    ///
    /// # Errors
    /// The system's, if the file cannot be written.
    pub fn write(&self, state: &ForceState) -> std::io::Result<()> {
        let switch = match state.switch {
            Switch::On => "on",
            Switch::Off => "off",
        };
        let fault = FAULTS.iter().find(|(_, fault)| Some(*fault) == state.fault);
        let fault = fault.map_or(NO_FAULT, |(word, _)| word);
        let (run, strength, guidance) = (self.run, state.strength, state.guidance);
        write_whole(&self.path, Kind::Own, |file| {
            writeln!(file, "{run} {switch} {strength} {guidance} {fault}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_holds_in_its_run_of_the_rig_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = ForceStateFile::of(folder.path(), "phantom", 7);
        assert_eq!(file.read(), ForceState::INITIAL);
        for fault in [
            None,
            Some(Fault::TooFast),
            Some(Fault::Oscillation),
            Some(Fault::NotANumber),
            Some(Fault::UnknownState),
        ] {
            let state = ForceState {
                switch: Switch::Off,
                strength: 0.3,
                guidance: 0.7,
                fault,
            };
            file.write(&state).expect("written");
            assert_eq!(file.read(), state);
        }
        for (device, run) in [("phantom", 8), ("other", 7)] {
            let other = ForceStateFile::of(folder.path(), device, run);
            assert_eq!(other.read(), ForceState::INITIAL);
        }
    }

    #[test]
    fn an_unreadable_file_means_force_off_and_a_fault_that_says_so() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = ForceStateFile::of(folder.path(), "phantom", 7);
        for text in [
            "",
            "7 on",
            "7 on 1 none",
            "7 on 2.0 1 none",
            "7 on 1 2.0 none",
            "7 maybe 1 1 none",
            "7 on NaN 1 none",
            "7 on 1 NaN none",
            "7 on 1 1 none none",
            "7 on 1 1 too-hot",
            "7 on 1 1 shakin",
            "x7 on 1 1 none",
        ] {
            std::fs::write(&file.path, text).expect("written");
            let state = file.read();
            assert_eq!(state.switch, Switch::Off, "{text}");
            assert_eq!(state.fault, Some(Fault::UnknownState), "{text}");
        }
    }
}
