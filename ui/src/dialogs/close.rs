//! Dialog before the window closes on a painting that has no name, or is not whole in its file: it says where the
//! painting is kept, or that it would be lost.

use std::path::PathBuf;

use eframe::egui::{Context, RichText};

use crate::dialogs::dialog::{self, Answer, Foot, in_words};
use crate::dialogs::paths;
use crate::rig::state::RigState;

/// Effect of closing on the painting.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Fate {
    /// It is kept as a sketch in this folder.
    Kept(PathBuf),
    /// It is in memory alone, and lost.
    Gone,
    /// Its file lacks the latest strokes, for this reason.
    Unwritten(String),
}

/// Decision of the painter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    None,
    Stay,
    /// The painting is to get a name first.
    Name,
    Close,
}

/// The question whether to close.
#[derive(Debug)]
pub(super) struct ClosePainting {
    fate: Fate,
}

impl ClosePainting {
    /// The question for the current painting; `None` where none is needed: nothing was painted, or all of it is in a
    /// file with a name.
    #[must_use]
    pub(super) fn of(rig: &RigState) -> Option<Self> {
        let status = &rig.live.paint.as_ref()?.status;
        let fate = if !status.fault.is_empty() && !status.all_committed {
            Fate::Unwritten(status.fault.clone())
        } else if status.blank {
            return None;
        } else if let Some(sketches) = rig.sketches.as_ref().filter(|_| rig.is_sketch()) {
            Fate::Kept(sketches.folder().to_owned())
        } else if status.path.is_empty() {
            Fate::Gone
        } else {
            return None;
        };
        Some(Self { fate })
    }

    pub(super) fn show(&mut self, context: &Context) -> Decision {
        let mut names = false;
        let answer = dialog::show(context, tr!("Close Maulstick"), |ui| {
            let (words, warns) = match &self.fate {
                Fate::Kept(folder) => (
                    tr!(
                        "This sketch has no name yet. It is kept in {folder}, and offered when you \
                         start Maulstick again.",
                        folder = paths::shown(folder)
                    ),
                    false,
                ),
                Fate::Gone => (
                    tr!("The painting on the easel is in no file: it would be gone.").to_owned(),
                    true,
                ),
                Fate::Unwritten(fault) => (
                    tr!(
                        "What you painted last is not in its file. {fault}",
                        fault = in_words(fault, "")
                    ),
                    true,
                ),
            };
            let text = RichText::new(words);
            if warns {
                ui.label(text.color(dialog::wrong(ui.visuals())))
            } else {
                ui.label(text)
            };
            ui.add_space(6.0);
            names = ui.button(tr!("Save under a name …")).clicked();
            Foot {
                go: match self.fate {
                    Fate::Gone => tr!("Close and lose it"),
                    Fate::Kept(_) | Fate::Unwritten(_) => tr!("Close"),
                },
                ..Foot::default()
            }
        });
        match answer {
            _ if names => Decision::Name,
            Answer::Go => Decision::Close,
            Answer::Leave => Decision::Stay,
            Answer::Stay => Decision::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use egui_kittest::kittest::Queryable as _;
    use maulstick_rig::Sketches;
    use maulstick_types::paint::PaintStatus;

    use super::*;
    use crate::test_support::overlay_bench::window_of;
    use crate::test_support::panel_bench::{rig, status};

    const SKETCHES: &str = "/state/sketches";

    fn painted(path: &str) -> PaintStatus {
        PaintStatus {
            path: path.to_owned(),
            blank: false,
            ..status()
        }
    }

    fn rig_with(status: PaintStatus) -> RigState {
        let mut rig = rig();
        rig.sketches = Some(Sketches::in_folder(Path::new(SKETCHES)));
        rig.live.paint.as_mut().expect("a node").status = status;
        rig
    }

    #[test]
    fn closing_asks_where_a_painting_has_no_name_or_would_be_gone() {
        let fate = |status: PaintStatus| ClosePainting::of(&rig_with(status)).map(|ask| ask.fate);
        assert_eq!(fate(painted("")), Some(Fate::Gone));
        let kept = Fate::Kept(SKETCHES.into());
        assert_eq!(fate(painted("/state/sketches/a.maul")), Some(kept));
        assert_eq!(fate(painted("/home/a.maul")), None);
        assert_eq!(fate(status()), None, "nothing is painted");
        let full = PaintStatus {
            fault: "the disk is full".to_owned(),
            all_committed: false,
            ..painted("/home/a.maul")
        };
        assert_eq!(
            fate(full),
            Some(Fate::Unwritten("the disk is full".to_owned()))
        );
    }

    #[test]
    fn a_sketch_is_closed_or_gets_a_name_and_the_window_may_stay() {
        for (button, closes, saves) in [
            ("Close", true, false),
            ("Cancel", false, false),
            ("Save under a name …", false, true),
        ] {
            let rig = rig_with(painted("/state/sketches/a.maul"));
            let mut harness = window_of([900.0, 700.0], rig, Default::default());
            let bench = harness.state_mut();
            assert!(!bench.overlay.may_close(&bench.rig));
            harness.run_steps(3);
            harness.get_by_label_contains(SKETCHES);
            harness.get_by_label(button).click();
            harness.run_steps(3);
            let bench = harness.state_mut();
            assert_eq!(bench.overlay.closes(), closes, "{button}");
            let title = harness.query_by_label("Save under another name");
            assert_eq!(title.is_some(), saves, "{button}");
        }
    }
}
