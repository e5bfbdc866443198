//! Values of messages, whatever their types.

use std::sync::Arc;

use serde::ser::{Serialize, SerializeMap, Serializer};

/// Fields of a struct or a variant, in the order in which they travel.
pub type Fields = Vec<(Arc<str>, Value)>;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// An unsigned integer.
    Unsigned(u64),
    /// A signed integer.
    Signed(i64),
    /// An f32.
    Single(f32),
    /// An f64.
    Real(f64),
    /// A bool.
    Flag(bool),
    /// A text, or an alternative of an enum of which none has fields.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// An array or a list.
    List(Vec<Self>),
    /// An option without a value.
    Absent,
    /// A struct.
    Fields(Fields),
    /// An alternative of an enum of which some have fields.
    Variant(Arc<str>, Fields),
}

impl Value {
    /// The value at a path such as `pose.point_m.0`: names of fields, places in lists. The name of an alternative may be
    /// left out.
    #[must_use]
    pub fn at(&self, path: &str) -> Option<&Self> {
        path.split('.').try_fold(self, Self::part)
    }

    fn part(&self, name: &str) -> Option<&Self> {
        let of = |fields: &'_ Fields| fields.iter().position(|(own, _)| **own == *name);
        match self {
            Self::Fields(fields) => of(fields).map(|place| &fields[place].1),
            Self::Variant(own, _) if **own == *name => Some(self),
            Self::Variant(_, fields) => of(fields).map(|place| &fields[place].1),
            Self::List(list) => list.get(name.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// Paths of its scalars, in order, for columns of a table. A list that is not of numbers alone, or that is longer than
    /// nine, is one column.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        let mut paths = Vec::new();
        self.add_columns(String::new(), &mut paths);
        paths
    }

    fn add_columns(&self, path: String, paths: &mut Vec<String>) {
        let below = |name: &str| {
            if path.is_empty() {
                name.to_owned()
            } else {
                format!("{path}.{name}")
            }
        };
        match self {
            Self::Fields(fields) | Self::Variant(_, fields) => {
                for (name, value) in fields {
                    value.add_columns(below(name), paths);
                }
            }
            Self::List(list) if !list.is_empty() && self.is_plain() => {
                for (place, value) in list.iter().enumerate() {
                    value.add_columns(below(&place.to_string()), paths);
                }
            }
            _ => paths.push(path),
        }
    }

    fn is_plain(&self) -> bool {
        match self {
            Self::List(list) => list.len() <= MOST_COLUMNS && list.iter().all(Self::is_plain),
            Self::Unsigned(_)
            | Self::Signed(_)
            | Self::Single(_)
            | Self::Real(_)
            | Self::Flag(_) => true,
            _ => false,
        }
    }

    /// A number of it, where it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Unsigned(value) => Some(*value as f64),
            Self::Signed(value) => Some(*value as f64),
            Self::Single(value) => Some(f64::from(*value)),
            Self::Real(value) => Some(*value),
            Self::Flag(value) => Some(f64::from(u8::from(*value))),
            _ => None,
        }
    }

    /// As a cell of a table: a number or a text as it is, nothing where it is absent, all else as JSON.
    #[must_use]
    pub fn cell(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Absent => String::new(),
            Self::Single(value) => value.to_string(),
            Self::Real(value) => value.to_string(),
            other => serde_json::to_string(other).unwrap_or_default(),
        }
    }
}

/// Longest list of numbers that has a column for each.
const MOST_COLUMNS: usize = 9;

/// As JSON: numbers that are not finite are texts, bytes are their number, an alternative is an object of its name alone.
impl Serialize for Value {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let fields = |fields: &Fields, to: S| {
            let mut map = to.serialize_map(Some(fields.len()))?;
            for (name, value) in fields {
                map.serialize_entry(&**name, value)?;
            }
            map.end()
        };
        match self {
            Self::Unsigned(value) => to.serialize_u64(*value),
            Self::Signed(value) => to.serialize_i64(*value),
            Self::Single(value) if value.is_finite() => to.serialize_f32(*value),
            Self::Single(value) => to.collect_str(value),
            Self::Real(value) if value.is_finite() => to.serialize_f64(*value),
            Self::Real(value) => to.collect_str(value),
            Self::Flag(value) => to.serialize_bool(*value),
            Self::Text(text) => to.serialize_str(text),
            Self::Bytes(bytes) => to.collect_str(&format_args!("{} bytes", bytes.len())),
            Self::List(list) => to.collect_seq(list),
            Self::Absent => to.serialize_none(),
            Self::Fields(own) => fields(own, to),
            Self::Variant(name, own) => {
                let mut map = to.serialize_map(Some(1))?;
                map.serialize_entry(&**name, &Self::Fields(own.clone()))?;
                map.end()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value() -> Value {
        let real = |value: f64| Value::Real(value);
        Value::Fields(vec![
            ("seq".into(), Value::Unsigned(7)),
            (
                "pose".into(),
                Value::Variant(
                    "Contact".into(),
                    vec![
                        ("point_m".into(), Value::List(vec![real(0.5), real(-0.5)])),
                        ("pressure".into(), real(f64::NAN)),
                    ],
                ),
            ),
            ("note".into(), Value::Text("a".into())),
            ("more".into(), Value::Absent),
            ("long".into(), Value::List(vec![Value::Unsigned(1); 10])),
        ])
    }

    #[test]
    fn a_path_leads_through_fields_alternatives_and_lists() {
        let value = value();
        let number = |path: &str| value.at(path).and_then(Value::number);
        assert_eq!(number("pose.point_m.1"), Some(-0.5));
        assert_eq!(number("pose.Contact.point_m.0"), Some(0.5));
        assert_eq!(number("seq"), Some(7.0));
        for wrong in ["", "pose.point_m.2", "pose.Ferrule", "seq.0", "nothing"] {
            assert_eq!(value.at(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn columns_are_the_scalars_in_order() {
        let columns = value().columns();
        let expected = [
            "seq",
            "pose.point_m.0",
            "pose.point_m.1",
            "pose.pressure",
            "note",
            "more",
            "long",
        ];
        assert_eq!(columns, expected);
        let cells: Vec<String> = columns
            .iter()
            .map(|path| value().at(path).map(Value::cell).unwrap_or_default())
            .collect();
        assert_eq!(
            cells,
            ["7", "0.5", "-0.5", "NaN", "a", "", "[1,1,1,1,1,1,1,1,1,1]"]
        );
    }

    #[test]
    fn json_keeps_what_json_cannot_say_as_text() {
        let json = serde_json::to_string(&value()).expect("JSON");
        assert!(
            json.starts_with(
                r#"{"seq":7,"pose":{"Contact":{"point_m":[0.5,-0.5],"pressure":"NaN"}}"#
            ),
            "{json}"
        );
    }
}
