//! Decoders survive anything.

use maulstick_types::CATALOGUE;
use proptest::prelude::*;

proptest! {
    #[test]
    fn no_bytes_make_a_decoder_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for entry in CATALOGUE {
            for version in [0, entry.version, u16::MAX] {
                drop((entry.show)(version, &bytes));
            }
        }
    }

    #[test]
    fn no_mutation_of_a_message_makes_a_decoder_panic(
        place in any::<prop::sample::Index>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
    ) {
        let golden: Vec<&str> = include_str!("golden.txt").lines().collect();
        let hex = golden[place.index(golden.len())].split(' ').nth(2).unwrap_or_default();
        let mut bytes: Vec<u8> = (48..hex.len() / 2)
            .map(|at| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).unwrap_or(0))
            .collect();
        for (at, byte) in flips {
            if !bytes.is_empty() {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
        }
        bytes.truncate(cut.index(bytes.len() + 1).max(bytes.len() / 2));
        for entry in CATALOGUE {
            for version in [0, entry.version, u16::MAX] {
                drop((entry.show)(version, &bytes));
            }
        }
    }
}

#[test]
fn nine_hostile_bytes_do_not_claim_all_memory() {
    let hostile = [0xff; 9];
    for entry in CATALOGUE {
        assert!(
            (entry.show)(entry.version, &hostile).is_err(),
            "{}",
            entry.name
        );
    }
}
