//! Thumbnails of versions and of the steps of the history, and the thread that fetches them.

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_bus::typed::ask;
use maulstick_bus::{Qos, Wake};
use maulstick_rig::NodeHandle;
use maulstick_rig::thread::try_start;
use maulstick_types::paint::{ThumbnailReply, ThumbnailRequest};

/// Longer side of a version's small picture, pixels, and how long one may take.
const THUMBNAIL: u32 = 128;
const FETCH: Duration = Duration::from_secs(1);
/// Delay before a picture that could not be fetched is requested again, ns.
const AGAIN_NS: u64 = 5_000_000_000;

/// A small picture: sRGB, three bytes a pixel, rows from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// `3 · across · down` bytes.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// A picture; `None` if the number of bytes does not match its pixels.
    #[must_use]
    pub fn new(size: [usize; 2], rgb: Vec<u8>) -> Option<Self> {
        let bytes = size[0].checked_mul(size[1])?.checked_mul(3)?;
        (bytes > 0 && rgb.len() == bytes).then_some(Self { size, rgb })
    }
}

/// What a picture shows.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pictured {
    /// The version of this name.
    Version(String),
    /// The painting after the step of this number, 0 for before all steps.
    Step(u64),
}

impl From<&str> for Pictured {
    fn from(version: &str) -> Self {
        Self::Version(version.to_owned())
    }
}

/// State of one picture.
#[derive(Clone, Debug)]
enum Known {
    /// To be requested.
    Wanted,
    /// Requested.
    Asked,
    /// It is here.
    Here(Arc<Picture>),
    /// Could not be fetched; not requested again before this time, rig clock, ns.
    Missing(u64),
}

/// The small pictures that the window has.
#[derive(Clone, Debug, Default)]
pub struct Thumbnails {
    known: BTreeMap<Pictured, Known>,
}

impl Thumbnails {
    /// A picture; a missing one is requested.
    pub fn of(&mut self, what: impl Into<Pictured>, now_ns: u64) -> Option<Arc<Picture>> {
        let what = what.into();
        match self.known.get(&what) {
            Some(Known::Here(picture)) => return Some(Arc::clone(picture)),
            Some(Known::Wanted | Known::Asked) => return None,
            Some(Known::Missing(until_ns)) if now_ns < *until_ns => return None,
            Some(Known::Missing(_)) | None => {}
        }
        self.known.insert(what, Known::Wanted);
        None
    }

    /// Forgets all pictures but these: a name may be given to another version.
    pub fn keep(&mut self, shown: &[Pictured]) {
        self.known.retain(|what, _| shown.contains(what));
    }

    /// Takes what is to be requested.
    fn wanted(&mut self) -> Vec<Pictured> {
        let mut wanted = Vec::new();
        for (what, known) in &mut self.known {
            if matches!(known, Known::Wanted) {
                *known = Known::Asked;
                wanted.push(what.clone());
            }
        }
        // Of steps the newest ones are looked at first.
        wanted.sort_by_key(|what| match what {
            Pictured::Version(_) => 0,
            Pictured::Step(id) => u64::MAX - id,
        });
        wanted
    }

    /// Takes in what came of a question.
    pub fn came(&mut self, what: impl Into<Pictured>, picture: Option<Picture>, now_ns: u64) {
        // The version may have been deleted meanwhile.
        if let Some(known) = self.known.get_mut(&what.into()) {
            *known = match picture {
                Some(picture) => Known::Here(Arc::new(picture)),
                None => Known::Missing(now_ns + AGAIN_NS),
            };
        }
    }
}

type Answers = Arc<Mutex<Vec<(Pictured, Option<Picture>)>>>;

/// Asks for small pictures on a thread of its own, one after the other.
#[derive(Debug)]
pub struct ThumbnailFetcher {
    questions: Option<Sender<Pictured>>,
    answers: Answers,
    thread: Option<JoinHandle<()>>,
}

impl ThumbnailFetcher {
    /// A fetcher of versions and steps from the paint node.
    #[must_use]
    pub fn of_rig(member: &NodeHandle) -> Self {
        let (bus, topic) = (Arc::clone(&member.bus), member.topics.thumbnail());
        let me = member.origin("ui");
        let fetch = move |what: &Pictured| {
            let (version, step) = match what {
                Pictured::Version(name) => (name.clone(), None),
                Pictured::Step(step) => (String::new(), Some(*step)),
            };
            let request = ThumbnailRequest {
                version,
                side: THUMBNAIL,
                step,
            };
            let reply = ask(&*bus, &topic, Qos::Data, me, &request, FETCH).ok()?;
            let ThumbnailReply {
                width, height, rgb, ..
            } = reply;
            Picture::new([width as usize, height as usize], rgb.into_vec())
        };
        Self::new(fetch, &member.wake)
    }

