//! What holds of a device's force though its daemon died: orders and a latched fault, in a file of the
//! rig's folder. It holds for one run of the rig; the next begins with force on.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use maulstick_haptics::{Fault, Switch};
use maulstick_rig::files::{Kind, write_whole};

/// What holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orders {
    /// Whether there is force.
    pub switch: Switch,
    /// Share of what the models ask for, 0 to 1.
    pub strength: f64,
    /// The fault that is latched.
    pub fault: Option<Fault>,
}

impl Orders {
    /// Those of a rig in which nothing was ordered.
    pub const NONE: Self = Self {
        switch: Switch::On,
        strength: 1.0,
        fault: None,
    };
    /// Those of a file that cannot be understood: no force until somebody wants it.
    const UNKNOWN: Self = Self {
        switch: Switch::Off,
        ..Self::NONE
    };
}

const FAULTS: [(&str, Fault); 3] = [
    ("not-a-number", Fault::NotANumber),
    ("too-fast", Fault::TooFast),
    ("shaking", Fault::Shaking),
];

/// The file of a device.
#[derive(Clone, Debug)]
pub struct Standing {
    path: PathBuf,
    /// What no other run of the rig has.
    run: u64,
}

impl Standing {
    /// The file of `device` in a rig's folder.
    #[must_use]
    pub fn of(folder: &Path, device: &str, run: u64) -> Self {
        Self {
            path: folder.join(format!("{device}.force")),
            run,
        }
    }

    /// What holds now.
    #[must_use]
    pub fn recall(&self) -> Orders {
        match std::fs::read_to_string(&self.path) {
            Ok(text) => self.parse(&text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Orders::NONE,
            Err(_) => Orders::UNKNOWN,
        }
    }

    fn parse(&self, text: &str) -> Orders {
        let words: Vec<&str> = text.split_whitespace().collect();
        let [run, switch, strength, fault] = words[..] else {
            return Orders::UNKNOWN;
        };
        if run.parse() != Ok(self.run) {
            return Orders::NONE;
        }
        let share = strength.parse().ok();
        match (switch, share.filter(|share| (0.0..=1.0).contains(share))) {
            ("on" | "off", Some(strength)) => Orders {
                switch: if switch == "on" {
                    Switch::On
                } else {
                    Switch::Off
                },
                strength,
                fault: FAULTS
                    .iter()
                    .find(|(word, _)| *word == fault)
                    .map(|(_, f)| *f),
            },
            _ => Orders::UNKNOWN,
        }
    }

    /// Keeps what holds.
    ///
    /// # Errors
    /// What the system says where it cannot be written.
    pub fn keep(&self, orders: &Orders) -> std::io::Result<()> {
        let switch = match orders.switch {
            Switch::On => "on",
            Switch::Off => "off",
        };
        let fault = FAULTS
            .iter()
            .find(|(_, fault)| Some(*fault) == orders.fault);
        let fault = fault.map_or("none", |(word, _)| word);
        let (run, strength) = (self.run, orders.strength);
        write_whole(&self.path, Kind::Own, |file| {
            writeln!(file, "{run} {switch} {strength} {fault}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_ordered_holds_in_this_run_of_the_rig_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let standing = Standing::of(folder.path(), "phantom", 7);
        assert_eq!(standing.recall(), Orders::NONE);
        for fault in [
            None,
            Some(Fault::TooFast),
            Some(Fault::Shaking),
            Some(Fault::NotANumber),
        ] {
            let orders = Orders {
                switch: Switch::Off,
                strength: 0.3,
                fault,
            };
            standing.keep(&orders).expect("kept");
            assert_eq!(standing.recall(), orders);
        }
        assert_eq!(
            Standing::of(folder.path(), "phantom", 8).recall(),
            Orders::NONE
        );
        assert_eq!(
            Standing::of(folder.path(), "other", 7).recall(),
            Orders::NONE
        );
    }

    #[test]
    fn a_file_that_cannot_be_understood_means_no_force() {
        let folder = tempfile::tempdir().expect("a folder");
        let standing = Standing::of(folder.path(), "phantom", 7);
        for text in [
            "",
            "7 on",
            "7 on 2.0 none",
            "7 maybe 1 none",
            "7 on NaN none",
        ] {
            std::fs::write(&standing.path, text).expect("written");
            assert_eq!(standing.recall().switch, Switch::Off, "{text}");
        }
    }
}
