//! A painting's surface, on its way into a file.

use maulstick_appearance::bands::Banded;
use maulstick_painting::{Painting, picture};

use crate::ExchangeError;

/// Callback for the progress of an export: steps done, from 0 to all, and all steps.
pub type Progress<'a> = &'a mut dyn FnMut(u64, u64);

/// Counts the steps of an export.
pub(crate) struct Steps<'a> {
    tell: Progress<'a>,
    done: u64,
    all: u64,
}

impl<'a> Steps<'a> {
    /// None of `all` steps done.
    pub(crate) fn new(tell: Progress<'a>, all: usize) -> Self {
        let all = all as u64;
        tell(0, all);
        Self { tell, done: 0, all }
    }

    /// Counts a step as done.
    pub(crate) fn step(&mut self) {
        self.done += 1;
        (self.tell)(self.done, self.all);
    }
}

/// A surface in bands.
pub(crate) fn banded(painting: &mut Painting, surface: u32) -> Result<Banded<'_>, ExchangeError> {
    picture::banded(painting, surface).ok_or(ExchangeError::NoSurface(surface))
}

/// Checks that all pages could be read; otherwise the export lacks paint.
pub(crate) fn check_whole(painting: &Painting) -> Result<(), ExchangeError> {
    match painting.pager().fault() {
        Some(what) => Err(ExchangeError::Damaged(what.to_owned())),
        None => Ok(()),
    }
}
