//! A script at work.

pub mod duration;
pub mod easel;
