//! Everything over the desk: rack, panels, dialogs, notifications, the line of help; and the keys for them.

pub(crate) mod bar;
mod column;
mod first_run;
mod help_pages;
mod table_of_keys;

use eframe::egui::{self, Context, Rect, Ui};
use maulstick_painting::edits::common;
use maulstick_types::scene::Light;
use maulstick_types::values::Share;

use maulstick_client::dispatcher::Outcome;

use self::column::Column;
use self::first_run::FirstRun;
use self::help_pages::HelpPages;
use crate::advice;
use crate::app::rack;
use crate::app::sides;
use crate::dialogs::Files;
use crate::input::keys::Action;
use crate::input::presses;
use crate::input::size_drag::SizeDrag;
use crate::matching::colour_window::ColourWindow;
use crate::motions::Motions;
use crate::panels;
use crate::panels::history::outcome_words;
use crate::panels::light::lamp_undo::LampUndo;
use crate::reference::Reference;
use crate::rig::state::RigState;
use crate::sessions::SessionOrder;
use crate::sessions::transport_bar::TransportBar;
use crate::settings::brush_memory::BrushMemory;
use crate::settings::preferences::Preferences;
use crate::settings_page::SettingsPage;
use crate::widgets::context::{PanelContext, ask};

/// Turn of the mouse's brush by one press of a key, degrees.
const TURN_DEG: f64 = 15.0;
/// Change of the mouse's pressure by one press of a key.
const PRESS: f64 = 0.05;

/// Rack, panels, dialogs and notifications over the desk.
#[derive(Default)]
pub(crate) struct Overlay {
    column: Column,
    keys: bool,
    hiding: HidingActs,
    files: Files,
    settings: SettingsPage,
    brush_memory: BrushMemory,
    reference: Reference,
    colour: ColourWindow,
    first_run: FirstRun,
    help_pages: HelpPages,
    lamp_undo: LampUndo,
    size_drag: SizeDrag,
    transport: TransportBar,
    pub(crate) motions: Motions,
    /// The part of the window covered by the palette; nothing opens over it.
    pub(crate) palette: Option<Rect>,
    /// True while the canvas is shown without tools, and whether the window was full screen before.
    alone: Option<bool>,
}

/// Actions that hide panels, delayed while one of their controls is dragged.
#[derive(Default)]
struct HidingActs {
    later: Vec<Action>,
    /// True if a control was dragged in the last frame.
    was_dragged: bool,
}

impl HidingActs {
    /// Delays actions that hide the panels until none of their controls is dragged, so that the end of the drag is not
    /// missed.
    fn wait_for_drag(&mut self, context: &Context, acts: &mut Vec<Action>) {
        let is_dragged = context.egui_is_using_pointer();
        let hides = |act: &mut Action| matches!(act, Action::Panels | Action::Alone);
        if is_dragged || self.was_dragged {
            self.later.extend(acts.extract_if(.., hides));
        } else {
            acts.append(&mut self.later);
        }
        if !self.later.is_empty() {
            context.request_repaint();
        }
        self.was_dragged = is_dragged;
    }
}