    /// A fetcher that asks by `fetch`, which may take its time, and rings `wake` at each answer.
    #[must_use]
    pub fn new(fetch: impl Fn(&Pictured) -> Option<Picture> + Send + 'static, wake: &Wake) -> Self {
        let (questions, asked): (Sender<Pictured>, Receiver<Pictured>) = channel();
        let answers = Answers::default();
        let (out, wake) = (Arc::clone(&answers), wake.clone());
        let run = move || {
            for what in asked {
                let picture = fetch(&what);
                out.lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .push((what, picture));
                wake.ring();
            }
        };
        Self {
            questions: Some(questions),
            answers,
            thread: try_start("thumbnails", run),
        }
    }

    /// Asks for what is wanted and brings what has come.
    pub fn exchange(&self, thumbnails: &mut Thumbnails, now_ns: u64) {
        let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        for (what, picture) in answers.drain(..) {
            thumbnails.came(what, picture, now_ns);
        }
        for what in thumbnails.wanted() {
            if let Some(questions) = &self.questions {
                questions.send(what).ok();
            }
        }
    }
}

impl Drop for ThumbnailFetcher {
    fn drop(&mut self) {
        self.questions = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATIENCE: Duration = Duration::from_secs(20);

    fn picture(value: u8) -> Picture {
        Picture::new([2, 1], vec![value; 6]).expect("six bytes")
    }

    #[test]
    fn each_picture_is_asked_for_once_and_a_missing_one_later_again() {
        let wake = Wake::new();
        let fetch = |what: &Pictured| (*what == "sketch".into()).then(|| picture(7));
        let fetcher = ThumbnailFetcher::new(fetch, &wake);
        let mut thumbnails = Thumbnails::default();
        let mut asked = 0;
        for name in ["sketch", "gone", "sketch"] {
            assert_eq!(thumbnails.of(name, 0), None);
        }
        fetcher.exchange(&mut thumbnails, 0);
        assert!(thumbnails.wanted().is_empty(), "both were asked for");
        while thumbnails.of("sketch", 0).is_none()
            || matches!(thumbnails.known.get(&"gone".into()), Some(Known::Asked))
        {
            assert!(wake.wait(PATIENCE), "no answer");
            fetcher.exchange(&mut thumbnails, 0);
            asked += 1;
        }
        assert!(asked <= 2);
        assert_eq!(thumbnails.of("sketch", 1).as_deref(), Some(&picture(7)));
        assert_eq!(thumbnails.of("gone", AGAIN_NS - 1), None);
        assert!(thumbnails.wanted().is_empty());
        assert_eq!(thumbnails.of("gone", AGAIN_NS), None);
        assert_eq!(thumbnails.wanted(), ["gone".into()]);
    }

    #[test]
    fn the_newest_step_is_pictured_first() {
        let mut thumbnails = Thumbnails::default();
        for step in [3, 12, 7] {
            assert!(thumbnails.of(Pictured::Step(step), 0).is_none());
        }
        assert_eq!(thumbnails.wanted(), [12, 7, 3].map(Pictured::Step));
        thumbnails.keep(&[Pictured::Step(7)]);
        assert!(thumbnails.of(Pictured::Step(12), 0).is_none());
        assert_eq!(
            thumbnails.wanted(),
            [Pictured::Step(12)],
            "it was forgotten"
        );
    }

    #[test]
    fn a_name_that_is_used_again_has_another_picture() {
        let mut thumbnails = Thumbnails::default();
        assert!(thumbnails.of("one", 0).is_none());
        thumbnails.came("one", Some(picture(1)), 0);
        assert!(thumbnails.of("one", 0).is_some());
        thumbnails.keep(&["two".into()]);
        thumbnails.came("one", Some(picture(2)), 0);
        assert_eq!(thumbnails.of("one", 0), None, "nobody wanted that one");
        assert_eq!(thumbnails.wanted(), ["one".into()]);
    }

    #[test]
    fn a_picture_has_as_many_bytes_as_its_pixels_take() {
        assert_eq!(Picture::new([2, 2], vec![0; 11]), None);
        assert_eq!(Picture::new([0, 2], Vec::new()), None);
        assert_eq!(Picture::new([usize::MAX, 2], vec![0; 6]), None);
        assert!(Picture::new([2, 2], vec![0; 12]).is_some());
    }
}
