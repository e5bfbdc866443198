//! Pens and 6-DOF mice over HID.
