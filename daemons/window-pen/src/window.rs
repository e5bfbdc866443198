//! The window as a pen finds it, and the pen as the window finds it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use maulstick_device::pen::Presence;
use maulstick_device::pressure_curve::given;

/// The desk as a window shows it; points are the window's pixels, y down from its upper left corner.
pub trait DeskView: Send + Sync {
    /// True where the desk lies open: no panel, no control is there.
    fn is_desk(&self, point: [f64; 2]) -> bool;

    /// The point of the desk that is seen there, m.
    fn to_desk(&self, point: [f64; 2]) -> [f64; 3];

    /// True if a touch of the open desk paints: no key is held that makes something else of it.
    fn takes_strokes(&self) -> bool;

    /// True if the window shows the desk as in a mirror.
    fn is_mirrored(&self) -> bool;
}

/// Contents of a point of a window, as a pen finds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenDesk {
    /// The point of the desk, m.
    pub point_m: [f64; 3],
    /// True if it is seen in a mirror.
    pub is_mirrored: bool,
    /// True where the desk lies open.
    pub is_desk: bool,
    /// True if a touch there paints.
    pub takes_strokes: bool,
}

/// Event of a pen, for a window whose system moves no pointer with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointerEvent {
    /// It is there, pixels.
    Moved([f64; 2]),
    /// It was pressed onto a control, or lifted from it.
    Pressed([f64; 2], bool),
    /// It is gone.
    Gone,
}

/// The pen as a window finds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PenState {
    /// When it was last near, rig clock, ns; 0 for never.
    pub near_ns: u64,
    /// True while it is near.
    pub is_near: bool,
    /// Pressure that it senses, 0 to 1, whatever lies below it.
    pub pressure: f64,
    /// Axes that it senses, bits of [`axes`](maulstick_types::stylus::axes); 0 before one was near.
    pub senses: u32,
    /// Events of its pointer since the last call, in order.
    pub pointer: Vec<PointerEvent>,
    /// True if the window system moves no pointer with it: the window does by `pointer`.
    pub moves_no_pointer: bool,
}

/// The link between a window and its pens.
#[derive(Clone, Default)]
pub struct PenLink(Arc<Mutex<LinkState>>);

#[derive(Default)]
struct LinkState {
    view: Option<Arc<dyn DeskView>>,
    brush: String,
    pressure_curve: Vec<[f64; 2]>,
    state: PenState,
    wake: Option<Arc<dyn Fn() + Send + Sync>>,
}

impl PenLink {
    fn lock(&self) -> MutexGuard<'_, LinkState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the view and the brush in the hand.
    pub fn show(&self, view: Option<Arc<dyn DeskView>>, brush: &str) {
        let mut known = self.lock();
        known.view = view;
        if known.brush != brush {
            brush.clone_into(&mut known.brush);
        }
    }

    /// Sets the points (sensed, given) between which pressure goes in straight lines; none for the pressure as it is.
    pub fn bend_pressure(&self, curve: &[[f64; 2]]) {
        let mut known = self.lock();
        if known.pressure_curve != curve {
            known.pressure_curve = curve.to_vec();
        }
    }

    /// The pressure to give where this is sensed.
    pub(crate) fn given(&self, sensed: f64) -> f64 {
        given(&self.lock().pressure_curve, sensed)
    }

    /// Calls `wake` when a pointer that only the window moves has moved.
    pub fn on_pointer(&self, wake: impl Fn() + Send + Sync + 'static) {
        self.lock().wake = Some(Arc::new(wake));
    }

    /// The pen since the last call.
    #[must_use]
    pub fn state(&self) -> PenState {
        let mut known = self.lock();
        let pointer = std::mem::take(&mut known.state.pointer);
        PenState {
            pointer,
            ..known.state.clone()
        }
    }

    /// The desk at a point; `None` while none is shown.
    pub(crate) fn desk(&self, point: [f64; 2]) -> Option<SeenDesk> {
        // The view asks the window, whose lock is not waited for with this one.
        let view = Arc::clone(self.lock().view.as_ref()?);
        let is_desk = view.is_desk(point);
        Some(SeenDesk {
            point_m: view.to_desk(point),
            is_mirrored: view.is_mirrored(),
            is_desk,
            takes_strokes: is_desk && view.takes_strokes(),
        })
    }

    /// The brush in the hand.
    pub(crate) fn brush(&self) -> String {
        self.lock().brush.clone()
    }

    /// The window system moves no pointer with a pen.
    pub fn set_moves_no_pointer(&self) {
        self.lock().state.moves_no_pointer = true;
    }

    /// A pen that senses this is there.
    pub(crate) fn senses(&self, senses: u32) {
        self.lock().state.senses = senses;
    }

    /// It is near, or away.
    pub(crate) fn tell(&self, now_ns: u64, presence: Presence, pressure: f64) {
        let state = &mut self.lock().state;
        state.pressure = match presence {
            Presence::Touching => pressure.clamp(0.0, 1.0),
            _ => 0.0,
        };
        let near = presence != Presence::Away;
        if near || state.is_near {
            state.near_ns = now_ns;
        }
        state.is_near = near;
    }

    /// Its pointer did so, where only the window moves it.
    pub(crate) fn point(&self, what: PointerEvent) {
        let mut known = self.lock();
        if !known.state.moves_no_pointer {
            return;
        }
        let pointer = &mut known.state.pointer;
        if let (PointerEvent::Moved(_), Some(PointerEvent::Moved(_))) = (what, pointer.last()) {
            pointer.pop();
        }
        // Moves are merged: only presses add to it.
        pointer.push(what);
        let wake = known.wake.clone();
        drop(known);
        if let Some(wake) = wake {
            wake();
        }
    }
}

impl std::fmt::Debug for PenLink {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PenLink").finish_non_exhaustive()
    }
}
