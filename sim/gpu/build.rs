//! Checks the shaders, so that a shader error is a build error.

#[path = "../../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    check_shaders::check_all("src/shaders", &["films.wgsl"])?;
    let shared = ["step", "shapes", "fragments"].map(|name| format!("common/{name}.wgsl"));
    check_shaders::check_all("src/shaders/steps", &shared.each_ref().map(String::as_str))
}
