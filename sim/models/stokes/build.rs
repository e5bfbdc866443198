//! Checks the shaders of the device part, so that a shader error is a build error.

#[cfg(feature = "device")]
#[path = "../../../tools/check_shaders.rs"]
mod check_shaders;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    #[cfg(feature = "device")]
    check_shaders::check_all(
        "src/device/shaders",
        &[
            "common/window.wgsl",
            "common/sums.wgsl",
            "common/transfer.wgsl",
            "common/smoothing.wgsl",
        ],
    )?;
    Ok(())
}
