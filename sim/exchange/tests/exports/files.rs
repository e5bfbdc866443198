//! Properties of every export.

use std::io::{Cursor, Error, Seek, SeekFrom, Write};

use maulstick_exchange::ExchangeError;
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::support::{EXPORTS, file, painted, speck, stroke};

#[test]
fn the_same_painting_gives_the_same_bytes() {
    let (mut one, mut other, mut more) = (painted(), painted(), painted());
    stroke(&mut more, 4, "Yellow Ochre", [6.0, 10.0]);
    for (name, _) in EXPORTS {
        let first = file(name, &mut one);
        assert!(first == file(name, &mut one), "{name} twice");
        assert!(first == file(name, &mut other), "{name} of a twin");
        assert!(first != file(name, &mut more), "{name}: a fault would pass");
        assert!(
            file(name, &mut speck()) == file(name, &mut speck()),
            "{name} of a speck"
        );
    }
}

#[test]
fn progress_goes_from_nothing_to_all() {
    for (name, write) in EXPORTS {
        let mut heard = Vec::new();
        let mut tell = |done, all| heard.push((done, all));
        write(
            &mut painted(),
            CANVAS,
            &mut Cursor::new(Vec::new()),
            &mut tell,
        )
        .expect("written");
        let all = heard[0].1;
        assert!(all >= 2, "{name} has two bands");
        assert!(
            heard.into_iter().eq((0..=all).map(|done| (done, all))),
            "{name}"
        );
    }
}

#[test]
fn the_palette_is_a_surface_and_a_third_one_is_not() {
    let mut painting = speck();
    for (name, write) in EXPORTS {
        let mut to = Cursor::new(Vec::new());
        write(&mut painting, PALETTE, &mut to, &mut |_, _| {}).expect(name);
        let none = write(&mut painting, 2, &mut to, &mut |_, _| {});
        assert!(matches!(none, Err(ExchangeError::NoSurface(2))), "{name}");
    }
}

/// A disk with room for a number of bytes.
struct Full(Cursor<Vec<u8>>, u64);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0.position() + bytes.len() as u64 > self.1 {
            return Err(Error::other("the disk is full"));
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Full {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn a_full_disk_is_told_wherever_it_is_full() {
    let mut painting = painted();
    for (name, write) in EXPORTS {
        let whole = file(name, &mut painting).len() as u64;
        for room in [0, 60, whole / 2, whole - 1] {
            let mut disk = Full(Cursor::new(Vec::new()), room);
            let error = write(&mut painting, CANVAS, &mut disk, &mut |_, _| {});
            let error = error.expect_err("no room");
            assert!(
                matches!(error, ExchangeError::Write(_) | ExchangeError::OpenExr(_)),
                "{name} {room}: {error}"
            );
        }
        let mut disk = Full(Cursor::new(Vec::new()), whole);
        write(&mut painting, CANVAS, &mut disk, &mut |_, _| {}).expect("room");
    }
}
