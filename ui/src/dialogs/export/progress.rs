//! Progress and end of an export.

use std::path::Path;

use eframe::egui::{Align2, Area, Context, Frame, Id, Order, ProgressBar};
use maulstick_types::command::FileCommand;
use maulstick_types::paint::ExportStatus;

use crate::dialogs::paths;
use crate::sessions::transport_bar;
use crate::widgets::context::PanelContext;

/// An export that lasts no longer than this is not worth a word, ns.
const SHORT_NS: u64 = 500_000_000;
/// Progress below which the time left cannot be estimated.
const KNOWN: f32 = 0.02;

/// Distance from the lower edge, points.
const ABOVE: f32 = 48.0;

/// Time left, in words; empty while it cannot be estimated.
fn left(export: &ExportStatus) -> String {
    if !(KNOWN..=1.0).contains(&export.share) {
        return String::new();
    }
    let seconds = export.since_ns as f64 * 1e-9;
    let left = (seconds * f64::from((1.0 - export.share) / export.share)).ceil();
    match left {
        left if left < 60.0 => tr!("{left} s left", left = format_args!("{left:.0}")),
        left => tr!(
            "{minutes} min left",
            minutes = format_args!("{:.0}", (left / 60.0).ceil())
        ),
    }
}

/// Shows it at the lower edge.
pub(crate) fn show(context: &Context, work: &mut PanelContext<'_>) {
    let status = work.rig.live.paint.as_ref().map(|node| &node.status);
    let export = status.and_then(|status| status.export.clone());
    let Some(export) = export.filter(|export| export.since_ns >= SHORT_NS) else {
        return;
    };
    let above = if work.rig.replay.is_some() {
        transport_bar::OVER
    } else {
        ABOVE
    };
    Area::new(Id::unique("exporting"))
        .order(Order::Foreground)
        .anchor(Align2::CENTER_BOTTOM, [0.0, -above])
        .show(context, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.horizontal(|ui| {
                    let name = paths::name(Path::new(&export.path));
                    ui.label(tr!("Exporting {name}", name));
                    let bar = ProgressBar::new(export.share).desired_width(140.0);
                    ui.add(bar.show_percentage());
                    ui.label(left(&export));
                    if ui.button(tr!("Stop")).clicked() {
                        work.requests.send(FileCommand::StopExport);
                    }
                });
            });
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_the_rest() {
        let export = |share: f32, seconds: u64| ExportStatus {
            path: "/a.png".to_owned(),
            share,
            since_ns: seconds * 1_000_000_000,
        };
        assert_eq!(left(&export(0.25, 10)), "30 s left");
        assert_eq!(left(&export(0.5, 100)), "2 min left");
        assert_eq!(left(&export(0.0, 10)), "");
        assert_eq!(left(&export(f32::NAN, 10)), "");
    }
}
