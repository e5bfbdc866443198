//! Backend of the paint's steps: as `[paint] backend` or `--backend` say.

use maulstick_gpu::{Choice, Device};
use maulstick_models::model_called;
use maulstick_painting::Sequencer;
use maulstick_rig::UserError;
use maulstick_types::paint::Decision;
use maulstick_types::scene::CANVAS;

/// Setting of the backend.
const PLACE: &str = "backend of [paint], or --backend";

/// Selects the GPU for a painting's steps, and journals that, if the settings request it and there is one:
/// `auto` uses a separate graphics processor, for steps that it computes faster; `gpu` uses any, for all steps that it
/// can compute.
///
/// # Errors
/// A [`UserError`] if a GPU is required and there is none.
pub fn choose_backend(sequencer: &mut Sequencer, backend: &str) -> Result<(), UserError> {
    let choice = match backend {
        "cpu" => return Ok(()),
        "gpu" => Choice::Forced,
        _ => Choice::Auto,
    };
    let name = sequencer.painting().model(CANVAS).unwrap_or_default();
    let Some(make) = model_called(name).ok().and_then(|entry| entry.make_on) else {
        return match choice {
            Choice::Auto => Ok(()),
            Choice::Forced => Err(UserError::usage(format!(
                "no GPU computes the paint model '{name}'"
            ))
            .at(PLACE)
            .help("leave the choice to the rig: backend = \"auto\"")),
        };
    };
    let made = Device::open(choice).and_then(|gpu| make(gpu, choice));
    match (made, choice) {
        (Ok(made), _) => {
            sequencer.painting_mut().set_model(made.model);
            let name = sequencer.painting().backend();
            tracing::info!("paint is computed by {name}");
            sequencer.decide(Decision::Backend { name });
            Ok(())
        }
        (Err(_), Choice::Auto) => Ok(()),
        (Err(error), Choice::Forced) => Err(UserError::failure(format!(
            "paint cannot be computed by a GPU: {error}"
        ))
        .at(PLACE)
        .help("install a Vulkan driver, or leave the choice to the rig: backend = \"auto\"")),
    }
}
