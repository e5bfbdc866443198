//! What a take is painted with, embedded in it: settings of the rig and the files they name, each under
//! the hash of its bytes, so that it gives the same painting wherever it is played.
//!
//! In the MCAP file each of them is an attachment; the metadata record `maulstick.kit` names the
//! settings and what the strokes load.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Seek, Write};

use mcap::McapError;
use mcap::read::{LinearReader, Options};
use mcap::records::{Metadata, Record, op};
use sha2::{Digest as _, Sha256};

/// Name of the metadata record.
const RECORD: &str = "maulstick.kit";
/// Key of the settings' attachment in it.
const SETTINGS: &str = "settings";
/// What the keys of the loads begin with; four digits follow, so that they are in order.
const LOAD: &str = "load.";
/// Most bytes of one embedded file.
const FILE_MAX: usize = 16 << 20;
/// Opcode and length of a record, bytes.
const RECORD_HEAD: usize = 9;
/// The first opcode that MCAP leaves to applications.
const PRIVATE_RECORD: u8 = 0x80;
/// Kinds of files, by the extension of their names.
const KINDS: [(&str, &str); 2] = [("toml", "application/toml"), ("csv", "text/csv")];

/// What a take is painted with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Kit {
    /// Name of the settings among the files: a `rig.toml` whose paths are names of other ones.
    pub settings: String,
    /// What each stroke loads, in turn.
    pub loads: Vec<String>,
    /// Bytes by name: hash and extension.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Kit {
    /// Takes a file in; `extension` is `toml` or `csv`. Its name is returned.
    pub fn add(&mut self, bytes: Vec<u8>, extension: &str) -> String {
        let name = name_of(&bytes, extension);
        self.files.insert(name.clone(), bytes);
        name
    }

    /// Reads that of a take; none where it has none.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub(crate) fn read(take: &[u8]) -> Result<Option<Self>, String> {
        let ignore = Options::IgnoreEndMagic.into();
        let Ok(records) = LinearReader::new_with_options(take, ignore) else {
            return Ok(None);
        };
        let mut kit = Self::default();
        let mut told = None;
        for record in records {
            let record = match record {
                Ok(record) => record,
                Err(McapError::BadAttachmentCrc { .. }) => continue,
                // The samples say themselves where a file is damaged behind its kit.
                Err(_) => break,
            };
            match record {
                Record::Attachment { header, data, .. } => {
                    let hashed = KINDS
                        .iter()
                        .any(|(kind, _)| header.name == name_of(&data, kind));
                    if hashed && data.len() <= FILE_MAX {
                        kit.files.insert(header.name, data.into_owned());
                    }
                }
                Record::Metadata(metadata) if metadata.name == RECORD => told = Some(metadata),
                _ => {}
            }
        }
        let Some(told) = told else {
            return Ok(None);
        };
        let settings = told.metadata.get(SETTINGS);
        let settings = settings.filter(|name| kit.files.contains_key(*name));
        kit.settings = settings
            .ok_or("the settings that it embeds are missing, or not what they were")?
            .clone();
        let loads = told.metadata.iter();
        let loads = loads.filter(|(key, _)| key.starts_with(LOAD));
        kit.loads = loads.map(|(_, load)| load.clone()).collect();
        Ok(Some(kit))
    }

    /// Makes what a take embeds, whole or not, records that readers of samples pass over.
    pub(crate) fn hide(take: &mut [u8]) {
        let mut at = mcap::MAGIC.len();
        while let Some(head) = take.get_mut(at..at + RECORD_HEAD) {
            if [op::ATTACHMENT, op::METADATA].contains(&head[0]) {
                head[0] = PRIVATE_RECORD;
            }
            let mut length = [0; 8];
            length.copy_from_slice(&head[1..]);
            let length = usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX);
            at = at.saturating_add(RECORD_HEAD).saturating_add(length);
            if at > take.len() {
                break;
            }
        }
    }

    pub(crate) fn write<W: Write + Seek>(
        &self,
        writer: &mut mcap::Writer<W>,
    ) -> mcap::McapResult<()> {
        for (name, bytes) in &self.files {
            let kind = KINDS
                .iter()
                .find(|(extension, _)| name.ends_with(extension));
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
