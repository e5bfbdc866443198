//! Earlier sketches, offered over a blank one, so that a painting without a name is found again after the window was
//! closed. The first paint removes the offer.

use std::path::PathBuf;
use std::task::Poll;
use std::time::SystemTime;

use eframe::egui::{Align2, Button, Context, RichText, Sense, Ui, Window};
use maulstick_rig::Sketches;
use maulstick_rig::sketches::{Sketch, leaving};
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::browser::PICTURE;
use crate::dialogs::browser::pictures::Pictures;
use crate::dialogs::paths;
use crate::rig::state::RigState;

/// Greatest number of offered sketches.
const MOST_SKETCHES: usize = 4;
/// Width of the offer, points.
const WIDTH: f32 = 300.0;

/// Choice of the painter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    Open(PathBuf),
    /// All of them are to be seen.
    All,
}

/// Other sketches than the current one.
#[derive(Debug, Default)]
struct Found {
    newest: Vec<Sketch>,
    count: usize,
    /// Sketches that are removed at the next start, once the painter was informed.
    leaving: Vec<Sketch>,
}

#[derive(Debug, Default)]
enum State {
    /// The painting is unknown so far.
    #[default]
    Waiting,
    Looking(BackgroundTask<Found>),
    Shown {
        found: Found,
        /// True once the painter has seen which ones go.
        is_told: bool,
    },
    /// The painter began to paint, chose, or closed it.
    Done,
}

#[derive(Debug, Default)]
pub(super) struct SketchOffer {
    state: State,
    pictures: Pictures,
}

/// Looks for the sketches beside the one that is open.
fn found(sketches: &Sketches, open: &std::path::Path) -> Found {
    let all = sketches.all();
    let others = all.iter().filter(|sketch| sketch.path != open);
    Found {
        newest: others.clone().take(MOST_SKETCHES).cloned().collect(),
        count: others.count(),
        leaving: leaving(&all).to_vec(),
    }
}

/// Writes down which sketches the painter has seen named: the next start removes them.
fn tell(sketches: &Sketches, leaving: &[Sketch]) {
    if let Err(fault) = sketches.notify(leaving) {
        tracing::warn!("{}: {}", fault.place.unwrap_or_default(), fault.what);
    }
}

