//! A script's words for the advice that comes with a refusal: steps in the place of commands.

use maulstick_types::command::advice::Advice;

/// Remedy in a script; `None` where other words suffice.
#[must_use]
pub fn words(advice: &Advice) -> Option<String> {
    let words = match advice {
        Advice::StopDrying => "wait for its end, or stop it: { stop_drying = true }",
        Advice::BeginDrying => "{ dry = 1.0, over = \"90s\" } begins one",
        Advice::DryFirst => "{ dry = 1.0 } dries wet paint into a layer",
        Advice::FullOpacity { layer } => {
            return Some(format!(
                "{{ opacity = 1.0, layer = {layer} }} makes it as it was laid"
            ));
        }
        Advice::UndoNewest => "undo that first: { undo = 1 }",
        Advice::Say { .. }
        | Advice::ListPaints
        | Advice::Recover
        | Advice::StopExport
        | Advice::BeginExport
        | Advice::ListFormats
        | Advice::Replace
        | Advice::SaveOrForget
        | Advice::NamePainting
        | Advice::BeginPainting
        | Advice::StartRig
        | Advice::DefaultSettings => return None,
    };
    Some(words.to_owned())
}
