//! Everything over the desk: rack, panels, dialogs, notifications, the line of help; and the keys for them.

use eframe::egui::{
    self, Align2, Area, CollapsingHeader, Context, Frame, Id, Order, RichText, ScrollArea, Ui,
};
use maulstick_types::command::Command;
use maulstick_types::edits::{Dry, Edit, Redo, Scrape, Undo};
use maulstick_types::scene::{CANVAS, PALETTE};

use crate::app::bar;
use crate::app::first_run::FirstRun;
use crate::app::rack;
use crate::dialogs::Files;
use crate::input::keys::{self, Action};
use crate::input::size_drag::SizeDrag;
use crate::panels::{self, Panel};
use crate::reference::Reference;
use crate::rig::dispatcher::Outcome;
use crate::rig::requests::Request;
use crate::settings::preferences::Preferences;
use crate::widgets::context::PanelContext;

/// Width of the column of panels, points.
const COLUMN: f32 = 300.0;
/// Distance of the column from the window's edges, points.
const MARGIN: f32 = 8.0;
/// Turn of the mouse's brush by one press of a key, degrees.
const TURN_DEG: f64 = 15.0;
/// Change of the mouse's pressure by one press of a key.
const PRESS: f64 = 0.05;

/// Rack, panels, dialogs and notifications over the desk.
pub(crate) struct Overlay {
    panels: Vec<Box<dyn Panel>>,
    keys: bool,
    /// True if the panels are to get the keyboard.
    to_panels: bool,
    files: Files,
    reference: Reference,
    first_run: FirstRun,
    size_drag: SizeDrag,
    /// True while the canvas is shown without tools, and whether the window was full screen before.
    alone: Option<bool>,
}

impl Default for Overlay {
    fn default() -> Self {
        Self {
            panels: panels::all(),
            keys: false,
            to_panels: false,
            files: Files::default(),
            reference: Reference::default(),
            first_run: FirstRun::default(),
            size_drag: SizeDrag::default(),
            alone: None,
        }
    }
}

