//! The motion of one stylus out of a recording of several.

use std::path::Path;

use maulstick_device::{Take, TakeSample};
use maulstick_rig::UserError;
use maulstick_streams::Recording;
use maulstick_types::decode;
use maulstick_types::stylus::StylusSample;

/// Reads a take, or of a recording the samples of `device`.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read, or has no samples of that device.
pub(crate) fn read_motion(path: &Path, device: Option<&str>) -> Result<Take, UserError> {
    let Some(device) = device else {
        return Take::read(path);
    };
    let mut recording = Recording::open(path)?;
    let own = format!("stylus/{device}/sample");
    let topics = recording.topics().clone();
    let devices: Vec<&str> = topics
        .values()
        .filter_map(|topic| topic.name.strip_prefix("stylus/")?.strip_suffix("/sample"))
        .collect();
    if !devices.contains(&device) {
        let what = format!("it has no samples of '{device}'");
        return Err(UserError::unknown(what, device, devices).at(path.display().to_string()));
    }
    let mut samples: Vec<TakeSample> = Vec::new();
    let mut fault = None;
    recording.messages([0, u64::MAX], &mut |message| {
        let is_own = topics
            .get(&message.channel)
            .is_some_and(|topic| topic.name == own);
        if is_own {
            match decode::<StylusSample>(&message.bytes) {
                // Faulty samples are skipped.
                Ok((header, sample)) if sample.fault().is_none() => {
                    let time_ns = header.event_ns;
                    samples.push(TakeSample { time_ns, sample });
                }
                Ok(_) => {}
                Err(error) => fault = Some(error.to_string()),
            }
        }
        fault.is_none()
    })?;
    if let Some(fault) = fault {
        return Err(
            UserError::usage(format!("a sample cannot be read: {fault}"))
                .at(path.display().to_string())
                .help("cut it with the version of Maulstick that recorded it"),
        );
    }
    // A sample may have come late, or twice.
    samples.sort_by_key(|own| own.time_ns);
    samples.dedup_by_key(|own| own.time_ns);
    let begin_ns = samples.first().map_or(0, |first| first.time_ns);
    for sample in &mut samples {
        sample.time_ns -= begin_ns;
    }
    if samples.is_empty() {
        let what = format!("no sample of '{device}' is in it");
        return Err(UserError::usage(what)
            .at(path.display().to_string())
            .help("`maulstick recording info` lists what it has"));
    }
    Ok(Take {
        device: device.to_owned(),
        samples,
        setup: None,
    })
}
