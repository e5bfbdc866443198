//! Small pictures of the painting, of its versions and of the steps of its history, for whoever asks: drawn one at a
//! time, on a thread of their own, from tiles that the painting shares; those of steps only while nobody paints.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use maulstick_bus::typed::{Reader, answer};
use maulstick_bus::{Bus, BusError, Request, Server, Wake};
use maulstick_exchange::{HistoryPictures, small_picture};
use maulstick_painting::Painting;
use maulstick_rig::thread::try_start;
use maulstick_types::Origin;
use maulstick_types::paint::{ThumbnailReply, ThumbnailRequest};
use maulstick_types::scene::{CANVAS, Light};

/// Pixels of the longer side.
const SIDES: std::ops::RangeInclusive<u32> = 1..=512;
/// Number of cached pictures.
const KEPT: usize = 64;
/// Nobody paints if no paint has moved for so long, ns.
const REST_NS: u64 = 300_000_000;
/// Views that wait, at most: who asks too often is answered later.
const WAITING: usize = 256;

/// Content of a picture: the picture is valid as long as this is the same.
#[derive(Clone, Debug)]
struct Shows {
    version: String,
    side: u32,
    light: Light,
    state: State,
}

#[derive(Clone, Debug)]
enum State {
    /// The painting as it is: newest tile version and look.
    Now([u64; 2]),
    /// The tiles of a version: another one of its name has others.
    Kept(Weak<dyn std::any::Any + Send + Sync>),
    /// A step of the history, and how many before it are undone; while it is not finished, with the newest tile version.
    Step([u64; 2], Option<u64>),
}

impl Shows {
    /// Content of the requested picture; `None` if there is no such version or step.
    fn of(painting: &Painting, asked: &ThumbnailRequest) -> Option<Self> {
        let state = match (asked.step, asked.version.as_str()) {
            (Some(step), _) => {
                let at = painting.history().undone_before(step)?;
                let open = painting.history().is_open(step);
                State::Step([step, at], open.then(|| painting.versions()))
            }
            (None, "") => State::Now([painting.versions(), painting.look().generation()]),
            (None, name) => {
                let version = painting.named().find(|version| version.name == name)?;
                let tiles: Arc<dyn std::any::Any + Send + Sync> = version.tiles.clone();
                State::Kept(Arc::downgrade(&tiles))
            }
        };
        Some(Self {
            version: match asked.step {
                Some(_) => String::new(),
                None => asked.version.clone(),
            },
            side: asked.side.clamp(*SIDES.start(), *SIDES.end()),
            light: painting.scene().light.clone(),
            state,
        })
    }

    fn is(&self, other: &Self) -> bool {
        let state = match (&self.state, &other.state) {
            (State::Now(one), State::Now(two)) => one == two,
            (State::Kept(one), State::Kept(two)) => one.ptr_eq(two),
            (State::Step(one, at), State::Step(two, then)) => (one, at) == (two, then),
            _ => false,
        };
        state
            && self.side == other.side
            && self.version == other.version
            && self.light == other.light
    }
}

/// The answer where there is no picture.
fn no_picture() -> ThumbnailReply {
    ThumbnailReply {
        width: 0,
        height: 0,
        rgb: Vec::new().into(),
        version: 0,
    }
}

/// Server of small pictures.
pub struct Thumbnails {
    server: Server,
    reader: Reader,
    wake: Wake,
    me: Origin,
    waiting: Vec<(Request, ThumbnailRequest)>,
    drawing: Option<(Shows, Receiver<ThumbnailReply>)>,
    /// Newest last.
    kept: Vec<(Shows, ThumbnailReply)>,
    of_steps: Arc<Mutex<HistoryPictures>>,
    /// Steps of the paint model so far, and when there was a new one, ns.
    work: (u64, u64),
}

