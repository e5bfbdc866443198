//! Loss of the graphics device: the window ends, the launcher opens it again, and the new window says why.
//!
//! Nothing can be drawn without the device, and eframe cannot replace the one it began with.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::Context;
use eframe::egui_wgpu::wgpu;
use maulstick_rig::UserError;

/// File in the rig's folder in which the closing window leaves the reason for the next one.
const WORD: &str = "window-lost";
/// Longest driver message that is shown, bytes.
const LONGEST: usize = 300;

/// Watches over a graphics device; clones share it.
#[derive(Clone, Debug)]
pub struct DeviceLoss {
    why: Arc<Mutex<Option<String>>>,
    word: PathBuf,
}

impl DeviceLoss {
    /// Nothing is lost yet; word is left in `folder`.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self {
            why: Arc::default(),
            word: folder.join(WORD),
        }
    }

    /// Watches `device`, and has the window of `context` drawn again when it is lost.
    pub fn follow(&self, device: &wgpu::Device, context: &Context) {
        let (lost, context) = (self.clone(), context.clone());
        device.set_device_lost_callback(move |reason, words| {
            // So it ends with the window.
            if reason != wgpu::DeviceLostReason::Destroyed {
                lost.lose(&words);
                context.request_repaint();
            }
        });
    }

    fn lose(&self, words: &str) {
        let words = words.trim();
        let mut why = if words.is_empty() {
            "its driver gives no reason".to_owned()
        } else {
            words.to_owned()
        };
        why.truncate(why.floor_char_boundary(LONGEST));
        if let Err(error) = std::fs::write(&self.word, &why) {
            tracing::warn!("{}: {error}", self.word.display());
        }
        *self.why.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
    }

    /// True once the device is lost.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.why().is_some()
    }

    fn why(&self) -> Option<String> {
        let why = self.why.lock().unwrap_or_else(PoisonError::into_inner);
        why.clone()
    }

    /// As what the window ends by it: a failure, after which the rig opens it again.
    ///
    /// # Errors
    /// A [`UserError`] where the device is lost.
    pub fn check(&self) -> Result<(), UserError> {
        match self.why() {
            None => Ok(()),
            Some(why) => Err(
                UserError::failure(format!("the graphics device is lost: {why}"))
                    .help("the window is opened again; where that recurs, update its driver"),
            ),
        }
    }

    /// The reason why the previous window closed, returned once.
    #[must_use]
    pub fn word(&self) -> Option<String> {
        let why = std::fs::read_to_string(&self.word).ok()?;
        std::fs::remove_file(&self.word).ok();
        Some(why)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_window_of_the_rig_says_once_why_the_last_one_ended() {
        let folder = tempfile::tempdir().expect("a folder");
        let window = DeviceLoss::new(folder.path());
        assert!(window.word().is_none() && !window.is_lost());
        assert_eq!(window.check(), Ok(()));
        window.lose(" the GPU was reset ");
        let fault = window.check().expect_err("it is lost");
        assert_eq!(fault.what, "the graphics device is lost: the GPU was reset");
        let next = DeviceLoss::new(folder.path());
        assert!(!next.is_lost(), "it has a device of its own");
        assert_eq!(next.word().as_deref(), Some("the GPU was reset"));
        assert_eq!(next.word(), None);
        window.lose("");
        window.lose(&"ä".repeat(1000));
        assert!(next.word().expect("word").len() <= LONGEST);
    }

    #[test]
    fn a_device_that_is_let_go_is_not_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let (gpu, lost) = (
            crate::render::gpu::testing::gpu(),
            DeviceLoss::new(folder.path()),
        );
        lost.follow(&gpu.device, &Context::default());
        gpu.device.destroy();
        let wait = wgpu::PollType::wait_indefinitely();
        gpu.device.poll(wait).ok();
        assert!(!lost.is_lost());
    }
}
