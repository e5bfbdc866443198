//! Tiles a second on both backends, each beside a copy of the same bytes, in turn.

use std::hint::black_box;
use std::num::NonZero;
use std::time::Instant;

use maulstick_gpu::{Choice, Device, GpuError, GpuFilms};
use maulstick_optics::backend::{CpuFilms, FilmBackend};
use maulstick_optics::{BackendError, FilmPlanes, Studio};
use maulstick_rig::UserError;

use super::films::{Layer, TILES, studio, tiles};
use crate::report::{Report, quantile, sorted};

/// Pairs of which medians are reported.
const PAIRS: usize = 15;
/// Number of unmeasured pairs before them.
const WARM_UP: usize = 2;
/// Dry layers of the relit painting.
const LAYERS: usize = 10;
/// Times that it is relit.
const RELIT: usize = 3;

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}

/// Seconds that `work` takes.
fn seconds<T>(work: impl FnOnce() -> Result<T, UserError>) -> Result<f64, UserError> {
    let clock = Instant::now();
    black_box(work()?);
    Ok(clock.elapsed().as_secs_f64())
}

/// Tiles a second of ours and of a copy, in turn.
fn in_turn(
    mut ours: impl FnMut() -> Result<(), UserError>,
    mut copy: impl FnMut() -> Result<(), UserError>,
) -> Result<Vec<(f64, f64)>, UserError> {
    let mut pairs = Vec::with_capacity(PAIRS);
    for number in 0..WARM_UP + PAIRS {
        let pair = (seconds(&mut ours)?, seconds(&mut copy)?);
        if number >= WARM_UP {
            pairs.push((TILES as f64 / pair.0, TILES as f64 / pair.1));
        }
    }
    Ok(pairs)
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let studio = studio()?;
    let layer = Layer::random(&studio);
    let paints = layer.paints();
    let tiles = tiles(&paints, &layer.under);
    on_cpu(report, &studio, &tiles, layer.bytes())?;
    let time = relight(&mut CpuFilms::new(), &studio, &layer)?;
    report.row("relight.10_layers", time, "s");
    match Device::open(Choice::Forced) {
        Ok(device) => {
            report.on(device.name());
            on_gpu(report, device, &studio, &tiles, &layer)
        }
        Err(error) => {
            eprintln!("{error}");
            Ok(())
        }
    }
}

fn on_cpu(
    report: &mut Report,
    studio: &Studio,
    tiles: &[FilmPlanes<'_>],
    [read, written]: [usize; 2],
) -> Result<(), UserError> {
    let mut films = CpuFilms::with_threads(NonZero::<usize>::MIN);
    let shade = |films: &mut CpuFilms| films.shade(studio, tiles).map(|_| ()).map_err(fault);
    // A copy reads as much as it writes: half of both moves as many bytes.
    let from = vec![1u8; (read + written) / 2];
    let mut to = vec![0u8; from.len()];
    let pairs = in_turn(
        || shade(&mut films),
        || {
            to.copy_from_slice(black_box(&from));
            black_box(&mut to);
            Ok(())
        },
    )?;
    report.paired("km.cpu.tiles_per_s", "tiles/s", "memcpy", &pairs);
    let mut films = CpuFilms::new();
    let rate = |_| Ok(TILES as f64 / seconds(|| shade(&mut films))?);
    let rates = sorted((0..PAIRS).map(rate).collect::<Result<_, UserError>>()?);
    let median = quantile(&rates, 0.5);
    report.row("km.cpu_threads.tiles_per_s", median, "tiles/s");
    Ok(())
}

fn on_gpu(
    report: &mut Report,
    device: Device,
    studio: &Studio,
    tiles: &[FilmPlanes<'_>],
    layer: &Layer,
) -> Result<(), UserError> {
    let copy = DeviceCopy::new(&device, layer.bytes()).map_err(fault)?;
    let mut films = GpuFilms::new(device).map_err(fault)?;
    let pairs = in_turn(
        || films.shade(studio, tiles).map(|_| ()).map_err(fault),
        || copy.run().map_err(fault),
    )?;
    report.paired("km.gpu.tiles_per_s", "tiles/s", "buffer copy", &pairs);
    let time = relight(&mut films, studio, layer)?;
    report.row("relight.gpu.10_layers", time, "s");
    Ok(())
}

/// Median time of baking all dry layers again, s.
fn relight(films: &mut dyn FilmBackend, studio: &Studio, layer: &Layer) -> Result<f64, UserError> {
    let paints = layer.paints();
    let mut once = |_| {
        seconds(|| {
            let mut under = layer.under.clone();
            for _ in 0..LAYERS {
                let baked: Result<_, BackendError> = films.bake(studio, &tiles(&paints, &under));
                under = baked.map_err(fault)?;
            }
            Ok(under)
        })
    };
    let times = (0..RELIT)
        .map(&mut once)
        .collect::<Result<_, UserError>>()?;
    Ok(quantile(&sorted(times), 0.5))
}

/// The transfers of shading on a device, without shading: the same bytes to it, from buffer to buffer, and back.
struct DeviceCopy {
    device: Device,
    bytes: Vec<u8>,
    from: wgpu::Buffer,
    to: wgpu::Buffer,
    back: wgpu::Buffer,
}

impl DeviceCopy {
    fn new(device: &Device, [read, written]: [usize; 2]) -> Result<Self, GpuError> {
        let buffer = |size: usize, usage| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: size as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let (source, target) = (wgpu::BufferUsages::COPY_SRC, wgpu::BufferUsages::COPY_DST);
        device.guarded(|| {
            Ok(Self {
                bytes: vec![1; read],
                from: buffer(read, source | target),
                to: buffer(read, source | target),
                back: buffer(written, target | wgpu::BufferUsages::MAP_READ),
                device: device.clone(),
            })
        })
    }

    fn run(&self) -> Result<(), GpuError> {
        self.device.guarded(|| {
            let queue = &self.device.queue;
            queue.write_buffer(&self.from, 0, &self.bytes);
            let gpu = &self.device.device;
            let mut encoder = gpu.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&self.from, 0, &self.to, 0, self.from.size());
            encoder.copy_buffer_to_buffer(&self.to, 0, &self.back, 0, self.back.size());
            queue.submit([encoder.finish()]);
            self.back.map_async(wgpu::MapMode::Read, .., |_| {});
            self.device.wait()?;
            let view = self
                .back
                .get_mapped_range(..)
                .map_err(|error| GpuError::Refused(error.to_string()))?;
            black_box(view.to_vec());
            drop(view);
            self.back.unmap();
            Ok(())
        })
    }
}
