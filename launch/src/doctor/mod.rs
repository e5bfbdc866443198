//! `maulstick doctor`: obstacles to good painting on this machine, each with a remedy.
//!
//! | module | holds |
//! | --- | --- |
//! | [`facts`] | facts about the machine |
//! | [`judge`] | verdicts about it |

mod facts;
mod judge;

use clap::Args;
use maulstick_rig::UserError;
use serde_json::json;

use self::facts::Facts;
use self::judge::{Finding, State, judge};
use crate::commands::{print_json, print_text};

/// Options of `maulstick doctor`.
#[derive(Args, Clone, Debug)]
pub struct DoctorOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Prints the findings; the exit code is 1 where something is wrong.
///
/// # Errors A [`UserError`] where it cannot be printed.
pub fn run(options: &DoctorOptions) -> Result<i32, UserError> {
    let findings = judge(&Facts::of_this_machine());
    if options.json {
        print_json(&json!(findings))?
    } else {
        print_text(&in_words(&findings))?
    }
    let is_wrong = findings.iter().any(|finding| finding.state == State::Wrong);
    Ok(i32::from(is_wrong))
}

/// A line for each finding, and below it the command that mends it.
fn in_words(findings: &[Finding]) -> String {
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

#[cfg(test)]
mod tests;
