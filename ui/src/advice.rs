//! The window's words for the advice that comes with a refusal.

use maulstick_types::command::advice::Advice;

/// What to do about it in this window; `None` where the general words do.
#[must_use]
pub(crate) fn words(advice: &Advice) -> Option<String> {
    let words = match advice {
        Advice::StopDrying => tr!("wait for its end, or press Stop in the panel Layers"),
        Advice::BeginDrying => tr!("press Start in the panel Layers"),
        Advice::DryFirst => tr!("press Dry in the panel Layers"),
        Advice::FullOpacity { layer } => {
            return Some(tr!(
                "set the opacity of layer {layer} to 100 % in the panel Layers",
                layer
            ));
        }
        Advice::ListPaints => tr!("choose one of the panel Tubes"),
        Advice::UndoNewest => tr!("undo that first: Undo takes the newest step of all"),
        Advice::StopExport => tr!("wait for its end, or press Stop"),
        Advice::Replace => tr!("write another name, or tick that the one that is there may go"),
        Advice::SaveOrForget => tr!("save it under another name first, or tick that it may go"),
        Advice::Say { .. }
        | Advice::Recover
        | Advice::BeginExport
        | Advice::ListFormats
        | Advice::NamePainting
        | Advice::BeginPainting
        | Advice::StartRig
        | Advice::DefaultSettings => return None,
    };
    Some(words.to_owned())
}
