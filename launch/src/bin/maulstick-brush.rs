//! The brush process of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::brush());
}