fn stem(sketch: &Sketch) -> String {
    let stem = sketch.path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

impl SketchOffer {
    /// Follows the painting, and shows the offer over a blank sketch; the choice that was made.
    pub(super) fn show(&mut self, context: &Context, rig: &RigState) -> Option<Choice> {
        self.follow(context, rig);
        let State::Shown { found, is_told } = &mut self.state else {
            return None;
        };
        self.pictures.take_in(context);
        let (mut is_open, mut chosen) = (true, None);
        let shown = Window::new(tr!("Your sketches"))
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
            .show(context, |ui| {
                ui.set_width(WIDTH);
                chosen = list(ui, found, &mut self.pictures);
            });
        if let (true, Some(_), Some(sketches), false) = (is_open, shown, &rig.sketches, *is_told) {
            tell(sketches, &found.leaving);
            *is_told = true;
        }
        if chosen.is_some() || !is_open {
            self.state = State::Done;
        }
        chosen
    }

    fn follow(&mut self, context: &Context, rig: &RigState) {
        let (Some(sketches), Some(node)) = (&rig.sketches, &rig.live.paint) else {
            return;
        };
        match &self.state {
            State::Done => {}
            _ if !node.status.blank || !rig.is_sketch() => self.state = State::Done,
            State::Waiting => {
                let (sketches, open) = (sketches.clone(), PathBuf::from(&node.status.path));
                let look = move || found(&sketches, &open);
                self.state = State::Looking(BackgroundTask::start(context, "sketches", look));
            }
            State::Looking(task) => {
                if let Poll::Ready(found) = task.poll() {
                    self.state = match found.filter(|found| found.count > 0) {
                        Some(found) => State::Shown {
                            found,
                            is_told: false,
                        },
                        None => State::Done,
                    };
                }
            }
            State::Shown { .. } => {}
        }
    }
}

fn list(ui: &mut Ui, found: &Found, pictures: &mut Pictures) -> Option<Choice> {
    let mut chosen = None;
    let now = SystemTime::now();
    for sketch in &found.newest {
        ui.horizontal(|ui| {
            let (place, _) = ui.allocate_exact_size(PICTURE, Sense::hover());
            pictures.draw(ui, place, &sketch.path);
            let age = RichText::new(paths::age(sketch.changed, now))
                .weak()
                .small();
            let button = Button::new(stem(sketch))
                .right_text(age)
                .truncate()
                .min_size([ui.available_width(), 24.0].into());
            if ui.add(button).clicked() {
                chosen = Some(Choice::Open(sketch.path.clone()));
            }
        });
    }
    if found.count > found.newest.len() {
        let words = tr!("All {count} sketches …", count = found.count);
        if ui.button(words).clicked() {
            chosen = Some(Choice::All);
        }
    }
    ui.add_space(4.0);
    ui.weak(tr!("Or begin a new one: paint, and this goes away."));
    if !found.leaving.is_empty() {
        ui.add_space(4.0);
        let colour = crate::dialogs::dialog::wrong(ui.visuals());
        let names: Vec<String> = found.leaving.iter().map(stem).collect();
        let words = tr!(
            "There are many. At the next start the oldest go, unless you save them under a name: {names}",
            names = names.join(", ")
        );
        ui.label(RichText::new(words).color(colour));
    }
    chosen
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;
    use maulstick_rig::sketches::MOST_SKETCHES as STAY;
    use maulstick_types::command::{Command, RigCommand};

    use super::*;
    use crate::test_support::overlay_bench::{until, window_of};
    use crate::test_support::panel_bench;

    /// A rig with a blank sketch, and `others` others.
    fn rig(sketches: &Sketches, others: usize) -> RigState {
        let open = sketches.fresh("open").expect("free");
        for number in 0..others {
            let path = sketches.fresh(&format!("sketch {number:02}"));
            std::fs::write(path.expect("free"), "").expect("written");
        }
        let mut rig = panel_bench::rig();
        rig.sketches = Some(sketches.clone());
        rig.live.paint.as_mut().expect("a node").status.path = open.display().to_string();
        rig
    }

    #[test]
    fn a_sketch_of_before_goes_on_with_a_click_and_the_first_paint_takes_the_offer_away() {
        let folder = tempfile::tempdir().expect("a folder");
        let sketches = Sketches::in_folder(folder.path());
        let rig = rig(&sketches, 2);
        let window = || window_of([900.0, 700.0], rig.clone(), Default::default());
        let mut harness = window();
        until(&mut harness, |harness| {
            harness.query_by_label_contains("sketch 01").is_some()
        });
        harness.get_by_label_contains("sketch 01").click();
        harness.run_steps(3);
        let asked = harness.state_mut().asked();
        let opens = matches!(&asked[..], [(_, Command::Rig(RigCommand::Open { path, forget: false }))]
            if path.ends_with("sketch 01.maul"));
        assert!(opens, "{asked:?}");
        assert!(harness.query_by_label("Your sketches").is_none());

        let mut harness = window();
        until(&mut harness, |harness| {
            harness.query_by_label_contains("sketch 01").is_some()
        });
        let node = harness.state_mut().rig.live.paint.as_mut();
        node.expect("a node").status.blank = false;
        harness.run_steps(3);
        assert!(harness.query_by_label_contains("sketch 01").is_none());
    }

    #[test]
    fn who_has_too_many_is_told_which_go_before_they_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let sketches = Sketches::in_folder(folder.path());
        let rig = rig(&sketches, STAY + 1);
        assert_eq!(sketches.notified(), []);
        let mut harness = window_of([900.0, 700.0], rig, Default::default());
        until(&mut harness, |harness| {
            harness
                .query_by_label_contains("At the next start")
                .is_some()
        });
        assert_eq!(sketches.notified().len(), 1);
    }

    #[test]
    fn sketches_that_are_found_and_not_named_yet_do_not_count_as_told() {
        let folder = tempfile::tempdir().expect("a folder");
        let sketches = Sketches::in_folder(folder.path());
        let rig = rig(&sketches, STAY + 1);
        // Another dialog is open meanwhile: the offer finds them, and is not shown.
        let mut offer = SketchOffer::default();
        let end = Instant::now() + Duration::from_secs(60);
        while !matches!(offer.state, State::Shown { .. }) {
            assert!(Instant::now() < end, "they are not found");
            offer.follow(&Context::default(), &rig);
            std::thread::yield_now();
        }
        assert_eq!(sketches.notified(), []);
        let show = |ui: &mut Ui, offer: &mut SketchOffer| {
            assert_eq!(offer.show(ui.ctx(), &rig), None);
        };
        let mut harness = Harness::builder()
            .with_size([900.0, 700.0])
            .build_ui_state(show, offer);
        harness.run_steps(2);
        assert_eq!(sketches.notified().len(), 1);
        let name = stem(&sketches.notified()[0]);
        harness.get_by_label_contains(&name);
        sketches.notify(&[]).expect("forgotten");
        harness.run_steps(2);
        assert_eq!(sketches.notified(), [], "it is told once");
    }
}
