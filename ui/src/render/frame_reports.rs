//! Reports each frame that the graphics device has completed: the brush states it shows, and its duration.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui::{Rect, Shape};
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, wgpu};
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_types::Origin;
use maulstick_types::paint::FrameHolds;
use maulstick_types::window::Presented;
use maulstick_types::wire::topics::Topics;

/// Polling interval while a frame is in flight: a device reports completion only when polled.
const ASK: Duration = Duration::from_millis(1);

/// Brush states that a picture of a surface shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Holding {
    /// The journal entries below this index.
    pub journal: u64,
    pub holds: Vec<FrameHolds>,
}

/// Progress of the graphics device through its frames; clones share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Completion(Arc<Line>);

impl Completion {
    /// Waits until it has drawn all that it was given, at most for `limit`.
    pub(crate) fn wait(&self, limit: Duration) {
        let state = self.0.state();
        let busy = |state: &mut State| state.under_way > 0 && !state.ended;
        drop(self.0.events.wait_timeout_while(state, limit, busy));
    }
}

/// Follows frames to their completion and reports them.
pub(crate) struct Presenter {
    bus: Arc<dyn Bus>,
    line: Arc<Line>,
    frames: u64,
    thread: Option<JoinHandle<()>>,
}

/// Frames in flight.
#[derive(Debug, Default)]
struct Line {
    state: Mutex<State>,
    events: Condvar,
}

#[derive(Debug, Default)]
struct State {
    under_way: usize,
    /// Completed frames that are not reported yet, with the time of their completion, ns.
    completed: Vec<(u64, Presented)>,
    ended: bool,
}

impl Line {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Presenter {
    /// Tells of the frames that `device` completes, as `me`.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        me: Origin,
        device: &wgpu::Device,
    ) -> Result<Self, BusError> {
        let sender = Sender::new(&*bus, &topics.presented(), Qos::Background, me)?;
        let line = Arc::new(Line::default());
        let (listened, clock, device) = (Arc::clone(&line), Arc::clone(&bus), device.clone());
        let ask = move || {
            if let Err(error) = device.poll(wgpu::PollType::Poll) {
                tracing::debug!("the graphics device: {error}");
            }
        };
        let run = move || tell(&listened, sender, &*clock, &ask);
        let thread = std::thread::Builder::new()
            .name("presented".into())
            .spawn(run);
        let thread = thread
            .inspect_err(|error| {
                tracing::error!("the thread of frame reports cannot be started: {error}")
            })
            .ok();
        Ok(Self {
            bus,
            line,
            frames: 0,
            thread,
        })
    }

    /// Progress of the device.
    #[must_use]
    pub(crate) fn completion(&self) -> Completion {
        Completion(Arc::clone(&self.line))
    }

