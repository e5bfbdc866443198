//! Report of a device that is not there.

use maulstick_rig::UserError;
use maulstick_types::stylus::{StylusStatus, Trouble};

/// Reports why the device `name` is missing, once in the log and in the status while it lasts.
pub fn report_missing(name: &str, fault: &UserError, told: &mut StylusStatus) {
    let place = fault.place.as_ref().map(|place| format!(" ({place})"));
    let trouble = Trouble {
        what: &format!("{}{}", fault.what, place.unwrap_or_default()),
        help: fault.help.as_deref().unwrap_or_default(),
    };
    if told.report(trouble) {
        tracing::warn!("{name}: {trouble} (tried again each second)");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_where_and_what_to_do_are_told_and_fit() {
        let mut told = StylusStatus::fresh(0);
        let fault = UserError::failure("no pen")
            .at("/dev/hidraw0")
            .help("plug it in");
        report_missing("tablet", &fault, &mut told);
        let trouble = Trouble {
            what: "no pen (/dev/hidraw0)",
            help: "plug it in",
        };
        assert_eq!(told.trouble(), Some(trouble));
        let long = UserError::failure("ä".repeat(5000)).help("ü".repeat(5000));
        report_missing("tablet", &long, &mut told);
        assert!(maulstick_types::encoded_bytes(&told).is_ok());
    }
}
