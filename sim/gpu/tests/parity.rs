//! Both backends compared with plain f64 films.

mod support;

use maulstick_gpu::{Choice, Device, GpuError, GpuFilms};
use maulstick_optics::backend::{CpuFilms, FilmBackend};
use maulstick_optics::studio::{RuleKind, StudioSettings};
use maulstick_optics::{BackendError, Studio};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use support::{Film, as_tiles, off, studio, unit};

/// Greatest difference of linear sRGB, and of internal reflectance. f32 has 6e-8 at 1; the surface
/// makes of an error near white, (1−k₁)/(1−k₂), nearly three times as much.
const TOLERANCE: [f64; 2] = [4e-6, 1.5e-6];

fn device() -> Device {
    let device = Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does");
    println!("adapter: {}, a cpu: {}", device.name(), device.is_cpu());
    device
}

fn backends() -> Vec<Box<dyn FilmBackend>> {
    let gpu = GpuFilms::new(device()).expect("taken");
    vec![Box::new(CpuFilms::new()), Box::new(gpu)]
}

/// Films of 0 to 28 paints, up to 200 µm and up to 25 mm thick, over planes and over even grounds.
fn scene(studio: &Studio, seed: u64) -> Vec<Film> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut films = Vec::new();
    for paints in [0, 1, 2, 3, 4, 5, 7, 8, 11, 16, 28] {
        for (most_m, planes) in [(2e-4, true), (2e-4, false), (0.025, true)] {
            films.push(Film::random(&mut random, studio, paints, most_m, planes));
        }
    }
    films
}

fn within(off: [f64; 2]) -> bool {
    off[0] <= TOLERANCE[0] && off[1] <= TOLERANCE[1]
}

#[test]
fn both_backends_are_the_plain_films() {
    for (rule, samples) in [
        (RuleKind::Gauss, 8),
        (RuleKind::Fitted, 13),
        (RuleKind::Fitted, 16),
        (RuleKind::Reference, 101),
    ] {
        let studio = studio(rule, samples);
        let films = scene(&studio.0, samples as u64);
        for backend in &mut backends() {
            let off = off(&mut **backend, &studio, &films, &films);
            println!("{} samples, {}: {off:?}", samples, backend.name());
            assert!(within(off), "{off:?}");
        }
    }
}

#[test]
fn a_fault_would_be_found() {
    let right = studio(RuleKind::Fitted, 16);
    let films = scene(&right.0, 5);
    let fault = |films: &[Film], change: &dyn Fn(&mut Film)| -> Vec<Film> {
        let mut told = films.to_vec();
        told.iter_mut().for_each(change);
        told
    };
    let opacity = fault(&films, &|film| film.opacity *= 1.001);
    let one_cell = fault(&films[1..2], &|film| film.under[0] += 1e-4);
    let one_paint = fault(&films, &|film| {
        if let Some((_, plane)) = film.paints.last_mut() {
            plane.iter_mut().for_each(|d| *d *= 1.01);
        }
    });
    for backend in &mut backends() {
        for (told, films) in [
            (&opacity, &films[..]),
            (&one_cell, &films[1..2]),
            (&one_paint, &films[..]),
        ] {
            let off = off(&mut **backend, &right, told, films);
            assert!(!within(off), "a fault would pass: {off:?}");
        }
    }
}

#[test]
fn a_paint_whose_absorption_is_off_by_a_hundredth_is_found() {
    let settings = StudioSettings::default();
    let mut library = maulstick_optics::PaintLibrary::measured()
        .expect("whole")
        .paints()
        .to_vec();
    let made = |paints: &[maulstick_optics::Paint], rule_of: &[maulstick_optics::Paint]| {
        let mut studio = Studio::new(&settings, rule_of);
        paints[..4].iter().for_each(|paint| {
            studio.add(paint);
        });
        studio
    };
    let rule_of = library.clone();
    let right = made(&library, &rule_of);
    library[2].k.0.iter_mut().for_each(|k| *k *= 1.01);
    let wrong = made(&library, &rule_of);
    let mut random = Pcg64::seed_from_u64(9);
    let films = [Film::random(&mut random, &right, 4, 2e-4, false)];
    for backend in &mut backends() {
        let told_wrong = as_tiles(&films, |tiles| backend.shade(&wrong, tiles)).expect("shaded");
        let told_right = as_tiles(&films, |tiles| backend.shade(&right, tiles)).expect("shaded");
        let farthest = |rgb: &[Vec<f32>; 3]| {
            let mut worst = 0.0f64;
            for cell in (0..rgb[0].len()).step_by(support::STRIDE) {
                let exact = films[0].rgb(&right, &settings, cell);
                for (got, exact) in rgb.iter().zip(exact) {
                    worst = worst.max((f64::from(got[cell]) - exact).abs());
                }
            }
            worst
        };
        assert!(farthest(&told_right[0]) <= TOLERANCE[0]);
        let fault = farthest(&told_wrong[0]);
        assert!(fault > TOLERANCE[0], "a fault would pass: {fault:e}");
    }
}

