//! The servo: its loop over a device, the real-time thread that runs it, and its channels to the daemon.

pub mod channels;
pub mod clock;
pub mod force_control;
pub mod servo_loop;
pub mod servo_thread;