impl Overlay {
    /// Shows it and follows the keys; what concerns the desk itself is returned.
    #[must_use]
    pub(crate) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) -> Vec<Action> {
        let context = ui.ctx().clone();
        let mut rest = Vec::new();
        // Keys are a dialog's while one is open.
        let mut acts = match self.files.is_open() {
            true => keys::force_off(&context),
            false => keys::pressed(&context),
        };
        acts.append(&mut work.requests.take_acts());
        if self.keys && !self.files.is_open() && context.input_mut(keys::closes_table) {
            self.keys = false;
            acts.retain(|act| *act != Action::Keys);
        }
        if self.alone.is_none() {
            acts.extend(bar::show(&context, work));
        }
        for act in acts {
            if !self.follow(&context, act, work) {
                rest.push(act);
            }
        }
        if self.alone.is_none() {
            rack::show(&context, work);
            if work.preferences.panels {
                self.column(&context, work);
            }
        }
        if !self.files.is_open() {
            self.size_drag.follow(&context, work);
        }
        if self.keys {
            self.table_of_keys(&context);
        }
        if !self.files.is_open() && self.alone.is_none() {
            self.first_run.show(&context, work.rig, work.preferences);
        }
        if let Some(act) = self.reference.show(&context, work) {
            self.files.follow(&context, act, work);
        }
        self.files.show(&context, &mut self.reference, work);
        work.notifications.show(&context);
        rest
    }

    /// Width at the side of the rack that the tools take from the canvas, points.
    #[must_use]
    pub(crate) fn width(&self, preferences: &Preferences) -> f32 {
        match (self.alone, preferences.panels) {
            (Some(_), _) => 0.0,
            (None, false) => rack::WIDTH,
            (None, true) => rack::WIDTH + COLUMN + 6.0 * MARGIN,
        }
    }

    /// Takes in the outcome of a request; a failure becomes a notification, and so does an edit
    /// whose effect may be out of view.
    pub(crate) fn hear(&mut self, outcome: &Outcome, work: &mut PanelContext<'_>) {
        if self.files.hear(outcome, work) {
            return;
        }
        work.brush_answered(outcome);
        match &outcome.result {
            Err(fault) => work.notifications.of(fault),
            Ok(detail) => {
                if let Some(done) = past_tense(&outcome.request) {
                    let what = match detail.is_empty() {
                        true => done.to_owned(),
                        false => format!("{done}: {detail}"),
                    };
                    work.notifications.note(what);
                }
            }
        }
    }

    /// Does what a key asks for; `false` where it concerns the desk.
    fn follow(&mut self, context: &Context, act: Action, work: &mut PanelContext<'_>) -> bool {
        match act {
            Action::Undo => work.requests.send(Undo { brush: None }),
            Action::Redo => work.requests.send(Redo { brush: None }),
            Action::Dry => work.requests.send(Dry::whole(CANVAS)),
            Action::Scrape => work.requests.send(Scrape {
                region: None,
                surface: PALETTE,
            }),
            Action::Smaller => work.step_width(false),
            Action::Larger => work.step_width(true),
            Action::NextBrush => work.next_brush(),
            Action::TurnLeft | Action::TurnRight => {
                let by_deg = if act == Action::TurnLeft {
                    TURN_DEG
                } else {
                    -TURN_DEG
                };
                work.preferences.mouse.turn(by_deg);
                let turn = work.preferences.mouse.turn_deg;
                work.notifications
                    .note(format!("Brush turned by {turn:.0}°"));
            }
            Action::Follow => {
                let follows = &mut work.preferences.mouse.follows;
                *follows = !*follows;
                let words = match *follows {
                    true => "The mouse's brush follows the stroke",
                    false => "The mouse's brush keeps its turn",
                };
                work.notifications.note(words.to_owned());
            }
            Action::Lighter | Action::Harder => {
                let by = if act == Action::Harder { PRESS } else { -PRESS };
                work.preferences.mouse.press(by);
                let percent = 100.0 * work.preferences.mouse.pressure;
                work.notifications
                    .note(format!("Mouse presses with {percent:.0} %"));
            }
            Action::Panels => work.preferences.panels = !work.preferences.panels,
            Action::Focus => {
                work.preferences.panels = true;
                self.to_panels = true;
            }
            Action::Reference if self.reference.toggle(work.preferences) => {}
            Action::Tracing => match work.tracing_mut() {
                Some(tracing) => tracing.shown = !tracing.shown,
                None => drop(self.files.follow(context, Action::ChooseTracing, work)),
            },
            Action::New
            | Action::Open
            | Action::Save
            | Action::SaveAs
            | Action::Export
            | Action::Reference
            | Action::ChooseTracing => {
                self.files.follow(context, act, work);
            }
            Action::Keys => self.keys = !self.keys,
            Action::ForceOff => panels::device::force_off(work),
            Action::FullScreen => fill_screen(context, !fills_screen(context)),
            Action::Alone => match self.alone.take() {
                Some(filled) => fill_screen(context, filled),
                None => {
                    self.alone = Some(fills_screen(context));
                    fill_screen(context, true);
                    work.notifications
                        .note("F10 shows the tools again".to_owned());
                }
            },
            _ => return false,
        }
        true
    }

    fn column(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let (side, inward) = match work.preferences.left_handed {
            false => (Align2::RIGHT_TOP, -1.0),
            true => (Align2::LEFT_TOP, 1.0),
        };
        let height = context.content_rect().height() - 4.0 * MARGIN;
        Area::new(Id::unique("panels"))
            .order(Order::Middle)
            .anchor(side, [inward * (rack::WIDTH + 2.0 * MARGIN), MARGIN])
            .accessible_name("Panels")
            .show(context, |ui| {
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(COLUMN);
                    ScrollArea::vertical()
                        .max_height(height)
                        .min_scrolled_height(height)
                        .show(ui, |ui| {
                            for panel in &mut self.panels {
                                let title = panel.title();
                                let open = work.preferences.is_open(title);
                                let header = CollapsingHeader::new(RichText::new(title).strong())
                                    .id_salt(title)
                                    .default_open(open);
                                let shown = header.show(ui, |ui| {
                                    ui.spacing_mut().slider_width = 120.0;
                                    panel.show(ui, work);
                                });
                                if std::mem::take(&mut self.to_panels) {
                                    shown.header_response.request_focus();
                                }
                                if shown.header_response.clicked() {
                                    work.preferences.unfold(title, !open);
                                }
                            }
                        });
                });
            });
    }

    fn table_of_keys(&mut self, context: &Context) {
        let mut open = self.keys;
        egui::Window::new("Keys")
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
            .show(context, |ui| {
                egui::Grid::new("keys")
                    .num_columns(2)
                    .striped(true)
                    .show(ui, |ui| {
                        for binding in &keys::BINDINGS {
                            ui.monospace(keys::written(context, &binding.shortcut));
                            ui.label(binding.words);
                            ui.end_row();
                        }
                        for (keys, words) in keys::HELD {
                            ui.monospace(keys);
                            ui.label(words);
                            ui.end_row();
                        }
                    });
            });
        self.keys = open;
    }
}

