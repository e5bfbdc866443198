//! Custom properties, which travel as `extras`.

use serde_json::{Map, Value};

use super::error::GltfError;

/// A numeric property: its name, its range, and whether it is an integer.
struct Number {
    key: &'static str,
    range: [f64; 2],
    whole: bool,
}

const fn number(key: &'static str, least: f64, greatest: f64) -> Number {
    Number {
        key,
        range: [least, greatest],
        whole: false,
    }
}

const fn whole(key: &'static str, least: f64, greatest: f64) -> Number {
    Number {
        whole: true,
        ..number(key, least, greatest)
    }
}

const OF_BONES: [Number; 3] = [
    number("stiffness", 1e-6, 1e9),
    number("damping", 0.0, 1.0),
    number("length_m", 1e-6, 0.5),
];

const OF_OBJECTS: [Number; 8] = [
    number("friction", 0.0, 2.0),
    number("friction_static", 0.0, 2.0),
    number("anisotropy", 0.0, 1.0),
    whole("strips", 1.0, 4096.0),
    number("strip_width_mm", 0.01, 50.0),
    number("film_um", 0.0, 2000.0),
    whole("levels", 0.0, 3.0),
    number("recede_mm", 0.0, 10.0),
];

/// The only property with a text value.
const KIND: &str = "kind";

/// Kind of a node, which determines its properties.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// A joint of the skin.
    Bone,
    /// The mesh, its armature, or what they are parented to.
    Object,
}

impl Owner {
    fn numbers(self) -> &'static [Number] {
        match self {
            Self::Bone => &OF_BONES,
            Self::Object => &OF_OBJECTS,
        }
    }

    fn keys(self) -> impl Iterator<Item = &'static str> {
        let text = (self == Self::Object).then_some(KIND);
        self.numbers().iter().map(|number| number.key).chain(text)
    }
}

/// The checked properties of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Properties(Map<String, Value>);

impl Properties {
    /// Properties of a node; unknown ones are ignored.
    ///
    /// # Errors
    /// [`GltfError::Property`] or [`GltfError::Misspelt`].
    pub(super) fn of(
        node: &str,
        owner: Owner,
        extras: &gltf::json::Extras,
    ) -> Result<Self, GltfError> {
        let Some(raw) = extras else {
            return Ok(Self::default());
        };
        let fault = |key: &str, value: String, range: String| GltfError::Property {
            node: node.to_owned(),
            key: key.to_owned(),
            value,
            range,
        };
        let value: Value = serde_json::from_str(raw.get())
            .map_err(|error| fault("extras", error.to_string(), "readable".to_owned()))?;
        let Value::Object(mut properties) = value else {
            return Ok(Self::default());
        };
        properties.retain(|key, _| !key.starts_with('_'));
        for (key, value) in &properties {
            if let Some(number) = owner.numbers().iter().find(|number| number.key == key) {
                let [least, greatest] = number.range;
                let good = value.as_f64().is_some_and(|v| {
                    (least..=greatest).contains(&v) && !(number.whole && v.fract() != 0.0)
                });
                if !good {
                    let kind = if number.whole { "a whole number, " } else { "" };
                    let range = format!("{kind}{least} to {greatest}");
                    return Err(fault(key, value.to_string(), range));
                }
            } else if owner == Owner::Object && key == KIND {
                if value.as_str().is_none_or(str::is_empty) {
                    return Err(fault(key, value.to_string(), "a name".to_owned()));
                }
            } else {
                known(node, owner, key)?;
            }
        }
        let own = |key: &str| owner.keys().any(|own| own == key);
        properties.retain(|key, _| own(key));
        Ok(Self(properties))
    }

    /// Adds those of another node that are absent here.
    pub(super) fn or(mut self, other: Self) -> Self {
        for (key, value) in other.0 {
            self.0.entry(key).or_insert(value);
        }
        self
    }

