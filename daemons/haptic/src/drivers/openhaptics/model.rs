//! Data of a Phantom by its model's name, beyond the library's answers.
//!
//! Largest forces and stiffnesses are those that CHAI3D's driver takes for safe, model by model; the library's own
//! nominal values bound them further. Continuous forces are from the data sheets.

/// Limits of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Largest force, N.
    pub force_n: f64,
    /// Force that its warm motors bear, N.
    pub continuous_n: f64,
    /// Largest stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Largest torque, N·m, where it drives any.
    pub torque_nm: f64,
    /// Its dead man's switch.
    pub dead_man: DeadMan,
}

/// Reliability of a model's safety switch.
///
/// The library answers for every model; those without such a switch give a constant, and which one is not documented.
/// On the Touch X and the Desktop, the same device by its earlier name, it is on while the conductive part of the
/// stylus is held. A constant that is off would forbid all force for ever, so only these two are believed; for the
/// others the servo's own guards and the inkwell have to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeadMan {
    /// On while the stylus is held.
    Senses,
    /// No such switch.
    Absent,
}

const TOUCH: Model = Model {
    force_n: 3.3,
    continuous_n: 0.88,
    stiffness_n_m: 400.0,
    torque_nm: 0.0,
    dead_man: DeadMan::Absent,
};
const OMNI: Model = Model {
    stiffness_n_m: 700.0,
    ..TOUCH
};
const DESKTOP: Model = Model {
    force_n: 7.9,
    continuous_n: 1.75,
    stiffness_n_m: 1000.0,
    torque_nm: 0.0,
    dead_man: DeadMan::Senses,
};
const PREMIUM: Model = Model {
    force_n: 8.5,
    continuous_n: 1.4,
    stiffness_n_m: 800.0,
    torque_nm: 0.188,
    dead_man: DeadMan::Absent,
};
const LARGE_PREMIUM: Model = Model {
    force_n: 22.0,
    continuous_n: 3.0,
    stiffness_n_m: 1000.0,
    ..PREMIUM
};
/// Of a model that is not known: what the weakest one bears.
const OTHER: Model = TOUCH;

impl Model {
    /// The model of this name, as `HD_DEVICE_MODEL_TYPE` gives it: with or without the maker's name,
    /// in whatever capitals and spaces.
    #[must_use]
    pub fn named(name: &str) -> Self {
        let mut name = name.to_lowercase();
        name.retain(char::is_alphanumeric);
        let has = |part: &str| name.contains(part);
        // Touch X before Touch, and 3.0 before the other Premiums.
        let known = [
            ("touchx", DESKTOP),
            ("desktop", DESKTOP),
            ("omni", OMNI),
            ("touch", TOUCH),
            ("premium3", LARGE_PREMIUM),
            ("premium", PREMIUM),
        ];
        known
            .iter()
            .find(|(part, _)| has(part))
            .map_or(OTHER, |(_, model)| *model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_known_by_the_names_that_they_have_had() {
        for (name, expected) in [
            ("Touch", TOUCH),
            ("Geomagic Touch", TOUCH),
            ("Touch X", DESKTOP),
            ("Geomagic Touch X", DESKTOP),
            ("Touch_X", DESKTOP),
            ("PHANToM Desktop", DESKTOP),
            ("PHANTOM Omni", OMNI),
            ("PHANTOM Premium 1.5 6DOF", PREMIUM),
            ("PHANTOM Premium 3.0 6DOF", LARGE_PREMIUM),
            ("?", OTHER),
        ] {
            assert_eq!(Model::named(name), expected, "{name}");
        }
    }

    #[test]
    fn a_model_that_is_not_known_gets_no_more_than_any_that_is() {
        for model in [TOUCH, OMNI, DESKTOP, PREMIUM, LARGE_PREMIUM] {
            assert!(OTHER.force_n <= model.force_n && OTHER.stiffness_n_m <= model.stiffness_n_m);
            assert!(OTHER.continuous_n <= model.continuous_n);
        }
    }
}
