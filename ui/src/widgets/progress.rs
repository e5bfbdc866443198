//! Progress of long work: a bar over the desk with the time left and a button that ends it, for all that takes
//! more than half a second. Warnings while the painting cannot be saved or falls behind.

use std::collections::BTreeMap;

use eframe::egui::{Align2, Area, Context, Frame, Id, Order, ProgressBar, Ui};
use maulstick_painting::edits::common;
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::Light;

use maulstick_client::request::Peer;

use crate::rig::state::RigState;
use crate::widgets::context::PanelContext;

/// Duration up to which work is not shown, ns.
const SHORT_NS: u64 = 500_000_000;
/// A light that lasts longer than this was wanted, ns.
const STOOD_NS: u64 = 1_000_000_000;
/// Width of a bar, points.
const BAR: f32 = 160.0;

/// Kind of long work; at most one of each.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Dry layers are computed for another light.
    Relighting,
    /// The surfaces are drawn for the view.
    Drawing,
    /// Wet paint dries in time.
    Drying,
    /// A process does not answer.
    Waiting(Peer),
}

/// The action that ends a job.
#[derive(Clone, Debug, PartialEq)]
enum Cancel {
    /// A command to the paint node.
    Paint(Box<Command>),
    /// The waiting requests are given up.
    GiveUp,
}

/// A job in progress.
#[derive(Clone, Debug, PartialEq)]
struct Job {
    kind: Kind,
    words: String,
    /// Progress, 0 to 1; `None` if it is unknown.
    share: Option<f64>,
    cancel: Option<Cancel>,
    /// Description of cancelling it.
    hint: &'static str,
}

/// Jobs in progress, and their start times.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    since_ns: BTreeMap<Kind, u64>,
    /// The light now, and the one that was wanted before.
    lights: [Option<Light>; 2],
    /// Since when the light has been as it is, rig clock, ns.
    stood_ns: u64,
    /// The start of the paint node that they are of.
    starts: u64,
}

impl Progress {
    /// Shows the jobs at the lower edge; `waits` names the processes whose answer is overdue. `true` if the painter
    /// cancels the wait.
    pub(crate) fn show(
        &mut self,
        context: &Context,
        work: &mut PanelContext<'_>,
        waits: &[Peer],
    ) -> bool {
        let status = work.rig.live.paint.as_ref().map(|paint| &paint.status);
        let lines: Vec<String> = status.into_iter().flat_map(lines).collect();
        let jobs = self.jobs(work.rig, waits);
        if jobs.is_empty() && lines.is_empty() {
            return false;
        }
        let mut cancelled = None;
        Area::new(Id::unique("progress"))
            .order(Order::Foreground)
            .anchor(Align2::CENTER_BOTTOM, [0.0, -12.0])
            .show(context, |ui| {
                Frame::popup(ui.style()).show(ui, |ui| {
                    for line in &lines {
                        ui.label(line);
                    }
                    for (job, begun_ns) in &jobs {
                        let elapsed_s = elapsed_s(work.rig.live.now_ns, *begun_ns);
                        if bar(ui, job, elapsed_s) {
                            cancelled.clone_from(&job.cancel);
                        }
                    }
                });
            });
        match cancelled {
            Some(Cancel::Paint(command)) => work.requests.send(*command),
            Some(Cancel::GiveUp) => return true,
            None => {}
        }
        false
    }

    /// Jobs that have run for long enough to be shown, with their start, rig clock, ns.
    fn jobs(&mut self, rig: &RigState, waits: &[Peer]) -> Vec<(Job, u64)> {
        let mut jobs: Vec<Job> = waits.iter().map(waiting).collect();
        let waited = jobs.len();
        jobs.extend(self.relighting(rig));
        jobs.extend(drawing(rig));
        jobs.extend(drying(rig));
        let now_ns = rig.live.now_ns;
        self.since_ns
            .retain(|kind, _| jobs.iter().any(|job| job.kind == *kind));
        let begun = jobs.into_iter().enumerate().filter_map(|(place, job)| {
            let begun_ns = *self.since_ns.entry(job.kind.clone()).or_insert(now_ns);
            // An overdue answer has taken long already.
            let is_long = place < waited || now_ns >= begun_ns.saturating_add(SHORT_NS);
            is_long.then_some((job, begun_ns))
        });
        begun.collect()
    }

