//! Colour output of the window and of pictures: names and files of `[view]` and of the command line.

use std::path::Path;
use std::sync::Arc;

use maulstick_appearance::picture::Export;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::GamutMapping;
use maulstick_optics::icc::{Profile, ProfileError};
use maulstick_rig::UserError;
use maulstick_rig::config::ViewSection;

/// Name of the section in faults of rig.toml.
pub const VIEW: &str = "[view] of rig.toml";
/// Greatest size of a profile, bytes; those of printers take a few million.
const PROFILE_MAX: u64 = 64 << 20;

/// Export settings of a section; `place` is its name in faults.
///
/// # Errors
/// A [`UserError`] for an unknown name, or a file that is no RGB profile.
pub fn export(view: &ViewSection, place: &str) -> Result<Export, UserError> {
    view.check()
        .map_err(|(what, help)| UserError::usage(what).at(place).help(help))?;
    let profile = match (view.file(), view.profile.as_str()) {
        (Some(path), _) => read(path)?,
        (None, "display-p3") => Profile::of(RgbSpace::DisplayP3),
        (None, _) => Profile::of(RgbSpace::Srgb),
    };
    Ok(Export {
        profile: Arc::new(profile),
        gamut: match view.gamut.as_str() {
            "clamp" => GamutMapping::Clamp,
            _ => GamutMapping::Soft,
        },
    })
}

fn read(path: &Path) -> Result<Profile, UserError> {
    let size = std::fs::metadata(path).map(|about| about.len());
    if size.is_ok_and(|size| size > PROFILE_MAX) {
        return Err(UserError::usage("a file of this size is no ICC profile")
            .at(path.display().to_string())
            .help("give the .icc or .icm file of the display"));
    }
    let bytes = std::fs::read(path).map_err(|error| UserError::reading(path, &error))?;
    Profile::read(bytes).map_err(|error| {
        let help = match error {
            ProfileError::Damaged(_) => {
                "make or download the profile again, or use srgb or display-p3"
            }
            ProfileError::NotRgb(_) | ProfileError::OneWay(_) => {
                "give the profile of a display or of an RGB printer, or use srgb or display-p3"
            }
        };
        UserError::usage(error.to_string())
            .at(path.display().to_string())
            .help(help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(profile: &str, gamut: &str) -> UserError {
        let view = ViewSection {
            profile: profile.into(),
            gamut: gamut.into(),
        };
        export(&view, "--profile").expect_err("refused")
    }

    #[test]
    fn profiles_are_known_or_read_or_refused_with_what_to_do() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).display().to_string();
        let p3 = ViewSection {
            profile: "display-p3".into(),
            gamut: "clamp".into(),
        };
        let wide = export(&p3, "--profile").expect("known");
        assert_eq!(wide.gamut, GamutMapping::Clamp);
        let own = path("own.icc");
        std::fs::write(&own, wide.profile.icc()).expect("written");
        let view = ViewSection {
            profile: own,
            gamut: "soft".into(),
        };
        let read = export(&view, "--profile").expect("its own profile");
        assert_eq!(read.profile.icc(), wide.profile.icc());

        let torn = path("torn.icc");
        std::fs::write(&torn, &wide.profile.icc()[..300]).expect("written");
        for file in [path("none.icc"), torn] {
            let fault = fault(&file, "soft");
            assert!(fault.help.is_some(), "{fault}");
            assert_eq!(fault.place, Some(file));
        }
        let nearest = fault("display-p4", "soft");
        assert_eq!(nearest.place.as_deref(), Some("--profile"));
        assert!(nearest.to_string().contains("'display-p3'"), "{nearest}");
        let help = fault("srgb", "hard").help.unwrap_or_default();
        assert!(help.contains("soft") && help.contains("clamp"), "{help}");
    }
}
