//! Rules of the house, checked against the sources of the workspace.
//!
//! | module | content |
//! | --- | --- |
//! | [`tree`] | files and packages of the workspace, or of a test |
//! | [`rules`] | the rules, each a function from a tree to its breaches |
//! | [`ledger`] | known breaches, which may only become fewer |
//! | `facts`, `modules` | what the rules need to know of a Rust file, and where a path's item is defined |
//!
//! `cargo run -p maulstick-house` takes out of `ledger.toml` what is a breach no more. It refuses to add anything,
//! unless `--allow` is given, which takes a commit that says why.

mod facts;
pub mod ledger;
mod modules;
pub mod rules;
pub mod tree;