    fn relighting(&mut self, rig: &RigState) -> Option<Job> {
        let light = rig.live.scene.as_ref().map(|scene| &scene.light);
        if self.starts != rig.live.starts {
            // Another painting has another light.
            (self.starts, self.lights) = (rig.live.starts, [None, None]);
        }
        let status = &rig.live.paint.as_ref()?.status;
        let [now, before] = &mut self.lights;
        if light != now.as_ref() {
            // Of a lamp that is dragged, what counts is where it stood.
            if rig.live.now_ns >= self.stood_ns.saturating_add(STOOD_NS) {
                before.clone_from(now);
            }
            (*now, self.stood_ns) = (light.cloned(), rig.live.now_ns);
        }
        let share = f64::from(status.baked) / f64::from(status.baking.max(1));
        let begun_ns = self.since_ns.get(&Kind::Relighting);
        let begun_ns = begun_ns.copied().unwrap_or(rig.live.now_ns);
        // Otherwise a layer has another opacity.
        let is_relit = self.stood_ns.saturating_add(STOOD_NS) >= begun_ns;
        let back = |light: &Light| Cancel::Paint(Box::new(common::relight(light.clone()).into()));
        (status.baked < status.baking).then(|| Job {
            kind: Kind::Relighting,
            words: if is_relit {
                tr!("Relighting dry layers").into()
            } else {
                tr!("Showing the layers anew").into()
            },
            share: Some(share),
            cancel: before.as_ref().filter(|_| is_relit).map(back),
            hint: tr!("Go back to the light before"),
        })
    }
}

/// Warnings about the painting that the painter cannot act on here.
fn lines(status: &PaintStatus) -> impl Iterator<Item = String> {
    let PaintStatus {
        fault,
        longer,
        lag_ns,
        ..
    } = status;
    let unsaved =
        (!fault.is_empty()).then(|| tr!("A fault of the painting's file: {fault}", fault));
    let late = (*longer > 1).then(|| {
        tr!("Painting falls behind: until the brush lifts, its marks are coarser").to_owned()
    });
    let behind = (*lag_ns >= SHORT_NS).then(|| {
        let seconds = *lag_ns as f64 * 1e-9;
        tr!(
            "The paint is {seconds} s behind the hand",
            seconds = format_args!("{seconds:.1}")
        )
    });
    unsaved.into_iter().chain(behind).chain(late)
}

/// A surface of very many cells is drawn in parts.
fn drawing(rig: &RigState) -> Option<Job> {
    let [done, all] = rig.drawn;
    (done < all).then(|| Job {
        kind: Kind::Drawing,
        words: tr!("Drawing the painting").to_owned(),
        share: Some(f64::from(done) / f64::from(all)),
        cancel: None,
        hint: "",
    })
}

fn drying(rig: &RigState) -> Option<Job> {
    let drying = rig.live.paint.as_ref()?.status.drying.as_ref()?;
    Some(Job {
        kind: Kind::Drying,
        words: if drying.layer.is_empty() {
            tr!("Drying").to_owned()
        } else {
            tr!("Drying “{layer}”", layer = drying.layer)
        },
        share: Some(f64::from(drying.share)),
        cancel: Some(Cancel::Paint(Box::new(common::stop_drying().into()))),
        hint: tr!("What is wet still stays wet"),
    })
}

fn waiting(peer: &Peer) -> Job {
    let words = match peer {
        Peer::Paint => tr!("Waiting for the painting engine …").to_owned(),
        Peer::Rig => tr!("Waiting for the rig, which opens the painting …").to_owned(),
        Peer::Brush(brush) => tr!("Waiting for the brush '{brush}' …", brush),
        Peer::Device(device) => tr!("Waiting for the device '{device}' …", device),
    };
    Job {
        kind: Kind::Waiting(peer.clone()),
        words,
        share: None,
        cancel: Some(Cancel::GiveUp),
        hint: tr!("Wait no longer; what waits is not sent any more"),
    }
}

