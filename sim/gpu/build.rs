//! Checks the shaders: an error in one is an error of the build.

#[path = "../../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    check_shaders::check_all("src/shaders", &["films.wgsl"])?;
    let shared = ["step", "shapes", "fragments"];
    let shared = shared.map(|name| format!("../steps/common/{name}.wgsl"));
    for (folder, own) in [
        ("steps", None),
        ("impasto", Some("axes")),
        ("dab", Some("blend")),
    ] {
        let own = own.map(|name| format!("common/{name}.wgsl"));
        let prefixes: Vec<&str> = shared.iter().chain(&own).map(String::as_str).collect();
        check_shaders::check_all(&format!("src/shaders/{folder}"), &prefixes)?;
    }
    check_shaders::check_all(
        "src/shaders/stokes",
        &[
            "common/window.wgsl",
            "common/sums.wgsl",
            "common/transfer.wgsl",
            "common/smoothing.wgsl",
        ],
    )
}
