//! Title and size of the window, and the painter's habits, which are kept.

use std::path::Path;

use eframe::egui::{Context, ViewportCommand};

use crate::app::App;
use crate::dialogs::paths;

impl App {
    /// Titles the window with the painting's name.
    pub(super) fn name_window(&mut self, context: &Context) {
        let path = self.rig.live.paint.as_ref().map(|node| &*node.status.path);
        let title = match path.filter(|path| !path.is_empty()) {
            Some(_) if self.rig.is_sketch() => tr!("Sketch · Maulstick").to_owned(),
            Some(path) => format!("{} · Maulstick", paths::name(Path::new(path))),
            None => "Maulstick".to_owned(),
        };
        if self.title != title {
            self.title.clone_from(&title);
            context.send_viewport_cmd(ViewportCommand::Title(title));
        }
    }

    /// Remembers the size of the window once nobody drags it.
    pub(super) fn remember_size(&mut self, context: &Context) {
        let size = context.input(|input| {
            let whole = input.viewport().fullscreen.unwrap_or(false);
            let rests = !whole && !input.pointer.any_down() && input.stable_dt < 0.5;
            rests.then(|| input.content_rect().size())
        });
        // The window system does not know of the text size.
        if let Some(size) = size.map(|size| size * context.zoom_factor()) {
            self.preferences.size = size.round().into();
        }
    }

    /// Keeps the habits where they have changed.
    pub(super) fn keep(&mut self) {
        let (kept, place) = &mut self.kept;
        if *kept == self.preferences {
            return;
        }
        kept.clone_from(&self.preferences);
        if let Some(Err(fault)) = place.as_deref().map(|place| kept.keep(place)) {
            self.notifications.of(&fault);
        }
    }
}
