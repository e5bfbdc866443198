//! The player process of a rig.

fn main() {
    maulstick::finish(maulstick::nodes::player());
}
