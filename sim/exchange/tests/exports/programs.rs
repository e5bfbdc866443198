//! The programs that painters and printers use, where they are installed.

use std::io::Read as _;
use std::path::Path;
use std::process::Command;

use crate::support::{decoded, file, painted};

/// Output of a program, within two minutes, at home in `folder`; `None` if it is absent.
fn says(folder: &Path, program: &str, arguments: &[&str]) -> Option<String> {
    let mut command = Command::new("timeout");
    command.arg("120").arg(program).args(arguments);
    let output = command.env("HOME", folder).output().expect("coreutils");
    if output.status.code() == Some(127) {
        println!("skipped: there is no {} here", arguments.join(" "));
        return None;
    }
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    println!("{program} {arguments:?}: {}\n{said}", output.status);
    assert!(output.status.success());
    Some(said)
}

/// The painting in a file of the export called `name`.
fn written(folder: &Path, name: &str, path: &str) -> String {
    let path = folder.join(path);
    std::fs::write(&path, file(name, &mut painted())).expect("written");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn openexrs_own_tools_read_it() {
    let home = tempfile::tempdir().expect("a folder");
    let path = written(home.path(), "OpenEXR", "painting.exr");
    if let Some(said) = says(home.path(), "exrheader", &[&path]) {
        for part in [
            "wet.Pyrrole_Red, 32-bit floating-point",
            "chromaticities",
            "101.6",
        ] {
            assert!(said.contains(part), "{part}");
        }
    }
    // This one unpacks every channel.
    says(
        home.path(),
        "exrmaketiled",
        &[&path, &format!("{path}.tiled")],
    );
}

#[test]
fn krita_sees_the_same_picture() {
    let home = tempfile::tempdir().expect("a folder");
    let path = written(home.path(), "OpenRaster", "painting.ora");
    let back = format!("{path}.back.ora");
    let krita = ["-a", "krita", "--export", "--export-filename", &back, &path];
    if says(home.path(), "xvfb-run", &krita).is_none() {
        return;
    }
    let merged = |path: &str| {
        let file = std::fs::File::open(path).expect("written");
        let mut archive = zip::ZipArchive::new(file).expect("a zip");
        let mut bytes = Vec::new();
        let mut entry = archive.by_name("mergedimage.png").expect("a picture");
        entry.read_to_end(&mut bytes).expect("whole");
        let (info, pixels) = decoded(&bytes);
        let pixels = pixels.chunks_exact(info.color_type.samples());
        pixels
            .flat_map(|pixel| pixel[..3].to_vec())
            .collect::<Vec<u8>>()
    };
    assert!(merged(&path) == merged(&back));
}

#[test]
fn gimp_opens_pictures() {
    let home = tempfile::tempdir().expect("a folder");
    let Some(version) = says(home.path(), "gimp", &["--version"]) else {
        return;
    };
    for (name, path) in [
        ("PNG, 16 bits", "lit.png"),
        ("height map", "height.png"),
        ("OpenEXR", "painting.exr"),
    ] {
        let path = written(home.path(), name, path);
        // Since version 3 a file has one name.
        let names = if version.contains(" 2.") { 2 } else { 1 };
        let names = format!("\"{path}\" ").repeat(names);
        let load = format!("(gimp-file-load RUN-NONINTERACTIVE {names})");
        let batch = ["--no-interface", "--no-data", "--no-fonts", "-b", &load];
        let said = says(
            home.path(),
            "gimp",
            &[&batch[..], &["-b", "(gimp-quit 0)"]].concat(),
        );
        let said = said.expect("it is here");
        assert!(said.contains("successfully"), "{name}");
    }
}
