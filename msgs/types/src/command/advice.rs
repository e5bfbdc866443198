//! Advice about an error: the name that was meant, and advice that each front end has its own words
//! for.

use std::fmt;

use crate::wire::define::wire_enum;

wire_enum! {
    /// Advice with a refusal. A window, a command line and a script say it in their own words, by a table from these
    /// variants; who has none says it as `Display` does.
    #[derive(Eq)]
    pub enum Advice {
        /// Words that hold everywhere.
        Say {
            /// The words.
            help: String,
        },
        /// Stop the drying, or wait for its end.
        StopDrying,
        /// Begin a drying.
        BeginDrying,
        /// Dry wet paint first.
        DryFirst,
        /// Make a layer as opaque as it was laid.
        FullOpacity {
            /// Number of the layer.
            layer: u32,
        },
        /// Look at the list of paints.
        ListPaints,
        /// Undo the newest step of all first.
        UndoNewest,
        /// Take out of a damaged painting what is whole.
        Recover,
        /// Stop the export, or wait for its end.
        StopExport,
        /// Begin an export.
        BeginExport,
        /// See what each format takes.
        ListFormats,
        /// Give another name, or say that the file that is there may go.
        Replace,
        /// Save the painting first, or say that it may go.
        SaveOrForget,
        /// Name a painting's file, or a new one; of a damaged one take out what is whole.
        NamePainting,
        /// Check the path, or begin a painting there.
        BeginPainting,
        /// Start a rig, or name another one.
        StartRig,
        /// Compare with the default settings.
        DefaultSettings,
    }
}

impl Advice {
    /// Advice in words.
    #[must_use]
    pub fn say(help: impl Into<String>) -> Self {
        Self::Say { help: help.into() }
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Say { help } => help,
            Self::StopDrying => "wait for its end, or stop it",
            Self::BeginDrying => "begin a drying first",
            Self::DryFirst => "dry wet paint first",
            Self::FullOpacity { layer } => {
                return write!(f, "set the opacity of layer {layer} to 1 first");
            }
            Self::ListPaints => "choose one of the paints of the rig",
            Self::UndoNewest => "undo that first",
            Self::Recover => "recover from the file what is whole",
            Self::StopExport => "wait for its end, or stop it",
            Self::BeginExport => "begin an export first",
            Self::ListFormats => "see what each format takes",
            Self::Replace => "give another name, or say that the one that is there may go",
            Self::SaveOrForget => "save it first, or say that it may go",
            Self::NamePainting => {
                "name the file of a painting, or a new one; of a damaged painting recover what is whole"
            }
            Self::BeginPainting => "check the path, or begin a painting there",
            Self::StartRig => "start one, or name another one",
            Self::DefaultSettings => "compare with the default settings",
        })
    }
}