    /// Reporter of the frame that was begun at `begun_ns` and shows `holding`: a shape of the window that draws
    /// nothing; its `area` has to be in the window.
    pub(crate) fn shape(&mut self, area: Rect, begun_ns: u64, holding: Holding) -> Shape {
        let Holding { journal, holds } = holding;
        let presented = Presented {
            frame: self.frames,
            begun_ns,
            draw_ns: 0,
            journal,
            holds,
        };
        self.frames += 1;
        let follow = Follow {
            presented: Mutex::new(Some(presented)),
            bus: Arc::clone(&self.bus),
            line: Arc::clone(&self.line),
        };
        egui_wgpu::Callback::new_paint_callback(area, follow).into()
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        self.line.state().ended = true;
        self.line.events.notify_all();
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// Follows a frame from where all of it is recorded.
struct Follow {
    presented: Mutex<Option<Presented>>,
    bus: Arc<dyn Bus>,
    line: Arc<Line>,
}

impl CallbackTrait for Follow {
    fn finish_prepare(
        &self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        _resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let mut presented = self
            .presented
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(mut presented) = presented.take() {
            presented.draw_ns = self.bus.now_ns().saturating_sub(presented.begun_ns);
            let way = Way::begin(&self.line);
            let bus = Arc::clone(&self.bus);
            encoder.on_submitted_work_done(move || way.end(bus.now_ns(), presented));
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: eframe::egui::PaintCallbackInfo,
        _pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
    }
}

/// A frame in flight; one that is dropped counts as completed too.
struct Way(Arc<Line>);

impl Way {
    fn begin(line: &Arc<Line>) -> Self {
        line.state().under_way += 1;
        line.events.notify_all();
        Self(Arc::clone(line))
    }

    fn end(self, now_ns: u64, presented: Presented) {
        self.0.state().completed.push((now_ns, presented));
    }
}

impl Drop for Way {
    fn drop(&mut self) {
        self.0.state().under_way -= 1;
        self.0.events.notify_all();
    }
}

/// Sends reports of completed frames; calls `ask` while frames are in flight.
fn tell(line: &Line, mut sender: Sender<Presented>, bus: &dyn Bus, ask: &dyn Fn()) {
    let mut state = line.state();
    while !state.ended {
        let completed = std::mem::take(&mut state.completed);
        if !completed.is_empty() {
            drop(state);
            for (completed_ns, presented) in completed {
                if let Err(error) = sender.send(bus.now_ns(), completed_ns, &presented) {
                    tracing::debug!("a frame cannot be reported: {error}");
                }
            }
            state = line.state();
        } else if state.under_way > 0 {
            drop(state);
            ask();
            state = line.state();
            if state.completed.is_empty() && state.under_way > 0 {
                let waited = line.events.wait_timeout(state, ASK);
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        } else {
            let waited = line.events.wait(state);
            state = waited.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::typed::Receiver;
    use maulstick_bus::{Faults, MemoryNet, Queue, Wake};

    use super::*;

    #[test]
    fn a_frame_is_told_when_the_device_has_completed_it_and_one_given_up_is_not() {
        let gpu = crate::render::gpu::testing::gpu();
        let net = MemoryNet::new(1, 5, Faults::default());
        let (bus, topics, wake) = (Arc::new(net.bus()), Topics::new("t"), Wake::new());
        let (topic, class) = (topics.presented(), Qos::Background);
        let mut told: Receiver<Presented> =
            Receiver::new(&*bus, &topic, class, Queue::Ring(4), &wake).expect("a topic");
        let me = Origin {
            source: 1,
            epoch: 2,
        };
        let line = Arc::new(Line::default());
        let frame = |number: u64| {
            let follow = Follow {
                presented: Mutex::new(Some(Presented {
                    frame: number,
                    begun_ns: 2,
                    draw_ns: 0,
                    journal: 7,
                    holds: Vec::new(),
                })),
                bus: Arc::clone(&bus) as Arc<dyn Bus>,
                line: Arc::clone(&line),
            };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let (device, queue) = (&gpu.device, &gpu.queue);
            let mut resources = CallbackResources::default();
            follow.finish_prepare(device, queue, &mut encoder, &mut resources);
            encoder
        };
        drop(frame(0));
        assert_eq!(line.state().under_way, 0, "nothing is waited for");
        let encoder = frame(1);
        assert!(line.state().completed.is_empty(), "a fault would pass");
        gpu.queue.submit([encoder.finish()]);
        let wait = wgpu::PollType::wait_indefinitely();
        gpu.device.poll(wait).expect("drawn");
        let sender = Sender::new(&*bus, &topic, class, me).expect("a topic");
        let (listened, clock) = (Arc::clone(&line), Arc::clone(&bus));
        let thread = std::thread::spawn(move || tell(&listened, sender, &*clock, &|| ()));
        while !line.state().completed.is_empty() {
            std::thread::yield_now();
        }
        line.state().ended = true;
        line.events.notify_all();
        thread.join().expect("ended");
        net.advance(1_000_000);
        let presented = told.newest().expect("told");
        assert_eq!(presented.header.event_ns, 5);
        let Presented {
            frame,
            draw_ns,
            journal,
            ..
        } = presented.message;
        assert_eq!((frame, draw_ns, journal), (1, 3, 7));
    }
}
