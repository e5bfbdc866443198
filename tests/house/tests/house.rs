//! The rules hold but for what the ledger has, and each finds a seeded fault.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use maulstick_house::ledger::Ledger;
use maulstick_house::rules::{Breaches, RULES, Rule};
use maulstick_house::tree::Tree;

static TREE: LazyLock<Tree> = LazyLock::new(|| Tree::read().expect("sources"));
static LEDGER: LazyLock<Ledger> = LazyLock::new(|| Ledger::read().expect("a ledger"));

fn rule(name: &str) -> &'static Rule {
    let rule = RULES.iter().find(|rule| rule.0 == name);
    rule.expect("a rule of this name")
}

fn tree(texts: &[(&str, &str)]) -> Tree {
    let texts = texts
        .iter()
        .map(|(path, text)| ((*path).to_owned(), (*text).to_owned()));
    Tree::of(texts.collect()).expect("sources")
}

/// Complaints of the tree by a rule, which finds a fault in these texts.
fn check(name: &str, texts: &[(&str, &str)], fault: &str) -> Vec<String> {
    let found = Breaches::of(rule(name), &tree(texts));
    let keys: Vec<_> = found.0.iter().map(|breach| &breach.key[..]).collect();
    assert_eq!(keys, fault.split(" + ").collect::<Vec<_>>(), "{found:?}");
    LEDGER.complaints(rule(name), &TREE)
}

const REGISTRY: (&str, &str) = ("sim/models/dab/src/entry.rs", "const A: &str = \"dab\";");

macro_rules! rules {
    ($($name:literal $texts:expr => $fault:literal;)*) => {
        /// All rules by one reading of the tree.
        #[test]
        fn the_tree_keeps_the_rules_and_each_finds_its_fault() {
            let mut complaints = Vec::new();
            $(complaints.extend(check($name, &$texts, $fault));)*
            assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
        }
    };
}

