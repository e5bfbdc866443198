//! Writes the ledger of known breaches anew.

use anyhow::{Result, bail};
use maulstick_house::ledger::Ledger;
use maulstick_house::tree::Tree;

fn main() -> Result<()> {
    let allow = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--allow") => true,
        Some(other) => bail!("unknown argument '{other}'; give none, or --allow"),
    };
    let (before, now) = (Ledger::read()?, Ledger::of(&Tree::read()?));
    let more = now.more_than(&before);
    if !more.is_empty() && !allow {
        let more = more.join("\n");
        bail!(
            "the ledger may not grow:\n{more}\nmend this, or give --allow and say why in the commit"
        );
    }
    now.write()
}
