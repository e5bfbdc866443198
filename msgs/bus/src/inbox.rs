//! Bounded queues between a transport's thread and the thread that does the work.
//!
//! A transport's callback does nothing but push here: work inside it, or a queue that blocks,
//! would stall every topic of that peer.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::Notify;

/// Messages that a subscription keeps while its thread is busy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Queue {
    /// The newest alone.
    Latest,
    /// The newest `n`; older ones are dropped and counted.
    Ring(usize),
    /// The oldest `n`; newer ones are dropped and counted.
    Bounded(usize),
}

/// Counts of an inbox.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Items that arrived.
    pub arrived: u64,
    /// Items dropped because the queue was full.
    pub dropped: u64,
}

/// Wakes one thread, or one task, for many inboxes.
#[derive(Clone, Debug, Default)]
pub struct Wake {
    inner: Arc<WakeInner>,
}

#[derive(Debug, Default)]
struct WakeInner {
    rung: Mutex<bool>,
    thread: Condvar,
    task: Notify,
}

impl Wake {
    /// A wake-up that nobody has rung.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Rings: the waiting thread, or the next one to wait, continues.
    pub fn ring(&self) {
        *self.rung() = true;
        self.inner.thread.notify_one();
        self.inner.task.notify_one();
    }

    /// Waits until rung. Dropped before that, it leaves a ring to the next one that waits.
    pub async fn ringing(&self) {
        while !std::mem::take(&mut *self.rung()) {
            self.inner.task.notified().await;
        }
    }

    /// Waits until rung or until `limit` has passed; whether it was rung.
    pub fn wait(&self, limit: Duration) -> bool {
        let (mut guard, _) = self
            .inner
            .thread
            .wait_timeout_while(self.rung(), limit, |rung| !*rung)
            .unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *guard)
    }

    fn rung(&self) -> MutexGuard<'_, bool> {
        self.inner
            .rung
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

/// The receiving end of a bounded queue; clones share it.
#[derive(Debug)]
pub struct Inbox<T> {
    inner: Arc<InboxInner<T>>,
}

#[derive(Debug)]
struct InboxInner<T> {
    items: Mutex<VecDeque<T>>,
    queue: Queue,
    wake: Wake,
    arrived: AtomicU64,
    dropped: AtomicU64,
}

impl<T> Clone for Inbox<T> {
    fn clone(&self) -> Self {
        Self {
            inner: Arc::clone(&self.inner),
        }
    }
}

impl<T> Inbox<T> {
    /// An empty inbox that rings `wake` at each arrival.
    #[must_use]
    pub fn new(queue: Queue, wake: &Wake) -> Self {
        let room = match queue {
            Queue::Latest => 1,
            Queue::Ring(n) | Queue::Bounded(n) => n.min(64),
        };
        Self {
            inner: Arc::new(InboxInner {
                items: Mutex::new(VecDeque::with_capacity(room)),
                queue,
                wake: wake.clone(),
                arrived: AtomicU64::new(0),
                dropped: AtomicU64::new(0),
            }),
        }
    }

    /// Adds an item and rings; constant time, never blocks on the consumer's work.
    pub fn push(&self, item: T) {
        let inner = &*self.inner;
        inner.arrived.fetch_add(1, Ordering::Relaxed);
        {
            let mut items = inner.items.lock().unwrap_or_else(PoisonError::into_inner);
            let keep = match inner.queue {
                Queue::Latest => 1,
                Queue::Ring(n) | Queue::Bounded(n) => n.max(1),
            };
            if items.len() >= keep {
                inner.dropped.fetch_add(1, Ordering::Relaxed);
                if matches!(inner.queue, Queue::Bounded(_)) {
                    return;
                }
                items.pop_front();
            }
            items.push_back(item);
        }
        inner.wake.ring();
    }

    /// The oldest item, if there is one.
    #[must_use]
    pub fn try_recv(&self) -> Option<T> {
        self.inner
            .items
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop_front()
    }

    /// True if it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inner
            .items
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .is_empty()
    }

    /// Messages received and dropped so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        Counts {
            arrived: self.inner.arrived.load(Ordering::Relaxed),
            dropped: self.inner.dropped.load(Ordering::Relaxed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fill(queue: Queue) -> (Vec<u32>, Counts) {
        let inbox = Inbox::new(queue, &Wake::new());
        (0..5).for_each(|item| inbox.push(item));
        let items = std::iter::from_fn(|| inbox.try_recv()).collect();
        (items, inbox.counts())
    }

    #[test]
    fn each_queue_keeps_what_it_promises() {
        let counts = |dropped| Counts {
            arrived: 5,
            dropped,
        };
        assert_eq!(fill(Queue::Latest), (vec![4], counts(4)));
        assert_eq!(fill(Queue::Ring(3)), (vec![2, 3, 4], counts(2)));
        assert_eq!(fill(Queue::Bounded(3)), (vec![0, 1, 2], counts(2)));
    }

    #[test]
    fn a_ring_before_the_wait_is_not_lost() {
        let wake = Wake::new();
        wake.ring();
        assert!(wake.wait(Duration::ZERO));
        assert!(!wake.wait(Duration::ZERO));
    }

    #[tokio::test]
    async fn a_ring_before_the_wait_of_a_task_is_not_lost_and_rings_once() {
        let wake = Wake::new();
        wake.ring();
        wake.ringing().await;
        tokio::select! {
            biased;
            () = wake.ringing() => panic!("it was rung once"),
            () = tokio::task::yield_now() => {}
        }
        let other = wake.clone();
        tokio::join!(wake.ringing(), async { other.ring() });
    }
}
