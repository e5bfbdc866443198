//! The state behind the interface: one device, one frame, a stack of errors, a log.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::codes;
use crate::log::Call;
use crate::phantom::Phantom;
use crate::script::{Event, Scheduler, Script};

/// The handle of the only device.
const HANDLE: u32 = 0;

/// A function that is called back.
pub(crate) type Callback = unsafe extern "C" fn(*mut c_void) -> u32;

/// Who is called back.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) handle: u64,
    pub(crate) callback: Callback,
    /// The callback's own pointer, as a number: it goes to another thread.
    pub(crate) data: usize,
    pub(crate) priority: u16,
}

/// All of it.
#[derive(Default)]
pub(crate) struct State {
    script: Script,
    pub(crate) log: Vec<Call>,
    errors: Vec<(u32, i32)>,
    device: Option<Phantom>,
    is_unplugged: bool,
    /// The force that the open frame will give, N; none where no frame is open.
    frame: Option<[f64; 3]>,
    end_error: Option<(u32, i32)>,
    capabilities: BTreeSet<u32>,
    pub(crate) is_running: bool,
    is_stalled: bool,
    pub(crate) tick: u64,
    pub(crate) entries: Vec<Entry>,
    next_entry: u64,
}

static STATE: Mutex<Option<State>> = Mutex::new(None);

thread_local! {
    /// The device of which this thread asks; what a thread does not say it does not know.
    static CURRENT: Cell<u32> = const { Cell::new(codes::INVALID_HANDLE) };
}

/// The state, for a moment.
pub(crate) fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    let mut guard: MutexGuard<'_, _> = STATE.lock().unwrap_or_else(PoisonError::into_inner);
    work(guard.get_or_insert_default())
}

impl State {
    /// Begins anew; refused while a device or the scheduler is in use.
    pub(crate) fn play(&mut self, script: Script) -> bool {
        if self.device.is_some() || self.is_running {
            return false;
        }
        *self = Self {
            script,
            next_entry: self.next_entry,
            ..Self::default()
        };
        true
    }

    /// Something happens now.
    pub(crate) fn happen(&mut self, event: &Event) {
        match event {
            Event::Error(code, internal) => self.report(*code, *internal),
            Event::ErrorAtEnd(code, internal) => self.end_error = Some((*code, *internal)),
            Event::Unplug => self.is_unplugged = true,
            Event::Plug => self.is_unplugged = false,
            Event::Stall => self.is_stalled = true,
            _ => {}
        }
        if let Some(device) = &mut self.device {
            device.undergo(event);
        }
    }

    /// An error goes onto the stack.
    pub(crate) fn report(&mut self, code: u32, internal: i32) {
        self.log.push(Call::Error(code));
        self.errors.push((code, internal));
    }

    /// The newest error leaves the stack.
    pub(crate) fn pop(&mut self) -> (u32, i32) {
        self.errors.pop().unwrap_or_default()
    }

    pub(crate) fn init(&mut self, name: String) -> u32 {
        let is_known = self.script.names.contains(&name);
        self.log.push(Call::Init(name));
        let error = match (&self.device, self.script.init_error) {
            (Some(_), _) => Some((codes::DEVICE_ALREADY_INITIATED, 0)),
            (None, Some(error)) => Some(error),
            (None, None) if self.is_unplugged => Some((codes::COMM_ERROR, -28)),
            (None, None) if !is_known => Some((codes::DEVICE_FAULT, -1)),
            (None, None) => None,
        };
        if let Some((code, internal)) = error {
            self.report(code, internal);
            return self.script.failed_handle;
        }
        self.device = Some(Phantom::new(&self.script));
        CURRENT.set(HANDLE);
        HANDLE
    }

    pub(crate) fn disable_device(&mut self, handle: u32) {
        self.log.push(Call::DisableDevice(handle));
        if handle == HANDLE && self.device.take().is_some() {
            self.frame = None;
            self.capabilities.clear();
        } else if handle != self.script.failed_handle {
            self.report(codes::BAD_HANDLE, 0);
        }
    }

