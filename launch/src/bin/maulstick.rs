//! The command.

fn main() {
    maulstick::panics::tell();
    maulstick::finish(maulstick::cli::run());
}
