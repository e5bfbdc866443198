//! Checks the shaders of the twin on a device: an error in one is an error of the build.

#[cfg(feature = "device")]
#[path = "../../../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    #[cfg(feature = "device")]
    check_shaders::check_all(
        "src/device/shaders",
        &[
            "../../../../../gpu/src/shaders/steps/common/step.wgsl",
            "../../../../../gpu/src/shaders/steps/common/shapes.wgsl",
            "../../../../../gpu/src/shaders/steps/common/fragments.wgsl",
            "common/blend.wgsl",
        ],
    )?;
    Ok(())
}