impl Overlay {
    /// Shows the overlay and handles the keys; actions of the desk itself are returned.
    #[must_use]
    pub(crate) fn show(&mut self, ui: &mut Ui, work: &mut PanelContext<'_>) -> Vec<Action> {
        let context = ui.ctx().clone();
        let mut rest = Vec::new();
        self.lamp_undo
            .follow(work.rig, context.egui_is_using_pointer());
        // Keys are a dialog's while one is open.
        let in_dialog = self.files.is_open() || self.settings.is_open() || self.motions.is_open();
        if !in_dialog {
            TransportBar::follow_keys(&context, work);
        }
        let mut acts = if in_dialog {
            presses::force_off(&context, &work.preferences.keys)
        } else {
            presses::pressed(&context, &work.preferences.keys)
        };
        acts.append(&mut work.requests.take_acts());
        self.hiding.wait_for_drag(&context, &mut acts);
        let keymap = &work.preferences.keys;
        if self.keys
            && !in_dialog
            && context.input_mut(|input| presses::closes_table(input, keymap))
        {
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
        self.show_all(&context, in_dialog, work);
        rest
    }

    fn show_all(&mut self, context: &Context, in_dialog: bool, work: &mut PanelContext<'_>) {
        if self.alone.is_none() {
            self.transport.show(context, work);
            if sides::has_rack(work.preferences) {
                rack::show(context, work);
            }
            if work.preferences.window.panels {
                self.column.show(context, work);
            }
        }
        if !in_dialog {
            self.size_drag.follow(context, work);
        }
        if self.keys {
            table_of_keys::show(context, &work.preferences.keys, &mut self.keys);
        }
        if !in_dialog && self.alone.is_none() {
            self.first_run
                .show(context, self.palette, work.rig, work.preferences);
        }
        if let Some(act) = self.reference.show(context, self.palette, work) {
            self.files.follow(context, act, work);
        }
        self.colour.show(context, work);
        self.help_pages.show(context, work);
        self.files.show(context, &mut self.reference, work);
        self.settings.show(context, work);
        self.motions.show(context, work);
        self.brush_memory.follow(context, work);
        work.notifications.show(context);
    }

    /// Widths that the tools take from the canvas at the left and right side of the window, points.
    #[must_use]
    pub(crate) fn taken(&self, preferences: &Preferences) -> [f32; 2] {
        match self.alone {
            Some(_) => [0.0; 2],
            None => sides::taken(preferences),
        }
    }

    /// True if the window may close now; for a painting without a name the painter is asked first.
    pub(crate) fn may_close(&mut self, rig: &RigState) -> bool {
        self.files.may_close(rig)
    }

    /// True once the painter has agreed to close.
    #[must_use]
    pub(crate) fn closes(&self) -> bool {
        self.files.closes()
    }

    /// Handles the outcome of a request; a failure becomes a notification, and so does an edit whose effect may be out
    /// of view.
    pub(crate) fn on_reply(&mut self, outcome: &Outcome, work: &mut PanelContext<'_>) {
        if self.files.on_reply(outcome, work) {
            return;
        }
        work.brush_answered(outcome);
        match &outcome.result {
            Err(error) => work.notifications.of(&advice::worded(error)),
            Ok(detail) => {
                if let Some(done) = outcome_words::done(&outcome.request, detail) {
                    work.notifications.note(done);
                }
            }
        }
    }

    /// Does the action of a key; `false` for one of the desk.
    fn follow(&mut self, context: &Context, act: Action, work: &mut PanelContext<'_>) -> bool {
        self.motions.follow(act)
            || self.help_pages.follow(act)
            || self.follow_painting(act, work)
            || follow_mouse(act, work)
            || self.follow_window(context, act, work)
            || self.follow_tools(context, act, work)
    }

    /// Changes the painting or the brush.
    fn follow_painting(&mut self, act: Action, work: &mut PanelContext<'_>) -> bool {
        match act {
            Action::Undo => match self.lamp_undo.undo(work.rig) {
                Some(light) => relight(work, light),
                None => work.requests.send(common::undo()),
            },
            Action::Redo => match self.lamp_undo.redo(work.rig) {
                Some(light) => relight(work, light),
                None => work.requests.send(common::redo()),
            },
            Action::Dry => work.requests.send(common::dry(Share::WHOLE)),
            Action::Scrape => work.requests.send(common::scrape()),
            Action::Smaller => work.step_width(false),
            Action::Larger => work.step_width(true),
            Action::NextBrush => work.next_brush(),
            Action::Clean => {
                let clean = common::clean(work.rig.brush_name());
                ask(work, clean);
            }
            Action::ForceOff => panels::device::force_off(work),
            Action::Record => work.requests.session(match work.rig.recording {
                Some(_) => SessionOrder::StopRecording,
                None => SessionOrder::Record,
            }),
            _ => return false,
        }
        true
    }

    /// Updates the view of the canvas, and the tools beside it.
    fn follow_window(
        &mut self,
        context: &Context,
        act: Action,
        work: &mut PanelContext<'_>,
    ) -> bool {
        match act {
            Action::Mirror => {
                let mirrored = &mut work.preferences.window.mirrored;
                *mirrored = !*mirrored;
                let words = if *mirrored {
                    tr!("The view is mirrored; the painting is not")
                } else {
                    tr!("The view is no longer mirrored")
                };
                work.notifications.note(words.to_owned());
            }
            Action::FullScreen => fill_screen(context, !fills_screen(context)),
            Action::Alone => match self.alone.take() {
                Some(filled) => fill_screen(context, filled),
                None => {
                    self.alone = Some(fills_screen(context));
                    fill_screen(context, true);
                    let key = work.preferences.keys.written(context, Action::Alone);
                    if !key.is_empty() {
                        work.notifications
                            .note(tr!("{key} shows the tools again", key));
                    }
                }
            },
            Action::Quit => context.send_viewport_cmd(egui::ViewportCommand::Close),
            _ => return false,
        }
        true
    }

    /// Opens and closes panels, dialogs and pictures.
    fn follow_tools(
        &mut self,
        context: &Context,
        act: Action,
        work: &mut PanelContext<'_>,
    ) -> bool {
        match act {
            Action::Panels => work.preferences.window.panels = !work.preferences.window.panels,
            Action::Focus => {
                work.preferences.window.panels = true;
                self.column.focus();
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
            | Action::Play
            | Action::Reference
            | Action::ChooseTracing => {
                self.files.follow(context, act, work);
            }
            Action::Keys => self.keys = !self.keys,
            Action::Colour => self.colour.toggle(),
            Action::Settings => self.settings.open(),
            Action::Motions => self.motions.open(work),
            _ => return false,
        }
        true
    }
}

/// Changes how the mouse holds the brush.
fn follow_mouse(act: Action, work: &mut PanelContext<'_>) -> bool {
    match act {
        Action::TurnLeft | Action::TurnRight => {
            let by_deg = if act == Action::TurnLeft {
                TURN_DEG
            } else {
                -TURN_DEG
            };
            work.preferences.brushes.mouse.turn(by_deg);
            let turn = work.preferences.brushes.mouse.turn_deg;
            work.notifications.note(tr!(
                "Brush turned by {turn}°",
                turn = format_args!("{turn:.0}")
            ));
        }
        Action::Follow => {
            let follows = &mut work.preferences.brushes.mouse.follows;
            *follows = !*follows;
            let words = if *follows {
                tr!("The mouse's brush follows the stroke")
            } else {
                tr!("The mouse's brush keeps its turn")
            };
            work.notifications.note(words.to_owned());
        }
        Action::Lighter | Action::Harder => {
            let by = if act == Action::Harder { PRESS } else { -PRESS };
            work.preferences.brushes.mouse.press(by);
            let percent = 100.0 * work.preferences.brushes.mouse.pressure;
            let words = tr!(
                "Mouse presses with {percent} %",
                percent = format_args!("{percent:.0}")
            );
            work.notifications.value("pressure", words);
        }
        _ => return false,
    }
    true
}

/// Brings back a light that undo or redo leads to.
fn relight(work: &mut PanelContext<'_>, light: Light) {
    work.requests.send(common::relight(light));
    work.notifications
        .note(tr!("The light is as it was").to_owned());
}

fn fills_screen(context: &Context) -> bool {
    context.input(|input| input.viewport().fullscreen.unwrap_or(false))
}

fn fill_screen(context: &Context, fills: bool) {
    context.send_viewport_cmd(egui::ViewportCommand::Fullscreen(fills));
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Key, Modifiers};
    use egui_kittest::Harness;
    use maulstick_painting::edits::{Relight, Undo};
    use maulstick_types::command::{Command, Detail};
    use maulstick_types::paint::StepName;
    use maulstick_types::scene::Layer;

    use crate::settings::preferences::Preferences;
    use crate::test_support::overlay_bench::{Bench, ctrl, press, window};
    use crate::tracing::settings::{Tracing, Tracings};

    #[test]
    fn what_a_key_has_done_is_told_once_it_is_done() {
        let mut harness = window(None);
        let name = StepName::Fill;
        let layer = Layer {
            number: 1,
            name: "layer 1".to_owned(),
            opacity: 1.0,
        };
        let (undone, dried) = (Detail::Step { name }, Detail::Dried { layer });
        for (key, detail, told) in [
            (Key::Z, undone, "Undone: fill"),
            (Key::D, dried, "Dried: layer 1"),
            (Key::Backspace, Detail::Nothing, "Scraped"),
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
    fn undo_takes_back_a_lamp_that_was_changed_last() {
        let mut harness = window(None);
        let light = |harness: &Harness<'_, Bench>| {
            let scene = harness.state().rig.live.scene.as_ref().expect("a scene");
            scene.light.clone()
        };
        let before = light(&harness);
        let scene = harness
            .state_mut()
            .rig
            .live
            .scene
            .as_mut()
            .expect("a scene");
        scene.light.direction = [0.3, 0.2, 0.9];
        harness.run_steps(2);
        ctrl(&mut harness, Key::Z, Modifiers::NONE);
        let asked = harness.state_mut().asked();
        let back = Command::from(Relight {
            light: before.clone(),
            expose: false,
        });
        assert_eq!(asked, [("paint".to_owned(), back)]);
        harness
            .state_mut()
            .rig
            .live
            .scene
            .as_mut()
            .expect("a scene")
            .light = before;
        harness.run_steps(2);
        ctrl(&mut harness, Key::Z, Modifiers::NONE);
        let asked = harness.state_mut().asked();
        assert!(asked[0].1.edit::<Undo>().is_some(), "{asked:?}");
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
