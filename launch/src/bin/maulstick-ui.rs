//! The window of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::ui());
}
