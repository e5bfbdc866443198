//! The brush in the hand, remembered from session to session: its file, width, stiffness, wetness and mode, without its
//! paint. A painting that says how its brush is used keeps that.

use std::collections::BTreeMap;
use std::time::Duration;

use eframe::egui::{Context, Event};
use maulstick_brush::BrushFile;
use maulstick_rig::UserError;
use maulstick_types::scene::{BrushHandling, Tuning};

use crate::input::keys::Action;
use crate::input::presses;
use crate::settings::brush_load::BrushLoad;
use crate::settings::presets::Preset;
use crate::widgets::context::PanelContext;

/// A brush is remembered once it has been so for this long, s: a dragged control passes many states.
const RESTS_S: f64 = 0.3;
/// Names of nodes that play a take begin so: its brush is the take's.
const PLAYER: &str = "player";

/// A brush as it is used.
#[derive(Clone, Debug, PartialEq)]
struct Used {
    file: BrushFile,
    tuning: Tuning,
    handling: BrushHandling,
}

/// State of a brush of the rig.
#[derive(Clone, Debug)]
struct Known {
    /// Start of its node for which it was given what is remembered.
    epoch: u32,
    /// Use that was seen last, and since when, s.
    seen: Option<(Used, f64)>,
    /// Use that is stored.
    kept: Option<Used>,
}

/// Memory of the brushes of the rig.
#[derive(Debug, Default)]
pub(crate) struct BrushMemory {
    /// True once the painter has moved or pressed something in the window: before that it only looks on.
    is_used: bool,
    known: BTreeMap<String, Known>,
}

impl BrushMemory {
    /// Gives a brush whose node has started what was in the hand before, and remembers what is.
    pub(crate) fn follow(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        self.is_used |= context.input(|input| {
            let is_key = |event: &Event| matches!(event, Event::Key { .. });
            input.pointer.latest_pos().is_some() || input.events.iter().any(is_key)
        });
        let is_taken = work
            .rig
            .live
            .paint
            .as_ref()
            .is_none_or(|node| node.status.take)
            || work.rig.replay.is_some()
            || work
                .rig
                .live
                .nodes
                .iter()
                .any(|node| node.starts_with(PLAYER));
        if !self.is_used || is_taken || work.rig.switching || work.rig.live.scene.is_none() {
            return;
        }
        let Some(brush) = work.rig.brush().filter(|brush| brush.file.is_some()) else {
            return;
        };
        let (name, epoch) = (brush.name.clone(), brush.epoch);
        match self.known.get_mut(&name) {
            Some(known) if known.epoch == epoch => known.remember(context, &name, work),
            _ => {
                let known = Known {
                    epoch,
                    seen: None,
                    kept: None,
                };
                self.known.insert(name.clone(), known);
                if let Some(held) = work.preferences.brushes.in_hand.get(&name).cloned()
                    && let Err(fault) = restore(&held, work)
                {
                    work.preferences.brushes.in_hand.remove(&name);
                    work.notifications.of(&fault);
                }
            }
        }
    }
}

impl Known {
    fn remember(&mut self, context: &Context, name: &str, work: &mut PanelContext<'_>) {
        let Some(file) = work.in_hand() else {
            return;
        };
        // While its key lifts paint, the mode is not the painter's choice.
        let lifts =
            context.input(|input| presses::is_down(input, &work.preferences.keys, Action::Clean));
        let now_s = context.input(|input| input.time);
        let used = Used {
            file: file.clone(),
            tuning: work.rig.tuning(),
            handling: work.rig.handling(),
        };
        if self.kept.as_ref() == Some(&used) {
            self.seen = None;
            return;
        }
        let since_s = match &self.seen {
            Some((seen, since_s)) if *seen == used && !lifts => *since_s,
            _ => now_s,
        };
        self.seen = Some((used.clone(), since_s));
        if now_s - since_s < RESTS_S {
            return context.request_repaint_after(Duration::from_secs_f64(RESTS_S));
        }
        if let Some(preset) = work.preset_in_hand("") {
            let held = Preset {
                loading: BrushLoad::default(),
                pressure: None,
                ..preset
            };
            work.preferences
                .brushes
                .in_hand
                .insert(name.to_owned(), held);
        }
        (self.kept, self.seen) = (Some(used), None);
    }
}