    /// The device that this thread has made the current one, while there is one.
    pub(crate) fn current(&self) -> u32 {
        match self.device {
            Some(_) => CURRENT.get(),
            None => codes::INVALID_HANDLE,
        }
    }

    pub(crate) fn make_current(&mut self, handle: u32) {
        match self.device {
            Some(_) if handle == HANDLE => CURRENT.set(handle),
            _ => self.report(codes::BAD_HANDLE, 0),
        }
    }

    /// Whether this thread asks of a device; an error where it does not.
    fn has_current(&mut self) -> bool {
        let has = self.current() == HANDLE;
        if !has {
            self.report(codes::INVALID_OPERATION, 0);
        }
        has
    }

    pub(crate) fn begin(&mut self, handle: u32) {
        self.log.push(Call::Begin(self.tick));
        if handle != HANDLE || self.device.is_none() {
            return self.report(codes::BAD_HANDLE, 0);
        }
        CURRENT.set(handle);
        if self.frame.is_some() {
            return self.report(codes::ILLEGAL_BEGIN, 0);
        }
        let Some(device) = &mut self.device else {
            return;
        };
        device.frames += 1;
        // A frame that sets no force keeps the one before: a driver that forgets shows.
        self.frame = Some(device.force);
        let now = device.frames;
        let due: Vec<Event> = device
            .script
            .moments
            .iter()
            .filter(|moment| moment.frame == now)
            .map(|moment| moment.event.clone())
            .collect();
        for event in due {
            self.happen(&event);
        }
        if self.is_unplugged {
            self.report(codes::COMM_ERROR, -28);
        }
    }

    pub(crate) fn end(&mut self, handle: u32) {
        let Some(force) = self.frame.take().filter(|_| handle == HANDLE) else {
            return self.report(codes::ILLEGAL_END, 0);
        };
        let force = match self.capabilities.contains(&codes::FORCE_OUTPUT) {
            true => force,
            false => [0.0; 3],
        };
        self.log.push(Call::End(force));
        if let Some(device) = &mut self.device {
            device.force = force;
        }
        if let Some((code, internal)) = self.end_error.take() {
            self.report(code, internal);
        }
    }

    /// A tick of the scheduler ends.
    pub(crate) fn end_tick(&mut self) {
        if self.frame.is_some() {
            // A frame does not outlast its tick.
            self.report(0x0402, 0);
        }
        if let Some(device) = &mut self.device {
            device.advance();
        }
    }

    /// Whom this tick calls, the most urgent first.
    pub(crate) fn due(&mut self) -> Vec<Entry> {
        self.tick += 1;
        if self.is_stalled || self.script.scheduler == Scheduler::Dead {
            return Vec::new();
        }
        let mut entries = self.entries.clone();
        entries.sort_by_key(|entry| std::cmp::Reverse(entry.priority));
        entries
    }

    pub(crate) fn schedule(&mut self, callback: Callback, data: usize, priority: u16) -> u64 {
        self.log.push(Call::Schedule(priority));
        if let Some(code) = self.script.schedule_error {
            self.report(code, 0);
            return u64::MAX;
        }
        self.next_entry += 1;
        self.entries.push(Entry {
            handle: self.next_entry,
            callback,
            data,
            priority,
        });
        self.next_entry
    }

    pub(crate) fn unschedule(&mut self, handle: u64) {
        self.log.push(Call::Unschedule(handle));
        self.entries.retain(|entry| entry.handle != handle);
    }

    /// Whether the scheduler may start.
    pub(crate) fn start(&mut self) -> bool {
        self.log.push(Call::Start);
        if let Some(code) = self.script.start_error {
            self.report(code, 0);
            return false;
        }
        !std::mem::replace(&mut self.is_running, true)
    }

    pub(crate) fn switch(&mut self, capability: u32, on: Capability) {
        self.log.push(match on {
            Capability::On => Call::Enable(capability),
            Capability::Off => Call::Disable(capability),
        });
        let is_limit = [0x2606, 0x2607].contains(&capability);
        let is_known =
            is_limit || (codes::FORCE_OUTPUT..=codes::ONE_FRAME_LIMIT).contains(&capability);
        if !is_known || self.script.unknown.contains(&capability) {
            self.report(codes::INVALID_ENUM, 0);
        } else if self.current() != HANDLE || (self.is_running && self.frame.is_none()) {
            self.report(codes::INVALID_OPERATION, 0);
        } else if on == Capability::On {
            self.capabilities.insert(capability);
        } else {
            self.capabilities.remove(&capability);
        }
    }

