//! Benchmarks of Maulstick and of its peers.
//!
//! | module | area |
//! | --- | --- |
//! | [`brush`] | `brush`: the solver of the spines compared with slsqp, a head, its strips |
//! | [`bus`] | `bus`: a sample from a device to the brush node, compared with a bare zenoh put |
//! | [`document`] | `document`: vast canvases, long histories, opening and packing a painting's file |
//! | [`frames`] | `frames`: a reply to a view through shared memory, compared with the socket |
//! | [`haptics`] | `haptics`: the servo's lateness compared with cyclictest, time of a tick, stability |
//! | [`header`] | headers of a brush's states |
//! | [`idle`] | `idle`: load of an idle rig |
//! | [`latency`] | `latency`: from a stylus sample to the first frame that holds it, without a window, in one, and of a broad brush |
//! | [`looks`] | `looks`: films, relief and streaks of strokes |
//! | [`measurements`] | tables of measurements (`docs/measurements`) |
//! | [`optics`] | `optics`: colours of few wavelengths compared with all; films on both backends compared with a copy |
//! | [`paint`] | `paint`: steps of the paint model alone, compared with a copy |
//! | [`pen`] | `pen`: a pen's sample to the brush node, through the window and through the HID daemon |
//! | [`recording`] | `recording`: a recording of ten minutes, opened and sought in, compared with the `mcap` crate's reader |
//! | [`render`] | `render`: the 30 s recording, offline |
//! | [`report`] | rows and their table |
//! | [`tails`] | `render`: work besides the steps, as shares |
//! | [`thread_cpu`] | time of the processor |
//! | [`view`] | `view`: frames of the whole desk without a window |
//! | [`window`] | `window`: memory of the window |

mod brush;
mod bus;
mod document;
mod frames;
mod haptics;
mod header;
mod idle;
mod latency;
mod looks;
mod measurements;
mod optics;
mod paint;
mod peers;
mod pen;
mod recording;
mod render;
mod report;
mod running;
mod tails;
mod thread_cpu;
mod view;
mod window;

use clap::Parser;
use maulstick_models::MODELS;
use maulstick_rig::UserError;
use maulstick_tool_options::bench::{BACKEND, BenchGroup, BenchOptions};

use crate::measurements::Measurements;
use crate::report::Report;

/// Benchmarks of Maulstick and of its peers
#[derive(Parser)]
#[command(name = "maulstick", version)]
struct Line {
    #[command(subcommand)]
    command: BenchGroup,
}

/// An area's name and what measures it.
type Area = (
    &'static str,
    fn(&mut Report, &BenchOptions) -> Result<(), UserError>,
);

const AREAS: [Area; 15] = [
    ("brush", |report, _| brush::run(report)),
    ("bus", |report, _| bus::run(report)),
    ("document", |report, _| document::run(report)),
    ("frames", |report, _| frames::run(report)),
    ("haptics", |report, _| haptics::run(report)),
    ("idle", |report, _| idle::run(report)),
    ("latency", |report, _| latency::run(report)),
    ("looks", |report, _| looks::run(report)),
    ("optics", |report, _| optics::run(report)),
    ("paint", |report, options| {
        paint::run(report, &options.backend, &options.model)
    }),
    ("pen", |report, _| pen::run(report)),
    ("recording", |report, _| recording::run(report)),
    ("render", |report, options| {
        render::run(report, &options.model)
    }),
    ("view", |report, _| view::run(report)),
    ("window", |report, _| window::run(report)),
];

fn main() {
    let BenchGroup::Bench(options) = Line::parse().command;
    if let Err(fault) = measure(&options) {
        eprintln!("{fault}");
        std::process::exit(fault.code);
    }
}

fn measure(options: &BenchOptions) -> Result<(), UserError> {
    if let Some(locator) = &options.far_end {
        return bus::far_end(locator);
    }
    if let Some(pen) = &options.pen {
        return pen::send(pen);
    }
    let wanted = |name: &str| options.area.as_deref().is_none_or(|area| area == name);
    let areas: Vec<&Area> = AREAS.iter().filter(|(name, _)| wanted(name)).collect();
    if let (true, Some(area)) = (areas.is_empty(), &options.area) {
        let names = AREAS.map(|(name, _)| name);
        let what = format!("there is no benchmark called '{area}'");
        return Err(UserError::unknown(what, area, names));
    }
    let table = options.csv.as_deref().map(Measurements::open).transpose()?;
    let mut report = Report::new();
    for (area, run) in areas {
        report.begin(command(area, options));
        run(&mut report, options)?;
    }
    if let Some(mut table) = table {
        let today = jiff::Zoned::now().date().to_string();
        table.append(&report.records(&today))?;
    }
    if options.json {
        report.print_json()
    } else {
        report.print_table()
    }
}

/// The command that measures an area in the same way.
fn command(area: &str, options: &BenchOptions) -> String {
    let mut command = format!("maulstick bench {area}");
    if options.model != MODELS[0].name {
        command += &format!(" --model {}", options.model);
    }
    if options.backend != BACKEND {
        command += &format!(" --backend {}", options.backend);
    }
    command
}
