//! The paint process of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::paint());
}
