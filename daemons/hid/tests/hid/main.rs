//! Pens and 6-DOF mice without any: descriptors that have the layouts of real ones, reports packed by them,
//! recordings of them, and devices that are made up below decoding; event devices as files.

#![allow(clippy::panic, reason = "a test that meets what cannot be fails")]

mod daemon;
mod decoding;
mod descriptors;
mod evdev;
mod evemu;
mod live;
mod means;
mod ports;
mod probe;
mod proximity;
mod recordings;
mod spacemice;
mod support;
mod tablets;
