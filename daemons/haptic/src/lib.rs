//! The haptic daemon.
//!
//! A real-time thread runs the servo beside the device, a thousand times a second. It touches no
//! bus, no lock and no allocator: contact models and forces of paint come in through triple buffers, tick
//! records go out through a ring, and another thread talks to the rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`servo`] | servo loop, real-time thread, clock, channels to the daemon, force control |
//! | [`device`] | driver interface, mounting on the desk, opening, probing, velocity estimation |
//! | [`drivers`] | simulated device, OpenHaptics (Phantom), Force Dimension, Polhem and WoodenHaptics, Inverse3, OpenXR |
//! | [`daemon`] | thread that talks to the rig |
//! | [`force_state_file`] | force settings and latched fault that survive a daemon restart |
//!
//! The simulated device in the servo's place of a real one: read, step, write, a thousand times.
//!
//! ```
//! use glam::DVec3;
//! use maulstick_device::registration::Registration;
//! use maulstick_haptic::drivers::simulated::Simulated;
//! use maulstick_haptic::{Driver as _, MountedDevice};
//! use maulstick_haptics::{Contact, Sender, Servo};
//! use maulstick_types::haptics::{ContactModel, ForceLaw};
//!
//! const TICK_S: f64 = 1e-3;
//! let device = Box::new(Simulated::at_rest());
//! let limits = device.abilities().limits(2.0);
//! let mut device = MountedDevice::new(device, Registration::IDENTITY, 0);
//! let mut servo = Servo::new(limits);
//! // A brush of 25 mm whose canvas the resting hand does not reach.
//! let law = ForceLaw::Linear { k1_n: 0.8, k2_n: 6.0 };
//! let model = Contact::new(&ContactModel::bare(law, 0.025)).expect("finite numbers");
//! for tick in 0..1000 {
//!     if tick % 15 == 0 {
//!         servo.receive(model, Sender::Same);
//!     }
//!     let reading = device.read(TICK_S).expect("it is never lost").expect("news at each tick");
//!     let (force, report) = servo.step(&reading.handle, TICK_S);
//!     device.write(force, report.torque_n_m).expect("it is never lost");
//!     assert!(force == DVec3::ZERO && !report.contact && report.fault.is_none());
//! }
//! ```
//!
//! # Rules
//!
//! - Drivers know only their own frame, in metres: x right, y up, z toward the user. Pose, scale, lever to the ferrule
//!   and clutch are applied once for all drivers by the mounted device.
//! - A tick reads, steps, writes, reports, on the system's clock or a vendor library's scheduler. A driver without news
//!   lets the tick pass; a lost one ends the servo with a reason, the brush is lifted, and the daemon looks for the
//!   device each second. A device is dropped without force: at the end, by a signal, by a panic of the servo.
//! - One sender moves the hand: the session of the brush that consumes the device's samples, or one with consent, by
//!   `driven_by` or by a request that is renewed. Others are refused, counted and logged.
//! - Force orders are queries to the daemon, so nothing else has to run for them; settings and latched faults survive a
//!   daemon restart for the run of the rig. With a fault the amplifiers are off.
//! - Vendor libraries are loaded at run time, so the build does not depend on them; their own limits of speed and of
//!   change of force are kept. Every driver is tested through a fake at its lowest seam. OpenXR controllers are force
//!   devices whose motors vibrate; the trigger moves the ferrule forward.
//! - Where permitted the servo keeps the processor awake (`/dev/cpu_dma_latency`): it then wakes 23 µs late in the
//!   median, otherwise 37.

pub mod daemon;
pub mod device;
pub mod drivers;
pub mod force_state_file;
mod inlet;
mod senders;
pub mod servo;

pub use device::driver::Driver;
pub use device::mounted_device::MountedDevice;
