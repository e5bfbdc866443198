//! Thumbnails of versions, and the thread that fetches them.

use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

use maulstick_bus::Wake;

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

/// The small pictures of versions, by name.
#[derive(Clone, Debug, Default)]
pub struct Thumbnails {
    known: BTreeMap<String, Known>,
}

impl Thumbnails {
    /// The picture of a version; a missing one is requested.
    pub fn of(&mut self, version: &str, now_ns: u64) -> Option<Arc<Picture>> {
        match self.known.get(version) {
            Some(Known::Here(picture)) => return Some(Arc::clone(picture)),
            Some(Known::Wanted | Known::Asked) => return None,
            Some(Known::Missing(until_ns)) if now_ns < *until_ns => return None,
            Some(Known::Missing(_)) | None => {}
        }
        self.known.insert(version.to_owned(), Known::Wanted);
        None
    }

    /// Forgets the pictures of all versions but these: a name may be given to another one.
    pub fn keep<'a>(&mut self, versions: impl IntoIterator<Item = &'a str>) {
        let versions: Vec<&str> = versions.into_iter().collect();
        self.known
            .retain(|name, _| versions.contains(&name.as_str()));
    }

    /// Takes the names to request.
    fn wanted(&mut self) -> Vec<String> {
        let mut names = Vec::new();
        for (name, known) in &mut self.known {
            if matches!(known, Known::Wanted) {
                *known = Known::Asked;
                names.push(name.clone());
            }
        }
        names
    }

    /// Takes in what came of a question.
    pub fn came(&mut self, version: &str, picture: Option<Picture>, now_ns: u64) {
        // The version may have been deleted meanwhile.
        if let Some(known) = self.known.get_mut(version) {
            *known = match picture {
                Some(picture) => Known::Here(Arc::new(picture)),
                None => Known::Missing(now_ns + AGAIN_NS),
            };
        }
    }
}

type Answers = Arc<Mutex<Vec<(String, Option<Picture>)>>>;

/// Asks for small pictures on a thread of its own, one after the other.
#[derive(Debug)]
pub(crate) struct ThumbnailFetcher {
    names: Option<Sender<String>>,
    answers: Answers,
    thread: Option<JoinHandle<()>>,
}

impl ThumbnailFetcher {
    /// A fetcher that asks by `fetch`, which may take its time, and rings `wake` at each answer.
    #[must_use]
    pub(crate) fn new(
        fetch: impl Fn(&str) -> Option<Picture> + Send + 'static,
        wake: &Wake,
    ) -> Self {
        let (names, asked): (Sender<String>, Receiver<String>) = channel();
        let answers = Answers::default();
        let (out, wake) = (Arc::clone(&answers), wake.clone());
        let run = move || {
            for name in asked {
                let picture = fetch(&name);
                out.lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .push((name, picture));
                wake.ring();
            }
        };
        let thread = std::thread::Builder::new()
            .name("thumbnails".into())
            .spawn(run);
        let thread = thread
            .inspect_err(|error| tracing::error!("no thread for small pictures: {error}"))
            .ok();
        Self {
            names: Some(names),
            answers,
            thread,
        }
    }

    /// Asks for what is wanted and brings what has come.
    pub(crate) fn exchange(&self, thumbnails: &mut Thumbnails, now_ns: u64) {
        let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        for (name, picture) in answers.drain(..) {
            thumbnails.came(&name, picture, now_ns);
        }
        for name in thumbnails.wanted() {
            if let Some(names) = &self.names {
                names.send(name).ok();
            }
        }
    }
}

impl Drop for ThumbnailFetcher {
    fn drop(&mut self) {
        self.names = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    const PATIENCE: Duration = Duration::from_secs(20);

    fn picture(value: u8) -> Picture {
        Picture::new([2, 1], vec![value; 6]).expect("six bytes")
    }

    #[test]
    fn each_picture_is_asked_for_once_and_a_missing_one_later_again() {
        let wake = Wake::new();
        let fetch = |name: &str| (name == "sketch").then(|| picture(7));
        let fetcher = ThumbnailFetcher::new(fetch, &wake);
        let mut thumbnails = Thumbnails::default();
        let mut asked = 0;
        for name in ["sketch", "gone", "sketch"] {
            assert_eq!(thumbnails.of(name, 0), None);
        }
        fetcher.exchange(&mut thumbnails, 0);
        assert!(thumbnails.wanted().is_empty(), "both were asked for");
        while thumbnails.of("sketch", 0).is_none()
            || matches!(thumbnails.known.get("gone"), Some(Known::Asked))
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
        assert_eq!(thumbnails.wanted(), ["gone"]);
    }

    #[test]
    fn a_name_that_is_used_again_has_another_picture() {
        let mut thumbnails = Thumbnails::default();
        assert!(thumbnails.of("one", 0).is_none());
        thumbnails.came("one", Some(picture(1)), 0);
        assert!(thumbnails.of("one", 0).is_some());
        thumbnails.keep(["two"]);
        thumbnails.came("one", Some(picture(2)), 0);
        assert_eq!(thumbnails.of("one", 0), None, "nobody wanted that one");
        assert_eq!(thumbnails.wanted(), ["one"]);
    }

    #[test]
    fn a_picture_has_as_many_bytes_as_its_pixels_take() {
        assert_eq!(Picture::new([2, 2], vec![0; 11]), None);
        assert_eq!(Picture::new([0, 2], Vec::new()), None);
        assert_eq!(Picture::new([usize::MAX, 2], vec![0; 6]), None);
        assert!(Picture::new([2, 2], vec![0; 12]).is_some());
    }
}
