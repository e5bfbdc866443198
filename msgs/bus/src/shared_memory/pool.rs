//! The pool of shared memory that large answers are written into.
//!
//! zenoh holds its pools in memory that may not be swapped out, and takes that a table can be had
//! beside them for granted, so both are tried before anything is promised.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use zenoh::Wait as _;
use zenoh::shm::{PosixShmProviderBackend, ShmProvider, ShmProviderBuilder, ZShmMut};

use crate::reason::reason;

/// Sizes to try, bytes: a large frame and some small ones; what fits into the 8 MiB that a user may lock
/// by default.
const SIZES: [usize; 2] = [16 << 20, 4 << 20];
/// Room for zenoh's own tables, bytes.
const TABLES: usize = 3 << 20;
/// Overhead of a pool, bytes.
const SLACK: usize = 64 << 10;
/// A pool that has had no room for this long lost what it lent to a process that has died.
const CLOGGED: Duration = Duration::from_secs(2);

type Provider = ShmProvider<PosixShmProviderBackend>;

/// Memory for answers.
#[derive(Debug)]
pub(crate) struct Pool {
    sizes: Vec<usize>,
    state: Mutex<State>,
}

impl Default for Pool {
    fn default() -> Self {
        Self {
            sizes: SIZES.to_vec(),
            state: Mutex::default(),
        }
    }
}

#[derive(Debug, Default)]
enum State {
    #[default]
    Untried,
    Ready {
        provider: Provider,
        bytes: usize,
        full_since: Option<Instant>,
    },
    Refused,
}

/// Removes what processes that were killed left in `/dev/shm`.
pub fn clear_shared_memory() {
    zenoh::shm::cleanup_orphaned_shm_segments();
}

fn made(bytes: usize) -> zenoh::Result<Provider> {
    drop(ShmProviderBuilder::default_backend(bytes + TABLES).wait()?);
    ShmProviderBuilder::default_backend(bytes).wait()
}

fn open(sizes: &[usize]) -> State {
    let mut refusal = String::new();
    for &bytes in sizes {
        match made(bytes) {
            Ok(provider) => {
                tracing::debug!("frames share {} MiB of memory", bytes >> 20);
                return State::Ready {
                    provider,
                    bytes,
                    full_since: None,
                };
            }
            Err(error) => refusal = reason(error),
        }
        // zenoh leaves a segment behind that it could not lock.
        clear_shared_memory();
    }
    tracing::info!(
        "pictures go to the window through its socket, which takes longer: no memory can be shared \
         ({refusal}); `ulimit -l` of 8192 and 8 MB free in /dev/shm are enough"
    );
    State::Refused
}

impl Pool {
    /// A pool of `bytes`.
    pub(crate) fn of(bytes: usize) -> Self {
        Self {
            sizes: vec![bytes],
            state: Mutex::default(),
        }
    }

    /// A piece of `length` bytes; `None` without room or without a pool.
    pub(crate) fn room(&self, length: usize) -> Option<ZShmMut> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if matches!(*state, State::Untried) {
            *state = open(&self.sizes);
        }
        let State::Ready {
            provider,
            bytes,
            full_since,
        } = &mut *state
        else {
            return None;
        };
        if length + SLACK > *bytes {
            return None;
        }
        // Memory that has been read is taken back at once: the same cells stay in the processor's cache.
        provider.garbage_collect();
        let found = provider.alloc(length).wait().ok();
        *full_since = match found {
            Some(_) => None,
            None => Some(full_since.unwrap_or_else(Instant::now)),
        };
        if full_since.is_some_and(|since| since.elapsed() > CLOGGED) {
            // Whoever still reads in it keeps it.
            *state = State::Untried;
        }
        found
    }
}