fn fills_screen(context: &Context) -> bool {
    context.input(|input| input.viewport().fullscreen.unwrap_or(false))
}

fn fill_screen(context: &Context, fills: bool) {
    context.send_viewport_cmd(egui::ViewportCommand::Fullscreen(fills));
}

/// The deed of an edit whose effect may be out of view.
fn past_tense(request: &Request) -> Option<&'static str> {
    let Request::Command {
        command: Command::Edit(edit),
        ..
    } = request
    else {
        return None;
    };
    match edit {
        Edit::Undo(_) => Some("Undone"),
        Edit::Redo(_) => Some("Redone"),
        Edit::GoTo(_) => Some("Now at"),
        Edit::Dry(_) => Some("Dried"),
        Edit::LoadFrom(_) => Some("Loaded"),
        Edit::Scrape(_) => Some("Scraped"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers};

    use crate::settings::preferences::Preferences;
    use crate::test_support::overlay_bench::{ctrl, press, window};
    use crate::tracing::settings::{Tracing, Tracings};

    #[test]
    fn what_a_key_has_done_is_told_once_it_is_done() {
        let mut harness = window(None);
        for (key, detail, told) in [
            (Key::Z, "stroke", "Undone: stroke"),
            (Key::D, "layer 1", "Dried: layer 1"),
            (Key::Backspace, "", "Scraped"),
        ] {
            match key {
                Key::Z => ctrl(&mut harness, key, Modifiers::NONE),
                _ => press(&mut harness, key),
            }
            let bench = harness.state_mut();
            let asked = bench.asked();
            assert_eq!(asked.len(), 1, "{asked:?}");
            assert!(!bench.told().contains(told), "it is not done yet");
            bench.answer(&asked[0], Ok(detail));
            let lines = bench.told();
            assert!(lines.lines().any(|line| line.trim_end() == told), "{lines}");
        }
    }

    #[test]
    fn a_key_hides_the_tracing_picture_and_shows_it() {
        let mut harness = window(None);
        let shown = |preferences: &Preferences| {
            let mut tracings = preferences.tracings.iter();
            tracings.next().map(|tracing| tracing.shown)
        };
        let tracing = Tracing {
            path: "/sketch.png".into(),
            ..Tracing::default()
        };
        harness.state_mut().preferences.tracings = Tracings::of(tracing);
        for expected in [false, true] {
            ctrl(&mut harness, Key::T, Modifiers::NONE);
            assert_eq!(shown(&harness.state().preferences), Some(expected));
        }
    }
}
