//! What of this machine keeps a rig from painting well, and the command that mends it.
//!
//! | module | holds |
//! | --- | --- |
//! | `facts` | what the machine is |
//! | `judge` | what is right and wrong with it |
//!
//! A thread tries a real-time priority, which it would keep; the crate starts no other.

mod facts;
mod judge;
#[cfg(test)]
mod tests;

pub use judge::{Finding, State};

use self::facts::Facts;

/// Findings about this machine.
#[must_use]
pub fn findings() -> Vec<Finding> {
    judge::judge(&Facts::of_this_machine())
}

/// A line for each finding, and below it the command that mends it.
#[must_use]
pub fn in_words(findings: &[Finding]) -> String {
    let mut text = String::new();
    for finding in findings {
        let state = match finding.state {
            State::Ok => "ok",
            State::Warning => "warning",
            State::Wrong => "wrong",
        };
        let what = maulstick_types::plain(&finding.what);
        text += &format!("{state:<9}{:<15}{what}\n", finding.check);
        if let Some(mend) = &finding.mend {
            text += &format!("{:24}mend: {}\n", "", maulstick_types::plain(mend));
        }
    }
    text
}
