//! Names of steps of the history in the language of the window.

use maulstick_types::paint::StepName;

use super::known;

/// A step of the history, as a painter reads it.
#[must_use]
pub fn step(name: &StepName) -> String {
    let plain = match name {
        StepName::Stroke { kind, on_palette } => {
            let kind = known(kind);
            return if *on_palette {
                tr!("{kind} stroke on the palette", kind)
            } else {
                tr!("{kind} stroke", kind)
            };
        }
        StepName::Wipe { kind, on_palette } => {
            let kind = known(kind);
            return if *on_palette {
                tr!("{kind} wipe on the palette", kind)
            } else {
                tr!("{kind} wipe", kind)
            };
        }
        StepName::Load { paints } => return tr!("load {paint}", paint = paints.join(" + ")),
        StepName::Return { version } => return tr!("return to '{version}'", version),
        StepName::Merged { count } => return tr!("{count} steps", count),
        StepName::Clean => tr!("clean brush"),
        StepName::Scrape => tr!("scrape"),
        StepName::Fill => tr!("fill"),
        StepName::Underpainting => tr!("underpainting"),
        StepName::Wells => tr!("paints on the palette"),
        StepName::Ground => tr!("ground"),
        StepName::Tooth => tr!("tooth"),
        StepName::Model => tr!("paint model"),
        StepName::Dry => tr!("dry"),
        StepName::Drying => tr!("drying"),
        StepName::Wet => tr!("wet"),
        StepName::LayerOpacity => tr!("layer opacity"),
        StepName::LayerName => tr!("layer name"),
        StepName::Beginning => tr!("the beginning"),
        StepName::Unpainted => tr!("a stroke that was not painted yet"),
        StepName::Words { words } => known(words),
    };
    plain.to_owned()
}
