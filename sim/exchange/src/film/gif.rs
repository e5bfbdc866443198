//! Films as GIF: each frame contains the changes, with its own palette.

use std::borrow::Cow;
use std::io::{Error, Write};

use gif::{DisposalMethod, Encoder, Frame, Repeat};

use super::palette::Palette;

/// Writer of a film as a GIF.
pub struct GifFilm<W: Write> {
    encoder: Encoder<W>,
    size: [usize; 2],
    /// The newest frame, sRGB.
    shown: Vec<[u8; 3]>,
    /// Changed part of the newest frame, until its duration is known.
    waiting: Option<Frame<'static>>,
}

fn failed(error: gif::EncodingError) -> Error {
    match error {
        gif::EncodingError::Io(error) => error,
        other => Error::other(other),
    }
}

impl<W: Write> GifFilm<W> {
    /// A film of frames of `size` pixels, across and down, which repeats.
    ///
    /// # Errors
    /// The error of `to`, or for more than 65,535 pixels either way.
    pub fn new(to: W, size: [usize; 2]) -> Result<Self, Error> {
        let [width, height] = [u16::try_from(size[0]), u16::try_from(size[1])];
        let (width, height) = (width.map_err(Error::other)?, height.map_err(Error::other)?);
        let mut encoder = Encoder::new(to, width, height, &[]).map_err(failed)?;
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        Ok(Self {
            encoder,
            size,
            shown: Vec::new(),
            waiting: None,
        })
    }

    /// Adds a frame, sRGB, with its duration, 1/100 s.
    ///
    /// # Errors
    /// The error of the file.
    pub fn add(&mut self, rgb: &[u8], time: u16) -> Result<(), Error> {
        let (pixels, _) = rgb.as_chunks::<3>();
        if self.shown == pixels
            && let Some(frame) = &mut self.waiting
            && let Some(sum) = frame.delay.checked_add(time)
        {
            frame.delay = sum;
            return Ok(());
        }
        self.flush()?;
        let mut frame = self.changed(pixels);
        frame.delay = time;
        self.waiting = Some(frame);
        self.shown = pixels.to_vec();
        Ok(())
    }

    /// The smallest rectangle in which a frame differs from the current one.
    fn changed(&self, pixels: &[[u8; 3]]) -> Frame<'static> {
        let [width, height] = self.size;
        let is_new = |x: usize, y: usize| {
            let at = y * width + x;
            self.shown.get(at) != pixels.get(at)
        };
        let rows = (0..height).filter(|y| (0..width).any(|x| is_new(x, *y)));
        let rows: Vec<usize> = rows.collect();
        let (top, bottom) = match (rows.first(), rows.last()) {
            (Some(top), Some(bottom)) => (*top, *bottom),
            _ => (0, 0),
        };
        let is_new = |x: &usize| (top..=bottom).any(|y| is_new(*x, y));
        let left = (0..width).find(is_new).unwrap_or(0);
        let right = (0..width).rev().find(is_new).unwrap_or(0);
        let lines = pixels.chunks_exact(width).take(bottom + 1).skip(top);
        let part: Vec<[u8; 3]> = lines
            .flat_map(|line| &line[left..=right])
            .copied()
            .collect();
        let mut palette = Palette::of(&part);
        let across = right + 1 - left;
        let places = part.iter().enumerate();
        let places = places.map(|(i, pixel)| {
            let at = [left + i % across, top + i / across];
            palette.place(*pixel, at)
        });
        let buffer = Cow::Owned(places.collect());
        Frame {
            dispose: DisposalMethod::Keep,
            left: left as u16,
            top: top as u16,
            width: across as u16,
            height: (bottom + 1 - top) as u16,
            palette: Some(palette.bytes()),
            buffer,
            ..Frame::default()
        }
    }

    fn flush(&mut self) -> Result<(), Error> {
        match self.waiting.take() {
            Some(frame) => self.encoder.write_frame(&frame).map_err(failed),
            None => Ok(()),
        }
    }

    /// Writes the last frame and the end of the file.
    ///
    /// # Errors
    /// The error of the file.
    pub fn end(mut self) -> Result<(), Error> {
        self.flush()?;
        self.encoder.into_inner().map(drop).map_err(failed)
    }
}

impl<W: Write> std::fmt::Debug for GifFilm<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GifFilm")
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_holds_changes_and_their_times() {
        let size = [40, 30];
        let blank = vec![200u8; 3 * 40 * 30];
        let mut dot = blank.clone();
        for (x, y) in [(5, 7), (9, 12)] {
            dot[3 * (40 * y + x)..][..3].copy_from_slice(&[10, 20, 30]);
        }
        let mut file = Vec::new();
        let mut film = GifFilm::new(&mut file, size).expect("begun");
        for (frame, time) in [
            (&blank, 3),
            (&blank, 4),
            (&dot, 3),
            (&blank, 60_000),
            (&blank, 9_000),
        ] {
            film.add(frame, time).expect("added");
        }
        film.end().expect("written");

        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).expect("a GIF");
        let mut frames = Vec::new();
        let mut canvas = vec![0u8; 3 * 40 * 30];
        while let Some(frame) = decoder.read_next_frame().expect("whole") {
            for (i, pixel) in frame.buffer.chunks_exact(4).enumerate() {
                let across = usize::from(frame.width);
                let at = [
                    usize::from(frame.left) + i % across,
                    usize::from(frame.top) + i / across,
                ];
                canvas[3 * (40 * at[1] + at[0])..][..3].copy_from_slice(&pixel[..3]);
            }
            let part = [frame.left, frame.top, frame.width, frame.height];
            frames.push((frame.delay, part, canvas.clone()));
        }
        let expected = [
            (7, [0, 0, 40, 30], blank.clone()),
            (3, [5, 7, 5, 6], dot),
            (60_000, [5, 7, 5, 6], blank.clone()),
            (9_000, [0, 0, 1, 1], blank),
        ];
        assert!(
            frames == expected,
            "{:?}",
            frames.iter().map(|f| (f.0, f.1)).collect::<Vec<_>>()
        );
    }
}