#[test]
fn a_batch_larger_than_its_buffers_is_cut() {
    let studio = studio(RuleKind::Fitted, 8);
    let films = scene(&studio.0, 11);
    let mut whole = GpuFilms::new(device()).expect("taken");
    let (shaded, baked) = as_tiles(&films, |tiles| {
        let shaded = whole.shade(&studio.0, tiles).expect("shaded");
        (shaded, whole.bake(&studio.0, tiles).expect("baked"))
    });
    for buffer_bytes in [1, 300 << 10] {
        let mut cut = GpuFilms::with_buffers(device(), buffer_bytes).expect("taken");
        as_tiles(&films, |tiles| {
            assert!(cut.shade(&studio.0, tiles).expect("shaded") == shaded);
            assert!(cut.bake(&studio.0, tiles).expect("baked") == baked);
            assert!(cut.shade(&studio.0, &[]).expect("none").is_empty());
        });
    }
}

#[test]
fn films_after_others_are_their_own() {
    let (eight, sixteen) = (studio(RuleKind::Gauss, 8), studio(RuleKind::Fitted, 16));
    let mut random = Pcg64::seed_from_u64(1);
    let mut gpu = GpuFilms::new(device()).expect("taken");
    for turn in 0..6 {
        let studio = if turn % 2 == 0 { &eight } else { &sixteen };
        let count = 1 + (5.0 * unit(&mut random)) as usize;
        let film = |random: &mut Pcg64, i| Film::random(random, &studio.0, i, 1e-4, i % 2 == 0);
        let films: Vec<Film> = (0..count).map(|i| film(&mut random, i)).collect();
        assert!(within(off(&mut gpu, studio, &films, &films)), "turn {turn}");
    }
}

#[test]
fn a_lost_device_is_an_error_and_stays_one() {
    let studio = studio(RuleKind::Gauss, 8);
    let films = scene(&studio.0, 2);
    let mut gpu = GpuFilms::new(device()).expect("taken");
    as_tiles(&films, |tiles| {
        gpu.shade(&studio.0, tiles).expect("shaded");
        gpu.device().device.destroy();
        for _ in 0..2 {
            let error = gpu.shade(&studio.0, tiles).expect_err("lost");
            println!("{error}");
            let BackendError::Device(error) = error else {
                panic!("{error}");
            };
            let error = error.downcast_ref::<GpuError>();
            assert!(matches!(error, Some(GpuError::Lost(_))), "{error:?}");
            assert!(gpu.bake(&studio.0, tiles).is_err());
        }
        assert!(CpuFilms::new().shade(&studio.0, tiles).is_ok());
    });
}

#[test]
fn what_a_driver_refuses_is_an_error() {
    let gpu = device();
    let too_large = || {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 1 << 60,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    let refused = gpu.guarded(|| {
        drop(too_large());
        Ok(())
    });
    println!("{refused:?}");
    assert!(refused.is_err());
    // An error without a waiter is reported at the next call, once.
    drop(too_large());
    assert!(gpu.guarded(|| Ok(())).is_err());
    assert_eq!(gpu.guarded(|| Ok(7)), Ok(7));
}

#[test]
fn an_emulated_adapter_must_be_forced() {
    match Device::open(Choice::Auto) {
        Ok(device) => assert!(!device.is_cpu(), "{}", device.name()),
        Err(GpuError::None(_)) => {
            let forced = Device::open(Choice::Forced).expect("lavapipe at the least");
            assert!(forced.is_cpu(), "{} would have done", forced.name());
        }
        Err(error) => panic!("{error}"),
    }
}
