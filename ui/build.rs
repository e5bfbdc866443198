//! Checks the shaders: an error in one is an error of the build.

#[path = "../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    check_shaders::check_all("src/render/shaders", &[])
}
