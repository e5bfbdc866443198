//! `maulstick schema`: the messages of the rig, for programs in other languages.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::wire::schema::{ENCODING, Field, Shape, header_fields};
use maulstick_types::{CATALOGUE, CatalogueEntry, STYLUS_CONTRACT};
use serde_json::{Value, json};

use super::schema_c;
use crate::commands::{print_json, print_text, say};

/// Options of `maulstick schema`.
#[derive(Args, Clone, Debug)]
pub struct SchemaOptions {
    /// Print only this message
    message: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print a header of C that reads them
    #[arg(long, conflicts_with = "json")]
    c: bool,
}

/// Prints the field tables.
///
/// # Errors
/// A [`UserError`] for an unknown message, with the nearest name.
pub fn run(options: &SchemaOptions) -> Result<i32, UserError> {
    let wanted = |name: &str| {
        options
            .message
            .as_deref()
            .is_none_or(|message| message == name)
    };
    let entries: Vec<_> = CATALOGUE
        .iter()
        .filter(|entry| wanted(entry.name))
        .collect();
    if let (true, Some(message)) = (entries.is_empty(), &options.message) {
        let what = format!("there is no message called '{message}'");
        let names = CATALOGUE.iter().map(|entry| entry.name);
        return Err(UserError::unknown(what, message, names));
    }
    if options.c {
        print_text(&schema_c::header(&entries))?;
        return Ok(0);
    }
    if options.json {
        let messages: Vec<_> = entries.iter().map(|entry| as_json(entry)).collect();
        print_json(&json!({
            "header": header_fields(),
            "encoding": ENCODING,
            "messages": messages,
        }))?;
        return Ok(0);
    }
    entries.into_iter().try_for_each(show)?;
    Ok(0)
}

fn as_json(entry: &CatalogueEntry) -> Value {
    let schema = (entry.schema)();
    json!({
        "name": entry.name,
        "version": entry.version,
        "hash": schema.hash,
        "max_bytes": entry.max_bytes,
        "contract": entry.in_contract.then_some(STYLUS_CONTRACT),
        "topics": entry.topics,
        "types": schema.types,
    })
}

fn show(entry: &CatalogueEntry) -> Result<(), UserError> {
    let schema = (entry.schema)();
    let contract = if entry.in_contract {
        format!(" of {STYLUS_CONTRACT}")
    } else {
        String::new()
    };
    say!(
        "{}  version {}{contract}, hash {:#010x}, at most {} bytes, on {}",
        entry.name,
        entry.version,
        schema.hash,
        entry.max_bytes,
        entry.topics.join(", ")
    );
    let fields = |fields: &[Field]| {
        let line = |field: &Field| format!("    {:<18} {}\n", field.name, field.ty);
        print_text(&fields.iter().map(line).collect::<String>())
    };
    match schema.types.get(entry.name) {
        Some(Shape::Struct(members)) => fields(members)?,
        Some(Shape::Enum(variants)) => variants.iter().try_for_each(|v| fields(&v.fields))?,
        None => {}
    }
    print_text("\n")
}
