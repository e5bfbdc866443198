//! Tests of whole paintings, by subject.

mod books;
mod drying;
mod extremes;
mod hairline;
mod light;
mod models;
mod modes;
mod pauses;
mod picking;
mod sequencer;
mod studio;
mod threads;
