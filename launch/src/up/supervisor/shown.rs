//! Messages of a started rig to its user.

use indicatif::ProgressBar;
use maulstick_rig::log::say;
use maulstick_rig::node_handle::HUB;

use super::crew::Crew;
use super::settings::Settings;
use crate::commands::progress_bar;
use crate::up::bar_terminal::BarTerminal;

/// The table of the nodes, and the bar of a take.
#[derive(Debug, Default)]
pub(super) struct Shown {
    bar: Option<ProgressBar>,
    is_done: bool,
}

impl Shown {
    /// Shows both, once; `take_ns` is the length of a take that is played.
    pub(super) fn show(&mut self, crew: &Crew, settings: &Settings, take_ns: Option<u64>) {
        if std::mem::replace(&mut self.is_done, true) {
            return;
        }
        let mut text = table(crew, settings);
        if take_ns.is_none() {
            text += &places(settings);
        }
        say(&text);
        if let Some(length_ns) = take_ns {
            let bar = progress_bar(length_ns);
            bar.set_draw_target(BarTerminal::target());
            self.bar = Some(bar.with_message("playing"));
        }
    }

    /// Moves the bar.
    pub(super) fn position(&self, position_ns: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(position_ns / 1_000_000);
        }
    }

    /// Removes the bar.
    pub(super) fn end(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

fn table(crew: &Crew, settings: &Settings) -> String {
    let (rig, locator) = (settings.folder.rig(), settings.folder.locator(HUB));
    let mut text = format!(
        "rig '{rig}' is up: {locator}\n  {:<16} {:>8}  {:<10} program\n",
        "node", "pid", "state"
    );
    for node in &crew.nodes {
        let program = node.spec.program.process_name();
        text += &format!(
            "  {:<16} {:>8}  {:<10} {program}\n",
            node.spec.name,
            node.pid.unwrap_or(0),
            node.state.word(),
        );
    }
    text
}

/// Places of the painting and its recording, and the way to end the rig.
fn places(settings: &Settings) -> String {
    let recorded = settings.config.record.as_ref();
    let recorded = recorded.map(|record| format!("recorded in {}\n", record.folder.display()));
    let painting = match &settings.config.paint.document {
        Some(path) if settings.sketch().is_some() => format!(
            "sketch in {}: it is kept there until it gets a name\n",
            path.display()
        ),
        Some(path) => format!("painting in {}\n", path.display()),
        None => {
            "this painting is not kept: `maulstick up FILE.maul` keeps one in a file\n".to_owned()
        }
    };
    format!(
        "{}{painting}Ctrl-C stops it\n",
        recorded.unwrap_or_default()
    )
}
