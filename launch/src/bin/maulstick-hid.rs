//! A pen or a 6-DOF mouse of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::hid());
}