rules! {
    "cycles" [
        ("sim/a/src/lib.rs", "mod a; mod b; mod c { pub use crate::a::A; }"),
        ("sim/a/src/a.rs", "use super::b::B; pub struct A; #[cfg(test)] mod tests { use crate::d::D; }"),
        ("sim/a/src/b.rs", "mod d; pub struct B; fn f() { use_it!(crate::c::A) }"),
        ("sim/a/src/b/d.rs", "use super::B;"),
    ] => "sim/a/src/a.rs + sim/a/src/b.rs";
    "files" [("ui/a.wgsl", &"\n".repeat(501)), ("ui/b.wgsl", &"\n".repeat(500))] => "ui/a.wgsl";
    "folders" [
        ("a/1.py", ""), ("a/2.py", ""), ("a/3.py", ""), ("a/4.py", ""), ("a/5.py", ""), ("a/6.py", ""),
        ("a/7.py", ""), ("a/8.py", ""), ("a/9.py", ""), ("a/a.py", ""), ("a/b.py", ""), ("a/c.py", ""),
        ("a/d.py", ""), ("a/e.py", ""), ("a/f.py", ""), ("a/g.rs", ""), ("a/b/h.py", ""),
    ] => "a";
    "structs" [("a/b.rs", &format!(
        "struct A({}); wire_struct! {{ struct B({}); }}", "u8, ".repeat(16), "u8, ".repeat(17),
    ))] => "a/b.rs::B";
    "functions" [("a/b.rs", &format!(
        "impl A {{ fn f() {{ g();{0}}} }} fn g() -> [f64; 2] {{ [0.0,{0}1.0] }}", "\n".repeat(60),
    ))] => "a/b.rs::A::f";
    "impls" [
        ("a/Cargo.toml", "[package]\nname = \"a\""), ("a/1.rs", "impl A {}"), ("a/2.rs", "impl A {}"), ("a/3.rs", "impl A {}"), ("a/4.rs", "impl A {}"),
        ("a/5.rs", "impl A {}"), ("a/6.rs", "impl A {}"), ("a/7.rs", "impl A {} impl B for C {}"),
        ("a/8.rs", "impl B for C {}"),
    ] => "a: impl A";
    "models" [
        REGISTRY,
        ("sim/models/dab/src/lib.rs", "const A: &str = \"dab\";"),
        ("sim/a/src/lib.rs", "use maulstick_dab::Dab; const A: &str = \"a dab of paint\";"),
        ("sim/b/dab/lib.rs", "fn f(name: &str) -> bool { name == \"dab\" }"),
    ] => "sim/a/src/lib.rs + sim/b/dab/lib.rs";
    "graphics" [
        REGISTRY, ("sim/gpu/src/b.rs", "fn f() { Gpu::dab(); }"),
        ("sim/gpu/Cargo.toml", "[package]\nname = \"g\"\n[dependencies]\nd = \"1\""),
        ("sim/models/dab/Cargo.toml", "[package]\nname = \"d\""),
    ] => "sim/gpu/src/b.rs + sim/gpu";
    "edits" [
        ("sim/painting/src/edits/layer/go_to.rs", "use crate::Edit; fn f() { Edit::GoTo }"),
        ("sim/painting/src/edits/form.rs", "pub trait Form {}"),
        ("ui/src/panels/a.rs", "use maulstick_painting::edits::GoTo;"),
        ("launch/src/a.rs", "use maulstick_painting::edits::{Form, layer::GoTo};"),
        ("launch/src/b.rs", "fn f(a: &E) -> bool { matches!(a, Edit::GoTo(_)) }"),
    ] => "launch/src/a.rs + launch/src/b.rs";
    "clocks" [
        ("sim/a/src/lib.rs", "use std::process::Command; use std::time::Duration;"),
        ("sim/a/src/b.rs", "fn f() { std::time::Instant::now(); }"),
        ("ui/src/lib.rs", "use std::process::Command;"),
    ] => "sim/a/src/b.rs + sim/a/src/lib.rs";
    "layers" [
        ("msgs/a/Cargo.toml", "[package]\nname = \"a\"\n[dependencies]\nb = \"1\""),
        ("daemons/b/Cargo.toml", "[package]\nname = \"b\"\n[build-dependencies]\nc.workspace = true"),
        ("sim/c/Cargo.toml", "[package]\nname = \"c\"\n[dev-dependencies]\na = \"1\""),
    ] => "msgs/a";
    "parsed-words" [
        ("sim/a.rs", "fn f() { format!(\"model {a} proposed\"); }"),
        ("ui/a.rs", "const A: &str = \"model \"; fn f(text: &str) { text.strip_prefix(A); }"),
        ("ui/b.rs", "fn f(text: &str) { text.strip_prefix(\"ttyACM of the kernel\"); }"),
        ("ui/c.rs", "fn f(text: &str) -> bool { text == \"model dab proposed\" }"),
    ] => "ui/a.rs + ui/c.rs";
    "asserted-words" [
        ("ui/kit/src/language/a.rs", "fn f() { assert!(a.contains(\"two words\")); }"),
        ("sim/a.rs", "#[cfg(test)] mod tests { fn f() { assert!(a.is_err_and(|b| b.contains(\"two words\"))); } }"),
        ("sim/b.rs", "fn f() { assert!(a.contains(\"word\") && b); a.contains(\"two words\"); }"),
        ("sim/c.rs", "fn f() { assert!(a.contains(\"'Cobalt Blue'\")); }"),
        ("sim/d.rs", "fn f() { assert!(a.starts_with(\"Two words\")); }"),
    ] => "sim/a.rs + sim/d.rs";
    "text-errors" [
        ("ui/src/main.rs", "fn f() -> Result<(), String> {}"),
        ("ui/src/a.rs", "fn f() -> Result<(), String> {} fn g() -> Result<String, A> {}"),
        ("ui/src/b.rs", "#[cfg(test)] fn f() -> Result<(), String> {}"),
    ] => "ui/src/a.rs";
    "totals" [
        ("launch/Cargo.toml", "[package]\nname = \"maulstick\""), ("ui/a.rs", &"\n".repeat(30_000)),
        ("launch/a.rs", &"\n".repeat(14_001)),
        ("launch/b.rs", &format!("#[cfg(test)] mod a {{ {} }}", "\n".repeat(14_000))),
        ("README.md", &"word ".repeat(700)), ("docs/performance.md", &"word ".repeat(1501)),
    ] => "launch, goal 14000 lines + performance, goal 1500 words";
}

#[test]
fn the_ledger_refuses_what_is_new_and_what_is_mended() {
    let long = |lines| tree(&[("ui/a.rs", &"\n".repeat(lines)), ("ui/b.rs", "")]);
    let before = Ledger::of(&long(600));
    let complaints = |lines| before.complaints(rule("files"), &long(lines)).len();
    assert_eq!([600, 571, 601, 560, 400].map(complaints), [0, 0, 1, 1, 1]);
    assert_eq!(
        Ledger::default()
            .complaints(rule("files"), &long(600))
            .len(),
        1
    );
    assert_eq!(
        Ledger::of(&long(601)).more_than(&before),
        ["files: ui/a.rs = 601"]
    );
    assert!(Ledger::of(&long(400)).more_than(&before).is_empty());
    let empty = BTreeMap::new();
    assert_eq!(
        Ledger::of(&Tree::of(empty).expect("nothing")),
        Ledger::default()
    );
}