impl Thumbnails {
    /// Serves `topic`; rings `wake` when there is something to do.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(bus: &dyn Bus, topic: &str, wake: &Wake, me: Origin) -> Result<Self, BusError> {
        Ok(Self {
            server: bus.serve(topic, 64, wake)?,
            reader: Reader::default(),
            wake: wake.clone(),
            me,
            waiting: Vec::new(),
            drawing: None,
            kept: Vec::new(),
            of_steps: Arc::default(),
            work: (0, 0),
        })
    }

    /// Answers requests whose picture is there, and has the next picture drawn.
    pub fn poll(&mut self, bus: &dyn Bus, painting: &mut Painting) {
        while let Some(request) = self.server.try_recv() {
            let read = self
                .reader
                .read::<ThumbnailRequest>(&request.key, &request.bytes);
            if let Some((_, asked)) = read
                && self.waiting.len() < WAITING
            {
                self.waiting.push((request, asked));
            }
        }
        self.take_drawn(bus);
        let (steps, now_ns) = (painting.work().0, bus.now_ns());
        if steps != self.work.0 {
            self.work = (steps, now_ns);
        }
        let rests = now_ns >= self.work.1 + REST_NS;
        for (request, asked) in std::mem::take(&mut self.waiting) {
            let reply = match Shows::of(painting, &asked) {
                None => no_picture(),
                Some(shows) => match self.kept.iter().find(|(kept, _)| kept.is(&shows)) {
                    Some((_, reply)) => reply.clone(),
                    None => {
                        let may = rests || !matches!(shows.state, State::Step(..));
                        if self.drawing.is_none() && may {
                            self.draw(painting, shows);
                        }
                        self.waiting.push((request, asked));
                        continue;
                    }
                },
            };
            answer(request, &self.me, bus.now_ns(), &reply);
        }
    }

    fn take_drawn(&mut self, bus: &dyn Bus) {
        let Some((shows, drawn)) = self.drawing.take() else {
            return;
        };
        match drawn.try_recv() {
            Ok(reply) => {
                let now = matches!(shows.state, State::Now(_));
                // Of the painting as it is, older pictures are asked for no more.
                self.kept.retain(|(kept, _)| {
                    let older = matches!(kept.state, State::Now(_)) && kept.side == shows.side;
                    !(now && older)
                });
                if self.kept.len() >= KEPT {
                    self.kept.remove(0);
                }
                if now {
                    self.answer_all_of_now(bus, &shows, &reply);
                }
                self.kept.push((shows, reply));
            }
            Err(TryRecvError::Empty) => self.drawing = Some((shows, drawn)),
            Err(TryRecvError::Disconnected) => {
                tracing::error!("a small picture of '{}' cannot be drawn", shows.version);
                // Asked again they would be drawn again.
                self.waiting.clear();
            }
        }
    }

    /// Answers requests for the current painting with its newest picture: while somebody paints, no picture would ever
    /// be the latest.
    fn answer_all_of_now(&mut self, bus: &dyn Bus, shows: &Shows, reply: &ThumbnailReply) {
        let of_it = |asked: &ThumbnailRequest| {
            let side = asked.side.clamp(*SIDES.start(), *SIDES.end());
            asked.version.is_empty() && asked.step.is_none() && side == shows.side
        };
        let (answered, waiting): (Vec<_>, Vec<_>) = std::mem::take(&mut self.waiting)
            .into_iter()
            .partition(|(_, asked)| of_it(asked));
        self.waiting = waiting;
        for (request, _) in answered {
            answer(request, &self.me, bus.now_ns(), reply);
        }
    }

    fn draw(&mut self, painting: &mut Painting, shows: Shows) {
        let (to_node, drawn) = channel();
        let still = match shows.state {
            State::Step([step, _], _) => painting.still_after(step),
            _ => Some(painting.still()),
        };
        let Some(mut still) = still else {
            to_node.send(no_picture()).ok();
            self.drawing = Some((shows, drawn));
            return;
        };
        let (version, side, wake) = (shows.version.clone(), shows.side, self.wake.clone());
        let is_step = matches!(shows.state, State::Step(..));
        let of_steps = Arc::clone(&self.of_steps);
        let work = move || {
            if !version.is_empty() && still.show_version(&version).is_err() {
                return;
            }
            let side = side as usize;
            let picture = if is_step {
                let mut of_steps = of_steps.lock().unwrap_or_else(PoisonError::into_inner);
                of_steps.draw(&mut still, CANVAS, side)
            } else {
                small_picture(&mut still, CANVAS, side)
            };
            let Some(picture) = picture else {
                return;
            };
            let reply = ThumbnailReply {
                width: picture.width as u32,
                height: picture.height as u32,
                rgb: picture.rgb.into(),
                version: still.versions(),
            };
            to_node.send(reply).ok();
            wake.ring();
        };
        self.drawing = try_start("thumbnail", work).map(|_| (shows, drawn));
    }
}
