//! Setup embedded in a take: settings of the rig and the files they name, each under
//! the hash of its bytes, so that it gives the same painting wherever it is played.
//!
//! In the MCAP file each of them is an attachment; the metadata record `maulstick.kit` names the
//! settings and what the strokes load.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Seek, Write};

use mcap::records::{Metadata, Record, op};
use sha2::{Digest as _, Sha256};

use maulstick_streams::mcap_records::Found;

/// Name of the metadata record.
const RECORD: &str = "maulstick.kit";
/// Key of the settings' attachment in it.
const SETTINGS: &str = "settings";
/// Prefix of the keys of the loads; four digits follow, so that they are in order.
const LOAD: &str = "load.";
/// Kinds of files, by the extension of their names.
const KINDS: [(&str, &str); 10] = [
    ("toml", "application/toml"),
    ("csv", "text/csv"),
    ("png", "image/png"),
    ("jpg", "image/jpeg"),
    ("jpeg", "image/jpeg"),
    ("tif", "image/tiff"),
    ("tiff", "image/tiff"),
    ("exr", "image/x-exr"),
    ("hdr", "image/vnd.radiance"),
    ("ora", "image/openraster"),
];

/// Setup of a take.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TakeSetup {
    /// Name of the settings among the files: a `rig.toml` whose paths are names of other ones.
    pub settings: String,
    /// Load of each stroke, in turn.
    pub loads: Vec<String>,
    /// Bytes by name: hash and extension.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Damage of an embedded setup.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum SetupError {
    /// A file that is not whole.
    #[error("a file that it embeds is damaged")]
    File,
    /// No settings under the hash that is stated.
    #[error("the settings that it embeds are missing, or not what they were")]
    Settings,
}

impl TakeSetup {
    /// True if files with this ending can be embedded.
    #[must_use]
    pub fn knows(extension: &str) -> bool {
        KINDS.iter().any(|(known, _)| *known == extension)
    }

    /// Takes a file in; its name, which is returned, ends in one of `KINDS`.
    pub fn add(&mut self, bytes: Vec<u8>, extension: &str) -> String {
        let name = name_of(&bytes, extension);
        self.files.insert(name.clone(), bytes);
        name
    }

    /// Reads the setup of a take from its records; `None` if it has none.
    ///
    /// # Errors
    /// [`SetupError`].
    pub(crate) fn read(records: &[Found<'_>]) -> Result<Option<Self>, SetupError> {
        let mut setup = Self::default();
        let mut stated = None;
        for found in records {
            if ![op::ATTACHMENT, op::METADATA].contains(&found.opcode) {
                continue;
            }
            let parsed = found
                .whole
                .then(|| mcap::parse_record(found.opcode, found.body));
            match parsed {
                Some(Ok(Record::Attachment { header, data, .. })) => {
                    let kind = header.name.split_once('.').map_or("", |(_, kind)| kind);
                    if Self::knows(kind) && header.name == name_of(&data, kind) {
                        setup.files.insert(header.name, data.into_owned());
                    }
                }
                Some(Ok(Record::Metadata(metadata))) if metadata.name == RECORD => {
                    stated = Some(metadata);
                }
                Some(Ok(_)) => {}
                Some(Err(_)) | None => return Err(SetupError::File),
            }
        }
        let Some(stated) = stated else {
            return Ok(None);
        };
        let settings = stated.metadata.get(SETTINGS);
        let settings = settings.filter(|name| setup.files.contains_key(*name));
        setup.settings = settings.ok_or(SetupError::Settings)?.clone();
        let loads = stated.metadata.iter();
        let loads = loads.filter(|(key, _)| key.starts_with(LOAD));
        setup.loads = loads.map(|(_, load)| load.clone()).collect();
        Ok(Some(setup))
    }

    pub(crate) fn write<W: Write + Seek>(
        &self,
        writer: &mut mcap::Writer<W>,
    ) -> mcap::McapResult<()> {
        for (name, bytes) in &self.files {
            let kind = KINDS.iter().find(|(kind, _)| name.ends_with(kind));
            writer.attach(&mcap::Attachment {
                log_time: 0,
                create_time: 0,
                name: name.clone(),
                media_type: kind.map_or("", |(_, media)| media).to_owned(),
                data: Cow::Borrowed(bytes),
            })?;
        }
        let loads = self.loads.iter().enumerate();
        let loads = loads.map(|(i, load)| (format!("{LOAD}{i:04}"), load.clone()));
        let metadata = loads.chain([(SETTINGS.to_owned(), self.settings.clone())]);
        writer.write_metadata(&Metadata {
            name: RECORD.to_owned(),
            metadata: metadata.collect(),
        })
    }
}

fn name_of(bytes: &[u8], extension: &str) -> String {
    let hash = Sha256::digest(bytes);
    let hash: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{hash}.{extension}")
}
