//! The window's words for requests that were not carried out.

use maulstick_client::dispatcher::RequestError;
use maulstick_rig::UserError;
use maulstick_types::command::advice::Advice;

/// The reason why a request was not carried out, in the window's words.
#[must_use]
pub(crate) fn worded(error: &RequestError) -> UserError {
    match error {
        RequestError::NotSent => UserError::failure(tr!("it was not sent")),
        RequestError::Refused(fault) => fault.clone().worded(words),
    }
}

/// Remedy in this window; `None` where the general words suffice.
#[must_use]
fn words(advice: &Advice) -> Option<String> {
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
        Advice::Replace => {
            tr!("enter another name, or tick that the existing file may be replaced")
        }
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
