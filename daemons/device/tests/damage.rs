//! Damaged takes: whatever byte is wrong, a reader tells it, keeps what it can, and allocates little.

mod counting;

use std::path::PathBuf;

use maulstick_device::salvage::{Salvage, salvage};
use maulstick_device::{Take, TakeSample, TakeSetup};
use maulstick_types::stylus::{StylusPose, StylusSample};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

const PERIOD_NS: u64 = 8_000_000;

/// A take of a pen that goes round, `count` samples, 8 ms apart.
fn take(count: u64) -> Take {
    let mut setup = TakeSetup::default();
    setup.add(b"paint".to_vec(), "csv");
    setup.settings = setup.add(b"[canvas]".to_vec(), "toml");
    setup.loads = vec!["Ultramarine Blue".into(), "Titanium White".into()];
    let mut random = Pcg32::new(7, 1);
    let mut tremor = || f64::from(random.next_u32()) * 1e-13;
    let sample = |i: u64| {
        let (x, y) = (tremor() + 1e-4 * i as f64, tremor());
        TakeSample {
            time_ns: i * PERIOD_NS,
            sample: StylusSample {
                pose: StylusPose::Contact {
                    point_m: [x, y, 0.0],
                    tilt_rad: [0.1, -0.2],
                    twist_rad: 0.0,
                    pressure: 0.5,
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    };
    Take {
        device: "pen".into(),
        samples: (0..count).map(sample).collect(),
        setup: Some(setup),
    }
}

struct Desk {
    folder: tempfile::TempDir,
    whole: Vec<u8>,
    take: Take,
}

impl Desk {
    fn new(count: u64) -> Self {
        let (folder, take) = (tempfile::tempdir().expect("a folder"), take(count));
        let path = folder.path().join("a.mcap");
        take.write(&path).expect("written");
        let whole = std::fs::read(&path).expect("read");
        Self {
            folder,
            whole,
            take,
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("b.mcap")
    }

    /// The file with other bytes.
    fn with(&self, bytes: &[u8]) -> PathBuf {
        std::fs::write(self.path(), bytes).expect("written");
        self.path()
    }

    /// Samples of a salvage that are those of the take at their time.
    fn right(&self, salvage: &Salvage) -> usize {
        let at = |sample: &TakeSample| self.take.samples.get((sample.time_ns / PERIOD_NS) as usize);
        let samples = salvage.take.samples.iter();
        samples.filter(|sample| at(sample) == Some(sample)).count()
    }
}

/// Flips bits of a take in strides.
fn is_told_or_harmless(stride: usize) {
    let desk = Desk::new(12);
    let (mut refused, mut lost, mut wrong) = (0, 0, 0);
    for bit in (0..8 * desk.whole.len()).step_by(stride) {
        let mut bytes = desk.whole.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        let path = desk.with(&bytes);
        let mut both = None;
        let most = counting::largest(|| both = Some((Take::read(&path), salvage(&path))));
        assert!(
            most <= 2 * bytes.len() + (2 << 20),
            "bit {bit}: {most} bytes"
        );
        let (read, salvaged) = both.expect("read");
        match read {
            Ok(take) => assert_eq!(take, desk.take, "bit {bit}: another take"),
            Err(fault) => {
                refused += 1;
                let said = fault.to_string();
                assert!(
                    said.contains("b.mcap") && said.contains("help"),
                    "{bit}: {said}"
                );
            }
        }
        match salvaged {
            Ok(salvage) => wrong += usize::from(desk.right(&salvage) < salvage.take.samples.len()),
            Err(_) => lost += 1,
        }
    }
    println!(
        "{} bits: {refused} told, {lost} lose all, {wrong} keep a sample that is another",
        (8 * desk.whole.len()).div_ceil(stride)
    );
}

/// One or two bits of each byte.
#[test]
fn a_flipped_bit_of_any_byte_is_told_or_harmless_and_no_length_is_believed() {
    is_told_or_harmless(5);
}

#[test]
#[ignore = "long: each bit"]
fn any_flipped_bit_is_told_or_harmless_and_no_length_is_believed() {
    is_told_or_harmless(1);
}

#[test]
fn a_byte_inserted_or_missing_costs_a_chunk() {
    let desk = Desk::new(6000);
    let mut random = Pcg32::new(11, 1);
    let count = desk.take.samples.len();
    let (mut least, mut whole) = (count, 0);
    for turn in 0..300 {
        let mut bytes = desk.whole.clone();
        let at = random.next_u32() as usize % bytes.len();
        match turn % 2 {
            0 => bytes.insert(at, random.next_u32() as u8),
            _ => drop(bytes.remove(at)),
        }
        let salvage = salvage(&desk.with(&bytes)).expect("something is left");
        let right = desk.right(&salvage);
        least = least.min(right);
        whole += usize::from(right == count);
        assert!(
            salvage.damage.is_some() || salvage.take == desk.take,
            "byte {at}"
        );
        assert!(right + 700 > count, "byte {at}: {right} of {count}");
    }
    println!(
        "{} bytes; all samples in {whole} of 300, {least} of {count} at least",
        desk.whole.len()
    );
}

#[test]
fn what_lies_between_damaged_places_is_kept() {
    let desk = Desk::new(6000);
    let mut bytes = desk.whole.clone();
    for share in [5, 4, 3, 2] {
        bytes.insert(desk.whole.len() / share, 0x55);
    }
    let salvage = salvage(&desk.with(&bytes)).expect("something is left");
    assert!(
        salvage
            .damage
            .as_ref()
            .is_some_and(|damage| damage.more > 1)
    );
    assert!(desk.right(&salvage) > 3000, "{}", desk.right(&salvage));
    let times = salvage.take.samples.windows(2);
    assert!(
        times
            .into_iter()
            .all(|two| two[0].time_ns <= two[1].time_ns)
    );
    let path = desk.folder.path().join("c.mcap");
    salvage.take.write(&path).expect("written");
    assert_eq!(Take::read(&path), Ok(salvage.take));
}

#[test]
fn neither_noise_nor_text_is_a_take() {
    let desk = Desk::new(40);
    let mut random = Pcg32::new(3, 1);
    for length in [0, 7, 8, 9, 100, 10_000, 300_000] {
        let noise: Vec<u8> = (0..length).map(|_| random.next_u32() as u8).collect();
        let path = desk.with(&noise);
        let most = counting::largest(|| assert!(salvage(&path).is_err()));
        assert!(most <= 2 * length + (1 << 16));
        let begun = [&desk.whole[..8], &noise].concat();
        assert!(salvage(&desk.with(&begun)).is_err());
    }
}
