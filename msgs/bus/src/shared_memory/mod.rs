//! Shared memory: frames are encoded into a pool and read in place.

pub(crate) mod payload;
pub(crate) mod pool;
