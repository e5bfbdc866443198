//! Surroundings of the light from a picture file, which is read on a thread.

use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_exchange::environment::{ENVIRONMENT_MEMORY, environment};
use maulstick_exchange::{Image, ImportError};
use maulstick_painting::edits::Relight;
use maulstick_types::scene::Environment;
use maulstick_types::values::ValueError;
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::paths;
use crate::reference::picture::unread;
use crate::widgets::context::{PanelContext, ask};

/// A picture that is being read.
#[derive(Debug, Default)]
pub(crate) struct EnvironmentFile {
    coming: Option<(PathBuf, BackgroundTask<Result<Environment, ImportError>>)>,
}

impl EnvironmentFile {
    /// Begins to read a file.
    pub(crate) fn read(&mut self, context: &Context, path: PathBuf) {
        let file = path.clone();
        let work = move || read(&file);
        self.coming = Some((path, BackgroundTask::start(context, "environment", work)));
    }

    /// Changes the light once the file is read.
    pub(crate) fn take_in(&mut self, work: &mut PanelContext<'_>) {
        let Some(found) = self.coming.as_ref().map(|(_, task)| task.poll()) else {
            return;
        };
        let Poll::Ready(found) = found else {
            return;
        };
        let path = self.coming.take().map(|(path, _)| path).unwrap_or_default();
        let scene = work.rig.live.scene.as_ref();
        match (found, scene.map(|scene| scene.light.clone())) {
            (Some(Ok(environment)), Some(mut light)) => {
                light.environment = environment;
                let checked = light.check().map_err(ValueError::from);
                let expose = false;
                ask(work, checked.map(|()| Relight { light, expose }));
            }
            (Some(Err(error)), _) => {
                let file = paths::shown(&path);
                let what = tr!("{file} cannot surround the painting", file);
                work.notifications.fault(what, unread(&error));
            }
            _ => {}
        }
    }
}

fn read(path: &Path) -> Result<Environment, ImportError> {
    let image = Image::open_within(path, ENVIRONMENT_MEMORY)?;
    let name = path.file_stem().unwrap_or_default();
    environment(&image, &name.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use eframe::egui::Key;
    use egui_kittest::kittest::Queryable as _;
    use maulstick_types::command::Command;

    use super::*;
    use crate::test_support::overlay_bench::{press, window, write};

    /// Writes a grey picture of this size.
    fn grey(path: &Path, width: u32, height: u32) {
        let file = std::fs::File::create(path).expect("a file");
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        let pixels = vec![90; (width * height) as usize];
        let written = encoder
            .write_header()
            .and_then(|mut to| to.write_image_data(&pixels));
        written.expect("written");
    }

    #[test]
    fn a_panorama_becomes_the_surroundings_and_another_picture_does_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut harness = window(Some(folder.path()));
        let (hall, narrow) = (
            folder.path().join("hall.png"),
            folder.path().join("narrow.png"),
        );
        grey(&hall, 64, 32);
        grey(&narrow, 40, 32);
        let mut choose = |path: &Path| {
            harness.state_mut().requests.choose_environment();
            harness.run_steps(3);
            harness.get_by_label("A picture of the surroundings");
            write(&mut harness, "Picture", &path.display().to_string());
            press(&mut harness, Key::Enter);
            let mut asked = Vec::new();
            while asked.is_empty() && harness.state().told().is_empty() {
                harness.step();
                asked = harness.state_mut().asked();
            }
            (asked, harness.state().told())
        };
        let (asked, _) = choose(&hall);
        let [(_, command)] = &asked[..] else {
            panic!("{asked:?}");
        };
        let light = |command: &Command| command.edit::<Relight>().map(|relight| relight.light);
        assert_eq!(light(command).expect("a light").environment.name(), "hall");
        let (asked, told) = choose(&narrow);
        assert!(asked.is_empty() && told.contains("narrow.png"), "{told}");
    }
}
