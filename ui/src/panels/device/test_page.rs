//! A page on which a device is tried: what it senses over the last seconds, and how evenly its samples come.

use eframe::egui::{Context, Grid, Ui, Window, vec2};
use egui_plot::{Legend, Line, Plot, PlotPoints};

use maulstick_client::sample_history::SensedSample;
use maulstick_client::state::Device;

use super::{still, worded};
use crate::rig::state::RigState;

/// Height of a plot, points, and its length, s.
const HEIGHT: f32 = 76.0;
const SHOWN_S: f64 = 5.0;
/// Time between two frames while the page is open.
const FRAME: std::time::Duration = std::time::Duration::from_millis(33);

/// A line of a plot: its name, and its value in a sample.
type Quantity = (&'static str, fn(&SensedSample) -> Option<f64>);

/// Plots with their titles.
const PLOTS: [(&str, &[Quantity]); 3] = [
    (
        tr_noop!("Place, mm"),
        &[
            ("x", |sample| Some(1e3 * sample.place_m[0])),
            ("y", |sample| Some(1e3 * sample.place_m[1])),
            ("z", |sample| Some(1e3 * sample.place_m[2])),
        ],
    ),
    (
        tr_noop!("Pressure"),
        &[("", |sample| sample.pen.map(|(pressure, _)| pressure))],
    ),
    (
        tr_noop!("Tilt, degrees"),
        &[
            ("x", |sample| {
                sample.pen.map(|(_, tilt)| tilt[0].to_degrees())
            }),
            ("y", |sample| {
                sample.pen.map(|(_, tilt)| tilt[1].to_degrees())
            }),
        ],
    ),
];

/// Shows the page of a device; false once it is closed.
pub(super) fn show(context: &Context, name: &str, rig: &RigState) -> bool {
    let mut is_open = true;
    let title = tr!("Test of {device}", device = worded(name));
    Window::new(title)
        .id(eframe::egui::Id::unique("device test"))
        .open(&mut is_open)
        .default_width(420.0)
        .show(context, |ui| match rig.live.devices.get(name) {
            Some(device) => page(ui, device, rig.live.now_ns),
            None => {
                ui.label(tr!("It is not there."));
            }
        });
    context.request_repaint_after(FRAME);
    is_open
}

fn page(ui: &mut Ui, device: &Device, now_ns: u64) {
    let samples = &device.samples;
    let newest = samples.newest(now_ns);
    Grid::new("timing").num_columns(2).show(ui, |ui| {
        let rows = match samples.timing().filter(|_| newest.is_some()) {
            Some(timing) => [
                (tr!("Samples a second"), format!("{:.0}", timing.rate_hz)),
                (tr!("Jitter"), format!("{:.2} ms", timing.jitter_ms)),
                (tr!("Longest gap"), format!("{:.1} ms", timing.longest_ms)),
            ],
            None => [tr!("Samples a second"), tr!("Jitter"), tr!("Longest gap")]
                .map(|word| (word, tr!("silent").to_owned())),
        };
        for (word, value) in rows {
            ui.label(word);
            ui.label(value);
            ui.end_row();
        }
        ui.label(tr!("Switches"));
        ui.label(newest.map_or_else(|| "-".to_owned(), |sample| pressed(sample.switches)));
        ui.end_row();
        ui.label(tr!("In range"));
        ui.label(match newest {
            Some(sample) if sample.in_range => tr!("yes"),
            _ => tr!("no"),
        });
        ui.end_row();
    });
    for (title, quantities) in PLOTS {
        let lines = quantities
            .iter()
            .map(|(name, value)| (*name, samples.line(now_ns, value)));
        let lines: Vec<_> = lines.filter(|(_, line)| !line.is_empty()).collect();
        if lines.is_empty() {
            // It senses nothing of the kind.
            continue;
        }
        ui.small(maulstick_ui_kit::language::translated(title));
        still(ui, Plot::new(title))
            .height(HEIGHT)
            .include_x(-SHOWN_S)
            .include_x(0.0)
            .set_margin_fraction(vec2(0.0, 0.08))
            .show_axes([false, true])
            .legend(Legend::default())
            .show(ui, |plot| {
                for (name, line) in lines {
                    plot.line(Line::new(name, PlotPoints::from(line)));
                }
            });
    }
}

/// Numbers of the switches that are pressed, from 1.
fn pressed(switches: u32) -> String {
    let down = (0..32).filter(|bit| switches & (1 << bit) != 0);
    let numbers: Vec<String> = down.map(|bit| (bit + 1).to_string()).collect();
    if numbers.is_empty() {
        "-".to_owned()
    } else {
        numbers.join(", ")
    }
}
