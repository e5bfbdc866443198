//! Report of a device that is not there.

use maulstick_rig::UserError;
use maulstick_types::stylus::StylusStatus;

/// A status has no room for more, bytes.
const LONGEST: usize = 2048;

/// Reports why the device `name` is missing, once in the log and in the status while it lasts.
pub fn report_missing(name: &str, fault: &UserError, told: &mut StylusStatus) {
    let place = fault.place.as_ref().map(|place| format!(" ({place})"));
    let mut trouble = format!("{}{}", fault.what, place.unwrap_or_default());
    if let Some(help) = &fault.help {
        trouble = format!("{trouble}; {help}");
    }
    trouble.truncate(trouble.floor_char_boundary(LONGEST));
    if trouble != told.trouble {
        tracing::warn!("{name}: {trouble} (tried again each second)");
        told.trouble = trouble;
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
        assert_eq!(told.trouble, "no pen (/dev/hidraw0); plug it in");
        report_missing("tablet", &UserError::failure("ä".repeat(5000)), &mut told);
        assert_eq!(told.trouble.len(), LONGEST);
    }
}
