//! Checks the shaders: an error in one is an error of the build.

#[path = "../../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    check_shaders::check_all("src/shaders", &["films.wgsl"])?;
    check_shaders::check_all(
        "src/shaders/impasto",
        &[
            "common/impasto.wgsl",
            "common/shapes.wgsl",
            "common/axes.wgsl",
        ],
    )?;
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
