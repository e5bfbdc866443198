//! The haptic process of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::haptic());
}
