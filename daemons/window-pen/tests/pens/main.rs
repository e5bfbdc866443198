//! Pens of a window: a compositor of our own, events of an X server at the connection's seam, and the pen on the desk.

#![allow(clippy::tests_outside_test_module, reason = "a test crate")]

mod compositor;
mod desk;
mod on_the_desk;
mod wayland;
mod xinput;
