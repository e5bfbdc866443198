//! `maulstick colour chart`: every paint with every other.

use maulstick_painting_setup::library_from;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_tool_options::figures::ChartOptions;

use crate::chart::every_pair::chart;

pub(super) fn run(options: &ChartOptions) -> Result<i32, UserError> {
    let library = library_from(options.paints.as_deref())?;
    let output = UsedFile::new("the picture", &options.output).of(Kind::Png);
    let inputs = UsedFile::given("the paints", options.paints.as_ref()).into_iter();
    let inputs: Vec<_> = inputs
        .chain(UsedFile::light(&options.viewing.illuminant))
        .collect();
    check_outputs(&[output], &inputs)?;
    let viewing = options.viewing.viewing(&library)?;
    super::write(&chart(&library, &viewing)?, &options.output)?;
    Ok(0)
}
