//! Timing of the force loop: wake-up latency and duration of a tick.

use eframe::egui::{CollapsingHeader, Ui, vec2};
use egui_plot::{Bar, BarChart, Plot};
use maulstick_types::stylus::StylusStatus;

use super::still;

/// Upper end of the first bin, µs; each further one is twice as far.
const FIRST_US: f64 = 50.0;
/// Height of a histogram, points.
const HEIGHT: f32 = 52.0;

/// Shows it, folded until it is wanted; nothing for a device without such a loop.
pub(super) fn show(ui: &mut Ui, status: &StylusStatus) {
    if status.lateness.is_empty() && status.execution.is_empty() {
        return;
    }
    CollapsingHeader::new(tr!("Loop health"))
        .id_salt("health")
        .show(ui, |ui| {
            let bins = [
                (
                    tr!("Late:"),
                    tr!("How late the loop of the force wakes up"),
                    &status.lateness,
                ),
                (
                    tr!("Tick:"),
                    tr!("Reading, force and writing together"),
                    &status.execution,
                ),
            ];
            for (name, hint, counts) in bins {
                ui.label(format!("{name} {}", worded(counts)))
                    .on_hover_text(hint);
                histogram(ui, name, counts);
            }
            ui.label(tr!(
                "{samples} samples, {dropped} dropped, {strange} strange models",
                samples = status.samples,
                dropped = status.dropped,
                strange = status.foreign_models.saturating_add(status.refused_senders)
            ))
            .on_hover_text(tr!(
                "Dropped: the publisher was behind. Strange: contact models for another device or \
                 brush, or of a program that may not move the hand."
            ));
        });
}

/// The bin that holds the given quantile; `None` if nothing is counted.
fn quantile(counts: &[u64], share: f64) -> Option<usize> {
    let all = counts
        .iter()
        .fold(0u64, |all, count| all.saturating_add(*count));
    let mut left = share * all as f64;
    let end = counts.iter().position(|count| {
        left -= *count as f64;
        left <= 0.0
    });
    end.filter(|_| all > 0)
}

/// Number of a bin among `bins`, in words.
fn bin(place: usize, bins: usize) -> String {
    let time = |place: usize| {
        let us = FIRST_US * 2f64.powi(place.min(60) as i32);
        if us < 1000.0 {
            format!("{us:.0} µs")
        } else {
            format!("{:.1} ms", 1e-3 * us)
        }
    };
    if place + 1 < bins {
        tr!("under {time}", time = time(place))
    } else {
        tr!("over {time}", time = time(place.saturating_sub(1)))
    }
}

/// The median and the 99th percentile, in words.
fn worded(counts: &[u64]) -> String {
    let at = |share: f64| quantile(counts, share).map(|place| bin(place, counts.len()));
    match (at(0.5), at(0.99)) {
        (Some(median), Some(most)) if median == most => format!("99 % {most}"),
        (Some(median), Some(most)) => tr!("half {median}, 99 % {most}", median, most),
        _ => tr!("not known yet").to_owned(),
    }
}

/// Counts on a logarithmic scale, for what is rare is what matters.
fn histogram(ui: &mut Ui, name: &'static str, counts: &[u64]) {
    let height = |count: u64| (1.0 + count as f64).log10();
    let bars = counts.iter().enumerate().map(|(place, count)| {
        let words = format!("{}: {count}", bin(place, counts.len()));
        Bar::new(place as f64, height(*count))
            .width(0.8)
            .name(words)
    });
    let colour = ui.visuals().hyperlink_color;
    let chart = BarChart::new(name, bars.collect())
        .color(colour)
        .element_formatter(Box::new(|bar, _| bar.name.clone()));
    still(ui, Plot::new(name))
        .height(HEIGHT)
        .show_axes([false, false])
        .show_grid([false, false])
        .include_x(-0.5)
        .include_x(counts.len() as f64 - 0.5)
        .include_y(0.0)
        .set_margin_fraction(vec2(0.0, 0.05))
        .show(ui, |plot| plot.bar_chart(chart));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_told_by_the_end_of_their_bin() {
        let counts = [60, 38, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(worded(&counts), "half under 50 µs, 99 % under 400 µs");
        assert_eq!(worded(&[0, 10, 0]), "99 % under 100 µs");
        assert_eq!(worded(&[1, 0, 99]), "99 % over 100 µs");
        assert_eq!(worded(&[0; 12]), "not known yet");
        assert_eq!(worded(&[]), "not known yet");
        assert_eq!(bin(5, 12), "under 1.6 ms");
        let most = [u64::MAX, u64::MAX];
        assert_eq!(quantile(&most, 0.5), Some(0), "a daemon may say anything");
    }
}
