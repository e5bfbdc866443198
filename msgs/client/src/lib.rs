//! Client of a running rig, for windows, commands and tests.
//!
//! | module | content |
//! | --- | --- |
//! | [`connection`] | a connection to a rig by its name: a command, a question, a topic |
//! | [`state`], [`listener`] | the rig as its messages describe it, and the subscribers that fill it |
//! | [`force_history`], [`sample_history`] | the last seconds of each device |
//! | [`request`], [`dispatcher`] | requests, and a queue and a thread for each process |
//! | [`stroke_barrier`], [`pending_orders`] | place of a request among the strokes |
//! | [`frames`] | pictures of the surfaces, pulled tile by tile |
//! | [`thumbnails`] | small pictures of versions and steps |
//!
//! A front end drains the [listener](listener::RigListener) into a [`LiveRig`](state::LiveRig), draws that, and hands
//! its requests to the [barrier](stroke_barrier::StrokeBarrier), which gives those that are ready to the
//! [dispatcher](dispatcher::CommandDispatcher). Nothing here waits for an answer.
//!
//! ```
//! use maulstick_bus::typed::Sender;
//! use maulstick_bus::{Faults, MemoryNet, Qos, Wake};
//! use maulstick_client::listener::RigListener;
//! use maulstick_client::state::LiveRig;
//! use maulstick_types::stylus::StylusSample;
//! use maulstick_types::wire::topics::Topics;
//! use maulstick_types::{Origin, name_hash};
//!
//! let net = MemoryNet::new(1, 0, Faults::default());
//! let (bus, topics) = (net.bus(), Topics::new("studio"));
//! let mut listener = RigListener::new(&bus, &topics, &Wake::new())?;
//! let me = Origin { source: name_hash("pen"), epoch: 1 };
//! let mut pen = Sender::new(&bus, &topics.sample("pen"), Qos::RealTime, me)?;
//! pen.send(0, 0, &StylusSample::away())?;
//! net.advance(10_000_000);
//!
//! let mut rig = LiveRig::new("studio");
//! listener.drain(10_000_000, &mut rig);
//! assert!(rig.devices.contains_key("pen"));
//! # Ok::<(), maulstick_bus::BusError>(())
//! ```

pub mod connection;
pub mod dispatcher;
pub mod force_history;
pub mod frames;
pub mod listener;
pub mod pending_orders;
pub mod request;
pub mod sample_history;
pub mod state;
pub mod stroke_barrier;
pub mod thumbnails;
