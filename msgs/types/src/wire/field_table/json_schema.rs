//! JSON Schema of a field table, in the subset that viewers such as Foxglove read: objects, scalars, and lists of these.

use serde_json::{Map, Value as Json, json};

use super::{DEEPEST_NESTING, Definition, FieldTable, Type, TypedField, is_plain};

/// Most definitions that a schema spells out: it has no references, and a hostile table may nest without end.
const MOST_DEFINITIONS: usize = 4096;

impl FieldTable {
    /// JSON Schema of the message's fields, as [`Value`](crate::wire::value::Value) writes them. A list of lists is left out, for
    /// viewers reject it; messages have it nevertheless.
    #[must_use]
    pub fn json_schema(&self) -> Json {
        let message = Type::Defined(self.message);
        let schema = self.schema_of(&message, DEEPEST_NESTING, &mut { MOST_DEFINITIONS });
        schema.unwrap_or_else(|| object(Map::new(), Vec::new()))
    }

    fn schema_of(&self, of: &Type, depth: usize, budget: &mut usize) -> Option<Json> {
        let scalar = |name: &str| Some(json!({ "type": name }));
        match of {
            Type::U8 | Type::U16 | Type::U32 | Type::U64 | Type::I32 | Type::I64 => {
                scalar("integer")
            }
            Type::F32 | Type::F64 => scalar("number"),
            Type::Bool => scalar("boolean"),
            Type::Text | Type::Bytes => scalar("string"),
            Type::List(of) | Type::Array(of, _) => {
                let items = self.schema_of(of, depth, budget)?;
                (items["type"] != "array").then(|| json!({ "type": "array", "items": items }))
            }
            Type::Optional(of) => self.schema_of(of, depth, budget),
            Type::Defined(place) => {
                let depth = depth.checked_sub(1)?;
                *budget = budget.checked_sub(1)?;
                Some(match &self.definitions[*place] {
                    Definition::Struct(fields) => self.schema_of_fields(fields, depth, budget),
                    Definition::Enum(variants) if is_plain(variants) => {
                        let names: Vec<&str> = variants.iter().map(|(name, _)| &**name).collect();
                        json!({ "type": "string", "enum": names })
                    }
                    Definition::Enum(variants) => {
                        let variants = variants.iter().map(|(name, fields)| {
                            (
                                name.to_string(),
                                self.schema_of_fields(fields, depth, budget),
                            )
                        });
                        object(variants.collect(), Vec::new())
                    }
                })
            }
        }
    }

    fn schema_of_fields(&self, fields: &[TypedField], depth: usize, budget: &mut usize) -> Json {
        let needed = fields
            .iter()
            .filter(|(_, of)| !matches!(of, Type::Optional(_)));
        let needed = needed.map(|(name, _)| &**name).collect();
        let known = fields
            .iter()
            .filter_map(|(name, of)| Some((name.to_string(), self.schema_of(of, depth, budget)?)));
        object(known.collect(), needed)
    }
}

/// Schema of an object with some properties, of which it needs a part.
fn object(properties: Map<String, Json>, needed: Vec<&str>) -> Json {
    json!({ "type": "object", "properties": properties, "required": needed })
}