    /// A number.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.0.get(key).and_then(Value::as_f64)
    }

    /// The name of the kind of brush.
    pub(super) fn kind(&self) -> Option<&str> {
        self.0.get(KIND).and_then(Value::as_str)
    }
}

/// Rejects a key that resembles a property, or belongs to the other owner.
fn known(node: &str, owner: Owner, key: &str) -> Result<(), GltfError> {
    let misspelt = |nearest: &'static str, place: &'static str| GltfError::Misspelt {
        node: node.to_owned(),
        key: key.to_owned(),
        nearest,
        place,
    };
    if let Some(nearest) = owner.keys().find(|own| near(own, key)) {
        return Err(misspelt(nearest, ""));
    }
    let (other, place) = match owner {
        Owner::Bone => (Owner::Object, " on the object"),
        Owner::Object => (Owner::Bone, " on a bone"),
    };
    match other.keys().find(|its| near(its, key)) {
        Some(nearest) => Err(misspelt(nearest, place)),
        None => Ok(()),
    }
}

/// True if a key differs from a property only by case, a unit suffix, or typing errors: one in a name of four
/// letters, two from six letters on.
fn near(own: &str, key: &str) -> bool {
    let key = key.to_lowercase();
    let longer = |long: &str, short: &str| {
        long.strip_prefix(short)
            .is_some_and(|rest| rest.starts_with('_'))
    };
    let slips = (own.len() / 3).clamp(1, 2);
    longer(own, &key) || longer(&key, own) || strsim::osa_distance(own, &key) <= slips
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(owner: Owner, json: &str) -> Result<Properties, GltfError> {
        let raw = serde_json::from_str(json).expect("json");
        Properties::of("it", owner, &Some(raw))
    }

    #[test]
    fn slips_are_told_from_other_peoples_properties() {
        for key in ["stifness", "Stiffness", "damping_share", "length", "strips"] {
            let error = of(Owner::Bone, &format!(r#"{{"{key}": 1}}"#)).expect_err(key);
            assert!(matches!(error, GltfError::Misspelt { key: found, .. } if found == key));
        }
        for key in [
            "cycles",
            "_RNA_UI",
            "rigify_type",
            "author",
            "glTF2ExportSettings",
        ] {
            let none = of(Owner::Object, &format!(r#"{{"{key}": 1}}"#));
            assert_eq!(none, Ok(Properties::default()), "{key}");
        }
        let elsewhere = of(Owner::Object, r#"{"stiffness": 1}"#).expect_err("a bone's");
        assert!(
            matches!(elsewhere, GltfError::Misspelt { nearest: "stiffness", place, .. } if !place.is_empty())
        );
    }

    #[test]
    fn values_have_ranges() {
        for (json, word) in [
            (r#"{"friction": -0.1}"#, "0 to 2"),
            (r#"{"friction": "0.2"}"#, "0 to 2"),
            (r#"{"friction": 1e999}"#, "readable"),
            (r#"{"strips": 1.5}"#, "a whole number, 1 to 4096"),
            (r#"{"kind": 7}"#, "a name"),
        ] {
            let error = of(Owner::Object, json).expect_err(json).to_string();
            assert!(error.contains(word) && error.contains("'it'"), "{error}");
        }
        let good = of(Owner::Object, r#"{"friction": 0.2, "kind": "fan"}"#).expect("good");
        assert_eq!(
            (good.number("friction"), good.kind()),
            (Some(0.2), Some("fan"))
        );
    }

    #[test]
    fn the_nearer_node_goes_before() {
        let near = of(Owner::Object, r#"{"friction": 0.2}"#).expect("near");
        let far = of(Owner::Object, r#"{"friction": 0.9, "strips": 5}"#).expect("far");
        let both = near.or(far);
        assert_eq!(
            (both.number("friction"), both.number("strips")),
            (Some(0.2), Some(5.0))
        );
    }
}
