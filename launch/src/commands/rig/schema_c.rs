//! Field tables in C, behind the reader that goes by them (`msgs/c/maulstick.h`).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use maulstick_types::CatalogueEntry;
use maulstick_types::wire::schema::{Field, Schema, Shape};

const READER: &str = include_str!("../../../../msgs/c/maulstick.h");

/// Looks up a message; the tables are static, as the functions of the reader are.
const LOOK_UP: &str = "
/* The message of a header's schema; NULL for one that this version does not know. */
static inline const maulstick_message *maulstick_message_of(uint32_t schema)
{
    size_t place;
    for (place = 0; place < sizeof maulstick_messages / sizeof *maulstick_messages; place++)
        if (maulstick_messages[place].schema == schema)
            return &maulstick_messages[place];
    return NULL;
}
";

/// A header of C: the reader and the tables of these messages.
#[must_use]
pub(super) fn header(entries: &[&CatalogueEntry]) -> String {
    let mut tables = Tables::default();
    let mut messages = String::new();
    for entry in entries {
        let schema = (entry.schema)();
        let place = tables.place(&schema.name, schema);
        writeln!(
            messages,
            "    {{\"{}\", {:#010x}u, {}, {place}, maulstick_types, maulstick_fields}},",
            entry.name, schema.hash, entry.version
        )
        .ok();
    }
    let version = env!("CARGO_PKG_VERSION");
    let lines = |rows: &[String]| rows.concat();
    format!(
        "{READER}\n/* Messages of Maulstick {version}. */\n#ifndef MAULSTICK_MESSAGES\n#define MAULSTICK_MESSAGES\n\n\
         static const maulstick_type maulstick_types[] = {{\n{}}};\n\n\
         static const maulstick_field maulstick_fields[] = {{\n{}}};\n\n\
         static const maulstick_message maulstick_messages[] = {{\n{messages}}};\n{LOOK_UP}\n#endif\n",
        lines(&tables.types),
        lines(&tables.fields),
    )
}

/// Rows of types and fields. They refer to each other by place.
#[derive(Debug, Default)]
struct Tables {
    types: Vec<String>,
    fields: Vec<String>,
    places: BTreeMap<String, usize>,
}

impl Tables {
    /// Place of a type, which is added with those inside it if it is new.
    fn place(&mut self, name: &str, schema: &Schema) -> usize {
        if let Some(place) = self.places.get(name) {
            return *place;
        }
        let place = self.reserve();
        self.places.insert(name.to_owned(), place);
        let within = |before: &str, after: &str| name.strip_prefix(before)?.strip_suffix(after);
        let (form, first, count) = if name == "Vec<u8>" {
            ("BYTES".to_owned(), 0, 0)
        } else if let Some(of) = within("Vec<", ">") {
            ("LIST".to_owned(), self.place(of, schema), 0)
        } else if let Some(of) = within("Option<", ">") {
            ("OPTION".to_owned(), self.place(of, schema), 0)
        } else if let Some((of, count)) = within("[", "]").and_then(|of| of.rsplit_once("; ")) {
            let count = count.parse().unwrap_or_default();
            ("ARRAY".to_owned(), self.place(of, schema), count)
        } else {
            match schema.types.get(name) {
                Some(Shape::Struct(fields)) => {
                    let (first, count) = self.add_fields(fields, schema);
                    ("STRUCT".to_owned(), first, count)
                }
                Some(Shape::Enum(variants)) => {
                    let mut alternatives = Vec::new();
                    for variant in variants {
                        let place = self.reserve();
                        let (first, count) = self.add_fields(&variant.fields, schema);
                        let name = format!("{name}.{}", variant.name);
                        self.types[place] = row("STRUCT", first, count, &name);
                        alternatives.push((variant.name.as_str(), place));
                    }
                    let (first, count) = self.add_rows(&alternatives);
                    ("ENUM".to_owned(), first, count)
                }
                None => (name.to_uppercase(), 0, 0),
            }
        };
        self.types[place] = row(&form, first, count, name);
        place
    }

    /// Reserves a row for a type, which its fields may refer to before it is complete.
    fn reserve(&mut self) -> usize {
        self.types.push(String::new());
        self.types.len() - 1
    }

    /// Adds the fields of a struct; place of the first, and their number.
    fn add_fields(&mut self, fields: &[Field], schema: &Schema) -> (usize, usize) {
        let placed = fields.iter();
        let placed = placed.map(|field| (field.name.as_str(), self.place(&field.ty, schema)));
        let placed: Vec<_> = placed.collect();
        self.add_rows(&placed)
    }

    fn add_rows(&mut self, placed: &[(&str, usize)]) -> (usize, usize) {
        let first = self.fields.len();
        let rows = placed.iter();
        self.fields
            .extend(rows.map(|(name, place)| format!("    {{\"{name}\", {place}}},\n")));
        (first, placed.len())
    }
}

/// A row of a type.
fn row(form: &str, first: usize, count: usize, name: &str) -> String {
    format!("    {{MAULSTICK_{form}, {first}, {count}}}, /* {name} */\n")
}

#[cfg(test)]
mod tests;
