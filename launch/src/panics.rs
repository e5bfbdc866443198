//! Panics, as a user sees them: one clear error, without paths of the machine that built this program.

use std::io::Write as _;
use std::panic::PanicHookInfo;

use maulstick_bus::reason::{place, reason};
use maulstick_rig::log::words;
use maulstick_types::plain;

/// Reports panics of this process as errors. With a requested backtrace Rust's own message appears.
pub fn tell() {
    if std::env::var_os("RUST_BACKTRACE").is_none_or(|asked| asked == "0") {
        std::panic::set_hook(Box::new(|info| {
            // A terminal that is gone is no second panic.
            writeln!(std::io::stderr(), "{}", in_words(info)).ok();
        }));
    }
}

fn in_words(info: &PanicHookInfo<'_>) -> String {
    let thread = std::thread::current();
    let at = info.location().map_or_else(String::new, |at| {
        format!("\n  --> {}:{}", place(at.file()), at.line())
    });
    format!(
        "error: internal error: thread '{}' panicked: {}{at}\n help: report it, with what you did before",
        thread.name().unwrap_or("without a name"),
        plain(&reason(words(info.payload()))),
    )
}
