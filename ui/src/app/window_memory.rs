//! Title and size of the window, and the painter's preferences, which are stored.

use std::path::{Path, PathBuf};

use eframe::egui::{Context, ViewportCommand};
use maulstick_ui_kit::language;
use maulstick_ui_kit::notifications::Notifications;

use crate::app::studio::Studio;
use crate::dialogs::paths;
use crate::settings::preferences::Preferences;

/// State that outlives the window, and its title.
#[derive(Debug)]
pub(super) struct WindowMemory {
    title: String,
    /// Preferences as they were last saved, and their file.
    saved: Preferences,
    file: Option<PathBuf>,
}

impl WindowMemory {
    /// Reads the preferences; faults are notified.
    pub(super) fn read(notifications: &mut Notifications) -> Self {
        let file = Preferences::place();
        let read = file
            .as_deref()
            .map_or_else(|| Ok(Preferences::default()), Preferences::read);
        let saved = read.unwrap_or_else(|fault| {
            notifications.of(&fault);
            Preferences::default()
        });
        language::choose(saved.window.language.as_deref());
        if let Some(what) = saved.keys.fault() {
            notifications.fault(
                what,
                tr!("All else is as you left it; Settings has the keys."),
            );
        }
        Self {
            title: String::new(),
            saved,
            file,
        }
    }

    /// The preferences as they were last saved.
    pub(super) fn preferences(&self) -> Preferences {
        self.saved.clone()
    }

    /// Titles the window with the painting's name, and keeps the habits where they have changed.
    pub(super) fn follow(&mut self, context: &Context, studio: &mut Studio) {
        self.name_window(context, studio);
        remember_size(context, &mut studio.preferences);
        if self.saved == studio.preferences {
            return;
        }
        self.saved.clone_from(&studio.preferences);
        let kept = self.file.as_deref().map(|file| self.saved.keep(file));
        if let Some(Err(fault)) = kept {
            studio.notifications.of(&fault);
        }
    }

    fn name_window(&mut self, context: &Context, Studio { rig, .. }: &Studio) {
        let path = rig.live.paint.as_ref().map(|node| &*node.status.path);
        let title = match path.filter(|path| !path.is_empty()) {
            Some(_) if rig.is_sketch() => tr!("Sketch · Maulstick").to_owned(),
            Some(path) => format!("{} · Maulstick", paths::name(Path::new(path))),
            None => "Maulstick".to_owned(),
        };
        if self.title != title {
            self.title.clone_from(&title);
            context.send_viewport_cmd(ViewportCommand::Title(title));
        }
    }
}

/// Stores the size of the window when it is not being dragged.
fn remember_size(context: &Context, preferences: &mut Preferences) {
    let size = context.input(|input| {
        let whole = input.viewport().fullscreen.unwrap_or(false);
        let rests = !whole && !input.pointer.any_down() && input.stable_dt < 0.5;
        rests.then(|| input.content_rect().size())
    });
    // The window system does not include the text size.
    if let Some(size) = size.map(|size| size * context.zoom_factor()) {
        preferences.window.size = size.round().into();
    }
}