fn elapsed_s(now_ns: u64, begun_ns: u64) -> f64 {
    now_ns.saturating_sub(begun_ns) as f64 * 1e-9
}

/// A work with its bar; `true` where it is to end.
fn bar(ui: &mut Ui, job: &Job, elapsed_s: f64) -> bool {
    ui.horizontal(|ui| {
        ui.label(&job.words);
        match job.share {
            Some(share) => {
                let percent = format!("{:.0} %", 100.0 * share);
                let bar = ProgressBar::new(share as f32).desired_width(BAR);
                ui.add(bar.text(percent));
                if share > 0.0 {
                    ui.label(left(elapsed_s * (1.0 - share) / share));
                }
            }
            None => {
                ui.spinner();
            }
        }
        job.cancel.is_some() && ui.button(tr!("Cancel")).on_hover_text(job.hint).clicked()
    })
    .inner
}

/// A time that is left, in words that do not change with every frame.
#[must_use]
pub(crate) fn left(seconds: f64) -> String {
    let near = |value: f64, step: f64| (value / step).round() * step;
    match seconds {
        s if s < 8.0 => tr!("a few seconds left").to_owned(),
        s if s < 28.0 => tr!("about {count} s left", count = near(s, 5.0)),
        s if s < 55.0 => tr!("about {count} s left", count = near(s, 10.0)),
        s if s < 3570.0 => tr!(
            "about {count} min left",
            count = (s / 60.0).round().max(1.0)
        ),
        s if s < 86_400.0 => tr!("about {count} h left", count = (s / 3600.0).round()),
        s if s.is_finite() => tr!("about {count} days left", count = (s / 86_400.0).round()),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use maulstick_client::request::Request as Asked;

    use crate::rig::requests::Requests;
    use crate::settings::preferences::Preferences;
    use crate::test_support::panel_bench::{rig, status};
    use maulstick_client::state::PaintNode;
    use maulstick_ui_kit::notifications::Notifications;

    struct Desk {
        progress: Progress,
        rig: RigState,
        requests: Requests,
        waits: Vec<Peer>,
        given_up: bool,
    }

    impl Desk {
        fn baked(&mut self, seconds: f64, baked: u32) {
            self.rig.live.now_ns = (1e9 * seconds) as u64;
            let status = maulstick_types::paint::PaintStatus {
                baking: 100,
                baked,
                ..status()
            };
            self.rig.live.paint = Some(PaintNode {
                status,
                heard_ns: self.rig.live.now_ns,
            });
        }
    }

    fn harness() -> Harness<'static, Desk> {
        let show = |ui: &mut egui::Ui, desk: &mut Desk| {
            let (mut preferences, mut notifications) =
                (Preferences::default(), Notifications::default());
            let mut work = PanelContext {
                rig: &mut desk.rig,
                requests: &mut desk.requests,
                preferences: &mut preferences,
                notifications: &mut notifications,
            };
            desk.given_up |= desk.progress.show(ui.ctx(), &mut work, &desk.waits);
        };
        let desk = Desk {
            progress: Progress::default(),
            rig: rig(),
            requests: Requests::default(),
            waits: Vec::new(),
            given_up: false,
        };
        // A spinner never rests.
        Harness::builder()
            .with_max_steps(4)
            .build_ui_state(show, desk)
    }

    #[test]
    fn relighting_is_told_after_half_a_second_with_the_time_left_and_can_be_ended() {
        let mut harness = harness();
        harness.step();
        let scene = harness.state().rig.live.scene.clone().expect("a scene");
        let mut other = scene.clone();
        other.light.intensity = 2.0;
        harness.state_mut().rig.lay(other);
        harness.state_mut().baked(10.0, 0);
        harness.step();
        let words = "Relighting dry layers";
        assert!(harness.query_by_label(words).is_none(), "it may be short");
        harness.state_mut().baked(20.0, 25);
        harness.run_steps(2);
        harness.get_by_label(words);
        harness.get_by_label("about 30 s left");
        harness.get_by_label("Cancel").click();
        harness.run_steps(2);
        let asked = harness.state_mut().requests.take();
        let back = Asked::Command {
            node: "paint".into(),
            command: common::relight(scene.light).into(),
        };
        assert_eq!(asked, [back]);
        harness.state_mut().baked(40.0, 100);
        harness.step();
        assert!(harness.query_by_label(words).is_none(), "it is done");
    }

    #[test]
    fn another_opacity_is_told_and_is_not_ended_by_another_light() {
        let mut harness = harness();
        harness.state_mut().rig.live.now_ns = 1_000_000_000;
        harness.step();
        let mut other = harness.state().rig.live.scene.clone().expect("a scene");
        other.light.intensity = 2.0;
        harness.state_mut().rig.lay(other);
        harness.state_mut().baked(10.0, 100);
        harness.step();
        harness.state_mut().baked(20.0, 0);
        harness.step();
        harness.state_mut().baked(21.0, 50);
        harness.run_steps(2);
        harness.get_by_label("Showing the layers anew");
        assert!(harness.query_by_label("Cancel").is_none());
    }

    #[test]
    fn who_is_waited_for_is_named_and_the_wait_can_be_given_up() {
        let (brush, arm) = (Peer::Brush("main".into()), Peer::Device("arm".into()));
        for (peer, words) in [
            (Peer::Paint, "Waiting for the painting engine …"),
            (brush, "Waiting for the brush 'main' …"),
            (arm, "Waiting for the device 'arm' …"),
        ] {
            let mut harness = harness();
            harness.state_mut().waits = vec![peer];
            harness.run_steps(2);
            harness.get_by_label(words);
            harness.get_by_label("Cancel").click();
            harness.run_steps(2);
            assert!(harness.state().given_up, "{words}");
        }
    }

    #[test]
    fn that_painting_falls_behind_is_told_while_it_does() {
        let mut harness = harness();
        harness.state_mut().baked(1.0, 100);
        let words = "Painting falls behind: until the brush lifts, its marks are coarser";
        for longer in [1, 4, 1] {
            let paint = harness.state_mut().rig.live.paint.as_mut();
            paint.expect("paint").status.longer = longer;
            harness.run_steps(2);
            assert_eq!(harness.query_by_label(words).is_some(), longer > 1);
        }
        let words = "The paint is 2.3 s behind the hand";
        for lag_ns in [400_000_000, 2_340_000_000, 0] {
            let paint = harness.state_mut().rig.live.paint.as_mut();
            paint.expect("paint").status.lag_ns = lag_ns;
            harness.run_steps(2);
            assert_eq!(
                harness.query_by_label(words).is_some(),
                lag_ns > 1_000_000_000
            );
        }
    }

    #[test]
    fn that_nothing_is_saved_stays_on_the_window_for_as_long_as_it_is_so() {
        let mut harness = harness();
        harness.state_mut().baked(1.0, 100);
        let fault = |desk: &mut Desk, what: &str| {
            let paint = desk.rig.live.paint.as_mut().expect("paint");
            what.clone_into(&mut paint.status.fault);
        };
        let words = "A fault of the painting's file: no room: free some space";
        fault(harness.state_mut(), "no room: free some space");
        for _ in 0..3 {
            harness.state_mut().rig.live.now_ns += 100_000_000_000;
            harness.run_steps(2);
            harness.get_by_label(words);
        }
        fault(harness.state_mut(), "");
        harness.step();
        assert!(harness.query_by_label(words).is_none());
    }

    #[test]
    fn times_are_told_roughly() {
        for (seconds, words) in [
            (0.2, "a few seconds left"),
            (18.0, "about 20 s left"),
            (41.0, "about 40 s left"),
            (58.0, "about 1 min left"),
            (200.0, "about 3 min left"),
            (7000.0, "about 2 h left"),
            (3e5, "about 3 days left"),
            (f64::INFINITY, ""),
        ] {
            assert_eq!(left(seconds), words);
        }
    }
}
