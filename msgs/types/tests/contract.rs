//! Messages of devices of the contract's first version, which are understood for ever.

use std::collections::BTreeSet;

use maulstick_types::{CATALOGUE, HEADER_BYTES, STYLUS_CONTRACT};

/// Messages as they were when the contract began, each followed by what it said. No line is ever changed.
const FIRST: &str = include_str!("contract.txt");

/// Size limits of the messages, which stay.
const LIMITS: [(&str, usize); 9] = [
    ("StylusSample", 512),
    ("StylusInfo", 1024),
    ("StylusStatus", 4096),
    ("ControlSample", 256),
    ("ContactModel", 4096),
    ("FluidForce", 2048),
    ("ForceRequest", 256),
    ("ForceReply", 1024),
    ("GapRequest", 64),
];

/// Name, version, hash, bytes and words of each.
fn messages() -> Vec<(&'static str, u16, u32, Vec<u8>, &'static str)> {
    let blocks = FIRST.split("\n\n").filter(|block| !block.is_empty());
    let read = |block: &'static str| {
        let (head, words) = block.split_once('\n').expect("a line of bytes, then words");
        let mut head = head.split([' ', '/']);
        let mut next = || head.next().expect("name/version hash bytes");
        let (name, version, hash, hex) = (next(), next(), next(), next());
        let byte = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal");
        let bytes = (0..hex.len()).step_by(2).map(byte).collect();
        let hash = u32::from_str_radix(hash, 16).expect("hexadecimal");
        (
            name,
            version.parse().expect("a number"),
            hash,
            bytes,
            words.trim_end(),
        )
    };
    blocks.map(read).collect()
}

#[test]
fn what_the_first_version_said_is_still_understood() {
    assert_eq!(STYLUS_CONTRACT, "stylus/1");
    for (name, version, hash, bytes, words) in messages() {
        let entry = CATALOGUE
            .iter()
            .find(|entry| entry.name == name)
            .expect(name);
        assert!(entry.in_contract && entry.version >= version, "{name}");
        assert_eq!(
            (entry.schema)().hash,
            hash,
            "{name}: devices out there carry this hash"
        );
        let read = (entry.show)(version, &bytes[HEADER_BYTES..]).expect(name);
        // What was appended stands at the end.
        let words = words.strip_suffix('}').unwrap_or(words);
        assert!(
            read.starts_with(words),
            "{name} said\n{words}\nand is read as\n{read}"
        );
        // And what a later version will append is left alone, behind what this one has appended.
        let own = if entry.version > version {
            vec![0; entry.max_bytes - (bytes.len() - HEADER_BYTES)]
        } else {
            Vec::new()
        };
        let longer = [&bytes[HEADER_BYTES..], &own, &[1; 16]].concat();
        let read = (entry.show)(u16::MAX, &longer).expect(name);
        assert!(read.starts_with(words), "{name} is read as\n{read}");
    }
}

#[test]
fn every_message_of_the_contract_has_its_first_bytes() {
    let first: BTreeSet<&str> = messages().into_iter().map(|message| message.0).collect();
    let of = |entry: &&maulstick_types::CatalogueEntry| entry.in_contract;
    let now: BTreeSet<&str> = CATALOGUE
        .iter()
        .filter(of)
        .map(|entry| entry.name)
        .collect();
    assert_eq!(first, now);
    for entry in CATALOGUE.iter().filter(of) {
        let limit = LIMITS.iter().find(|(name, _)| *name == entry.name);
        assert_eq!(
            limit.map(|(_, bytes)| *bytes),
            Some(entry.max_bytes),
            "{}",
            entry.name
        );
    }
}
