//! The window as a pen finds it, and the pen as the window finds it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use maulstick_device::pen::Presence;

/// Pointer events that wait for the window at most: one that is not drawn takes none.
const WAITING: usize = 4096;

/// The desk as a window shows it; points are the window's pixels, y down from its upper left corner.
pub trait DeskView: Send {
    /// True where the desk lies open: no panel, no control is there.
    fn is_desk(&self, point: [f64; 2]) -> bool;

    /// The point of the desk that is seen there, m.
    fn to_desk(&self, point: [f64; 2]) -> [f64; 3];

    /// True if the window shows the desk as in a mirror.
    fn is_mirrored(&self) -> bool;
}

/// What happened with a pen, for a window whose system moves no pointer with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointerNews {
    /// It is there, pixels.
    Moved([f64; 2]),
    /// It was pressed onto a control, or lifted from it.
    Pressed([f64; 2], bool),
    /// It is gone.
    Gone,
}

/// The pen as a window finds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PenNews {
    /// When it was last near, rig clock, ns; 0 for never.
    pub near_ns: u64,
    /// True while it is near.
    pub is_near: bool,
    /// True while it touches the desk.
    pub paints: bool,
    /// What it senses, bits of [`axes`](maulstick_types::stylus::axes); 0 before one was near.
    pub senses: u32,
    /// What its pointer did since the last call, in order.
    pub pointer: Vec<PointerNews>,
    /// True if the window system moves no pointer with it: the window does by `pointer`.
    pub moves_no_pointer: bool,
}

/// What window and pen know of each other.
#[derive(Clone, Default)]
pub struct Shared(Arc<Mutex<Known>>);

#[derive(Default)]
struct Known {
    view: Option<Box<dyn DeskView>>,
    brush: String,
    news: PenNews,
    on_news: Option<Box<dyn Fn() + Send>>,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Known> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The window shows the desk so, from now on; `brush` is in the hand.
    pub fn show(&self, view: Option<Box<dyn DeskView>>, brush: &str) {
        let mut known = self.lock();
        known.view = view;
        if known.brush != brush {
            brush.clone_into(&mut known.brush);
        }
    }

    /// Calls `ring` when a pointer that only the window moves has moved.
    pub fn on_news(&self, ring: impl Fn() + Send + 'static) {
        self.lock().on_news = Some(Box::new(ring));
    }

    /// The pen since the last call.
    #[must_use]
    pub fn news(&self) -> PenNews {
        let mut known = self.lock();
        let pointer = std::mem::take(&mut known.news.pointer);
        PenNews {
            pointer,
            ..known.news.clone()
        }
    }

    /// What the desk is at a point: its place, m, whether it is mirrored, and whether it lies open there; `None` while no
    /// desk is shown.
    pub(crate) fn desk(&self, point: [f64; 2]) -> Option<([f64; 3], bool, bool)> {
        let known = self.lock();
        let view = known.view.as_ref()?;
        Some((view.to_desk(point), view.is_mirrored(), view.is_desk(point)))
    }

    /// The brush in the hand.
    pub(crate) fn brush(&self) -> String {
        self.lock().brush.clone()
    }

    /// The window system moves no pointer with a pen.
    pub(crate) fn moves_no_pointer(&self) {
        self.lock().news.moves_no_pointer = true;
    }

    /// A pen that senses this is there.
    pub(crate) fn senses(&self, senses: u32) {
        self.lock().news.senses = senses;
    }

    /// Where it is, and whether it touches the desk.
    pub(crate) fn tell(&self, now_ns: u64, presence: Presence, paints: bool) {
        let news = &mut self.lock().news;
        let near = presence != Presence::Away;
        if near || news.is_near {
            news.near_ns = now_ns;
        }
        (news.is_near, news.paints) = (near, paints);
    }

    /// Its pointer did so.
    pub(crate) fn point(&self, what: PointerNews) {
        let known = &mut *self.lock();
        let pointer = &mut known.news.pointer;
        if let (PointerNews::Moved(_), Some(PointerNews::Moved(_))) = (what, pointer.last()) {
            pointer.pop();
        }
        if pointer.len() < WAITING {
            pointer.push(what);
        }
        if let Some(ring) = known
            .on_news
            .as_ref()
            .filter(|_| known.news.moves_no_pointer)
        {
            ring();
        }
    }
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}
