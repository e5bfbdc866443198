//! The simulation knows no transport: no crate under `sim/` depends on zenoh, by whatever way.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use serde_json::Value;

/// Crates of the workspace below a folder, with all crates that they depend on, but for tests and builds.
fn dependencies(metadata: &Value, folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let root = metadata["workspace_root"].as_str().expect("a root");
    let packages = metadata["packages"].as_array().expect("packages");
    let names: BTreeMap<&str, &str> = packages
        .iter()
        .map(|package| (text(package, "id"), text(package, "name")))
        .collect();
    let nodes = metadata["resolve"]["nodes"].as_array().expect("nodes");
    let edges: BTreeMap<&str, Vec<&str>> = nodes
        .iter()
        .map(|node| {
            let all = node["deps"].as_array().expect("deps").iter();
            let normal = all.filter(|dep| {
                let kinds = dep["dep_kinds"].as_array().expect("kinds");
                kinds.iter().any(|kind| kind["kind"].is_null())
            });
            (
                text(node, "id"),
                normal.map(|dep| text(dep, "pkg")).collect(),
            )
        })
        .collect();
    let below = format!("{root}/{folder}/");
    packages
        .iter()
        .filter(|package| text(package, "manifest_path").starts_with(&below))
        .map(|package| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![text(package, "id")]);
            while let Some(id) = open.pop() {
                for dep in &edges[id] {
                    if seen.insert(*dep) {
                        open.push(dep);
                    }
                }
            }
            let reached = seen.iter().map(|id| names[id].to_owned()).collect();
            (text(package, "name").to_owned(), reached)
        })
        .collect()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().expect("a text")
}

fn metadata() -> Value {
    // Crates of other platforms are not fetched, so that nothing is downloaded.
    let platform = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline"])
        .args(["--filter-platform", &platform])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout).expect(&errors)
}

#[test]
fn the_simulation_depends_on_no_transport() {
    let metadata = metadata();
    let simulation = dependencies(&metadata, "sim");
    assert!(simulation.len() >= 10, "{:?}", simulation.keys());
    for (name, reached) in &simulation {
        assert!(!reached.contains("zenoh"), "{name} reaches zenoh");
    }
    let daemons = dependencies(&metadata, "daemons");
    let node = &daemons["maulstick-brush-node"];
    assert!(
        node.contains("zenoh"),
        "a fault passes: the brush node hears the bus"
    );
}

#[test]
fn paint_knows_no_brush_a_model_no_light_and_light_no_brush() {
    let simulation = dependencies(&metadata(), "sim");
    let reaches = |name: &str, other: &str| {
        simulation[&format!("maulstick-{name}")].contains(&format!("maulstick-{other}"))
    };
    for (name, unknown) in [
        ("canvas", ["brush", "optics", "impasto", "appearance"]),
        ("model", ["optics", "appearance", "painting", "document"]),
        ("impasto", ["dab", "stokes", "painting", "document"]),
        ("dab", ["impasto", "marker", "painting", "document"]),
        ("convert", ["impasto", "dab", "stokes", "painting"]),
        ("gpu", ["impasto", "dab", "stokes", "painting"]),
        ("appearance", ["brush", "impasto", "painting", "document"]),
    ] {
        for other in unknown {
            assert!(!reaches(name, other), "{name} reaches {other}");
        }
    }
    assert!(
        reaches("painting", "brush") && reaches("painting", "optics"),
        "a fault passes: the painting knows them all"
    );
}
