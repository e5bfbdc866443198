//! What a rig that has come up says to who started it.

use maulstick_rig::log::say;
use maulstick_rig::node_handle::HUB;

use super::Supervisor;
use crate::commands::progress_bar;
use crate::up::bar_terminal::BarTerminal;

impl Supervisor {
    pub(super) fn show_when_ready(&mut self) {
        if self.shown || !self.ready() {
            return;
        }
        self.shown = true;
        say(&self.table());
        if let Some(conductor) = &self.conductor {
            let bar = progress_bar(conductor.performance.length_ns);
            bar.set_draw_target(BarTerminal::target());
            self.bar = Some(bar.with_message("playing"));
        }
    }

    /// The nodes, where the painting is, and how to end it.
    fn table(&self) -> String {
        let (rig, locator) = (self.folder.rig(), self.folder.locator(HUB));
        let mut text = format!(
            "rig '{rig}' is up: {locator}\n  {:<16} {:>8}  {:<10} program\n",
            "node", "pid", "state"
        );
        for node in &self.nodes {
            let program = node.spec.program.process_name();
            text += &format!(
                "  {:<16} {:>8}  {:<10} {program}\n",
                node.spec.name,
                node.pid().unwrap_or(0),
                node.state.word(),
            );
        }
        if self.conductor.is_none() {
            if let Some(record) = &self.config.record {
                text += &format!("recorded in {}\n", record.folder.display());
            }
            text += &match &self.config.paint.document {
                Some(path) if self.sketch().is_some() => format!(
                    "sketch in {}: it is kept there until it gets a name\n",
                    path.display()
                ),
                Some(path) => format!("painting in {}\n", path.display()),
                None => "this painting is not kept: `maulstick up FILE.maul` keeps one in a file\n"
                    .to_owned(),
            };
            text += "Ctrl-C stops it\n";
        }
        text
    }
}
