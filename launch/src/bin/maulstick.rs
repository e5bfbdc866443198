//! The command.

fn main() {
    maulstick::finish(maulstick::cli::run());
}
