//! The command `maulstick`.

fn main() {
    maulstick::panics::tell();
    maulstick::finish(maulstick::cli::run());
}