/// Gives the brush in the hand what is remembered.
///
/// # Errors
/// A [`UserError`] where that is no brush, as after an edit of the preferences by hand.
fn restore(held: &Preset, work: &mut PanelContext<'_>) -> Result<(), UserError> {
    let (name, scene) = (work.rig.brush_name(), work.rig.live.scene.as_ref());
    let (file, [tune, handle]) = (held.brush()?, held.edits(name)?);
    let (tuning, handling) = (held.tuning(name), held.handling(name)?);
    let tuned = scene.is_some_and(|scene| scene.tunings.iter().any(|own| own.brush == name));
    let handled = scene.is_some_and(|scene| scene.handlings.iter().any(|own| own.brush == name));
    let usual = (work.rig.tuning(), work.rig.handling());
    work.take_up(file);
    if !tuned && usual.0 != tuning {
        work.requests.send(tune);
    }
    if !handled && usual.1 != handling {
        work.requests.send(handle);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, pos2};
    use egui_kittest::Harness;
    use maulstick_painting::edits::{Handle, Tune};
    use maulstick_types::command::{BrushCommand, Command};
    use maulstick_types::scene::BrushMode;

    use crate::settings::brush_library::of_library;
    use crate::settings::preferences::Preferences;
    use crate::test_support::overlay_bench::{Bench, window};

    /// A session with a brush of the library, that begins with these preferences; its pointer moves.
    fn session(preferences: Preferences, kind: &str, width_mm: f64) -> Harness<'static, Bench> {
        let mut harness = window(None);
        let bench = harness.state_mut();
        bench.preferences = preferences;
        let file = of_library(kind).expect("of the library");
        let file = file.scaled_to(width_mm).expect("a width");
        let text = file.to_toml().expect("written");
        bench.rig.brushes[0].file = Some((file, text));
        bench.rig.brushes[0].epoch = 7;
        harness.event(Event::PointerMoved(pos2(300.0, 300.0)));
        harness.run_steps(6);
        harness
    }

    fn remembered() -> Preferences {
        let mut harness = session(Preferences::default(), "filbert", 22.0);
        let rig = &mut harness.state_mut().rig;
        let mut handling = rig.handling();
        handling.mode = BrushMode::NoPush;
        let mut tuning = rig.tuning();
        tuning.stiffness = 1.5;
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.handlings.push(handling);
        scene.tunings.push(tuning);
        harness.state_mut().preferences.brushes.loading.paint = "Bone Black".into();
        harness.run_steps(6);
        let text = toml::to_string(&harness.state().preferences).expect("written");
        assert!(!text.contains("Bone Black"), "a brush begins clean");
        toml::from_str(&text).expect("read")
    }

    #[test]
    fn the_brush_of_the_last_session_is_in_the_hand_of_the_next_and_clean() {
        let mut harness = session(remembered(), "round", 10.0);
        let asked = harness.state_mut().asked();
        let [
            (_, Command::Brush(BrushCommand::Define { toml, .. })),
            (_, tune),
            (_, handle),
        ] = &asked[..]
        else {
            panic!("{asked:?}");
        };
        let tune: Tune = tune.edit().expect("a tuning");
        let handle: Handle = handle.edit().expect("a mode");
        assert_eq!(tune.stiffness.get(), 1.5);
        assert_eq!(handle.mode, BrushMode::NoPush);
        let file = maulstick_brush::BrushFile::parse(toml.as_str()).expect("a brush");
        assert_eq!((file.kind.as_str(), file.head.width_mm), ("filbert", 22.0));
        // Once: what the painter takes then stays.
        harness.run_steps(6);
        assert_eq!(harness.state_mut().asked(), []);
        // A node that starts again has the brush of the rig's settings.
        let other = of_library("round").expect("round").clone();
        let text = other.to_toml().expect("written");
        let brush = &mut harness.state_mut().rig.brushes[0];
        (brush.file, brush.asked, brush.epoch) = (Some((other, text)), None, 8);
        harness.run_steps(4);
        assert!(!harness.state_mut().asked().is_empty());
    }

    #[test]
    fn a_painting_keeps_how_its_brush_is_used_and_a_take_its_brush() {
        let preferences = remembered();
        let mut harness = session(Preferences::default(), "round", 10.0);
        let rig = &mut harness.state_mut().rig;
        let (tuning, handling) = (rig.tuning(), rig.handling());
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.tunings.push(tuning);
        scene.handlings.push(handling);
        harness.state_mut().preferences = preferences.clone();
        harness.state_mut().rig.brushes[0].epoch = 9;
        harness.run_steps(4);
        let asked = harness.state_mut().asked();
        assert!(
            matches!(&asked[..], [(_, Command::Brush(_))]),
            "the brush alone: {asked:?}"
        );
        let mut harness = window(None);
        harness.state_mut().rig.live.nodes.push("player".into());
        harness.state_mut().preferences = preferences;
        let file = of_library("round").expect("round").clone();
        let text = file.to_toml().expect("written");
        harness.state_mut().rig.brushes[0].file = Some((file, text));
        harness.event(Event::PointerMoved(pos2(300.0, 300.0)));
        harness.run_steps(20);
        assert_eq!(harness.state_mut().asked(), []);
    }

    #[test]
    fn a_brush_that_is_none_is_told_once_and_forgotten() {
        let mut preferences = remembered();
        let held = preferences
            .brushes
            .in_hand
            .get_mut("main")
            .expect("remembered");
        held.kind = "broom".into();
        let harness = session(preferences, "round", 10.0);
        let told = harness.state().told();
        assert_eq!(told.matches("broom").count(), 1, "{told}");
        let kept = &harness.state().preferences.brushes.in_hand["main"];
        assert_eq!(kept.kind, "round");
    }
}
