//! The command line's words for the advice that comes with a refusal.

use maulstick_types::command::advice::Advice;

/// Remedy on a command line; `None` where the general words suffice.
#[must_use]
pub fn words(advice: &Advice) -> Option<String> {
    let words = match advice {
        Advice::StopDrying => "wait for its end, or stop it: `maulstick layer dry --stop`",
        Advice::BeginDrying => "`maulstick layer dry --over 90s` begins one",
        Advice::DryFirst => "`maulstick layer dry` dries wet paint into a layer",
        Advice::FullOpacity { layer } => {
            return Some(format!(
                "`maulstick layer opacity {layer} 1` makes it as it was laid"
            ));
        }
        Advice::ListPaints => "`maulstick colour paints` lists them all",
        Advice::UndoNewest => {
            "undo that first: `maulstick undo` without a brush takes the newest step of all"
        }
        Advice::Recover => "`maulstick painting recover FILE -o NEW.maul` takes out what is whole",
        Advice::StopExport => "wait for its end, or stop it: `maulstick painting export --stop`",
        Advice::BeginExport => "`maulstick painting export -o FILE` begins an export",
        Advice::ListFormats => "`maulstick painting export --help` says what each format takes",
        Advice::Replace => {
            "give another name, or allow the existing file to be replaced: `--replace`"
        }
        Advice::SaveOrForget => {
            "keep it first: `maulstick painting save-as FILE.maul`; or say that it may go: `--forget`"
        }
        Advice::NamePainting => {
            "give a file that `maulstick up FILE.maul` made, or a new name; of a painting whose beginning is \
             damaged `maulstick painting recover FILE -o NEW.maul` takes out what is whole"
        }
        Advice::BeginPainting => "check the path; `maulstick up FILE.maul` begins a painting",
        Advice::StartRig => "start one with `maulstick up`, or name another with `--name`",
        Advice::DefaultSettings => "see the commented default: `maulstick up --print-config`",
        Advice::Say { .. } => return None,
    };
    Some(words.to_owned())
}