    pub(crate) fn is_enabled(&self, capability: u32) -> bool {
        self.capabilities.contains(&capability)
    }

    /// A value of the device, if it may be asked for now.
    pub(crate) fn value<T>(
        &mut self,
        parameter: u32,
        get: impl Fn(&Phantom, u32) -> Option<T>,
    ) -> Option<T> {
        let of_a_frame = matches!(parameter, 0x2000..=0x24FF | 0x2700..=0x28FF)
            || parameter == codes::TEMPERATURE;
        if !self.has_current() {
            return None;
        }
        let device = self.device.as_ref()?;
        let known = !self.script.unknown.contains(&parameter);
        let value = get(device, parameter).filter(|_| known);
        let of_another_type = known
            && (device.floats(parameter).is_some()
                || device.integer(parameter).is_some()
                || device.boolean(parameter).is_some());
        if value.is_none() {
            self.report(
                match of_another_type {
                    true => codes::INVALID_INPUT_TYPE,
                    false => codes::INVALID_ENUM,
                },
                0,
            );
        } else if of_a_frame && self.frame.is_none() {
            self.report(codes::INVALID_OPERATION, 0);
            return None;
        }
        value
    }

    /// Sets three doubles.
    pub(crate) fn set(&mut self, parameter: u32, values: [f64; 3]) {
        match (parameter, self.script.output_dof) {
            (codes::FORCE, _) => self.log.push(Call::Force(values)),
            (codes::TORQUE, 6) => self.log.push(Call::Torque(values)),
            _ => return self.report(codes::INVALID_ENUM, 0),
        }
        match &mut self.frame {
            None => self.report(codes::INVALID_OPERATION, 0),
            Some(_) if !values.iter().all(|value| value.is_finite()) => {
                self.report(codes::INVALID_VALUE, 0);
            }
            Some(force) if parameter == codes::FORCE => *force = values,
            Some(_) => {}
        }
    }

    /// While the scheduler runs, the errors belong to what it calls.
    pub(crate) fn pop_from(&mut self, whose: Whose) -> (u32, i32) {
        if self.is_running && whose == Whose::Other {
            self.log.push(Call::Error(codes::INVALID_OPERATION));
        }
        self.pop()
    }

    /// Whether calibration is looked at within a frame, as it has to be while the scheduler runs; an error
    /// where it is not.
    fn is_in_turn(&mut self) -> bool {
        let is_in_turn = !self.is_running || self.frame.is_some();
        if !is_in_turn {
            self.report(codes::INVALID_OPERATION, 0);
        }
        is_in_turn
    }

    pub(crate) fn check(&mut self) -> u32 {
        self.has_current();
        self.is_in_turn();
        let device = self.device.as_ref();
        let state = device.and_then(|device| device.script.calibration.first().copied());
        let state = state.unwrap_or(0x5000);
        self.log.push(Call::Check(state));
        state
    }

    pub(crate) fn update(&mut self, style: u32) {
        self.log.push(Call::Update(style));
        let out_of_turn = match style {
            codes::INKWELL => !self.is_running,
            _ => false,
        };
        if !self.has_current() || !self.is_in_turn() {
            return;
        }
        let Some(device) = &mut self.device else {
            return;
        };
        if device.script.styles as u32 & style == 0 {
            self.report(codes::INVALID_VALUE, 0);
        } else if out_of_turn {
            self.report(codes::INVALID_OPERATION, 0);
        } else if device.script.calibration.len() > 1 {
            device.script.calibration.remove(0);
        }
    }

    pub(crate) fn model(&self) -> &str {
        &self.script.model
    }
}

/// On whose thread something is asked.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Whose {
    /// The scheduler's.
    Scheduler,
    /// Another.
    Other,
}

/// Whether a capability is wanted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Capability {
    On,
    Off,
}
