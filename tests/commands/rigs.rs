//! The example rigs.

use std::path::Path;

use maulstick_rig::RigConfig;

const RIGS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/rigs");

#[test]
fn each_example_rig_is_valid_says_how_it_is_started_and_is_named_in_the_guide() {
    let guide = include_str!("../../docs/devices.md");
    let mut names = Vec::new();
    for entry in Path::new(RIGS).read_dir().expect("the rigs") {
        let path = entry.expect("a rig").path();
        // A rig that was run may have put recordings beside its file.
        if path.extension().is_none_or(|kind| kind != "toml") {
            continue;
        }
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a name");
        let config = RigConfig::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.contains(&format!("maulstick up --rig launch/rigs/{name}")));
        assert!(
            guide.contains(&format!("(../launch/rigs/{name})")),
            "{name} is not in the guide"
        );
        let misspelt = text.replacen("driver", "drvier", 1);
        assert!(
            RigConfig::parse(&misspelt, name).is_err(),
            "a fault passes in {name}"
        );
        names.push(config.rig.name);
    }
    names.sort_unstable();
    assert_eq!(names, ["home", "lab", "studio", "two-hands"]);
}
