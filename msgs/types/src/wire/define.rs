//! One definition a message: struct, codec, field table, schema hash and size limit.

/// Defines a struct that travels inside messages.
macro_rules! wire_struct {
    (
        $(#[$meta:meta])*
        pub struct $name:ident {
            $( $(#[$field_meta:meta])* pub $field:ident : $ty:ty ),* $(,)?
        }
    ) => {
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        $(#[$meta])*
        pub struct $name {
            $( $(#[$field_meta])* pub $field: $ty, )*
        }

        impl $crate::wire::schema::Wire for $name {
            fn type_name() -> String {
                stringify!($name).to_owned()
            }

            fn describe(table: &mut $crate::wire::schema::TypeTable) {
                table.define(stringify!($name), |table| {
                    $crate::wire::schema::Shape::Struct(vec![
                        $( table.field::<$ty>(stringify!($field)), )*
                    ])
                });
            }
        }
    };
}

/// Defines an enum that travels inside messages; its tag is a u32 in order of declaration. A variant that holds one
/// other type calls it `value` in its field table.
macro_rules! wire_enum {
    (
        $(#[$meta:meta])*
        pub enum $name:ident {
            $(
                $(#[$variant_meta:meta])*
                $variant:ident
                $(($inner:ty))?
                $({
                    $( $(#[$field_meta:meta])* $field:ident : $ty:ty ),* $(,)?
                })?
            ),* $(,)?
        }
    ) => {
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        $(#[$meta])*
        pub enum $name {
            $(
                $(#[$variant_meta])*
                $variant $(($inner))? $({ $( $(#[$field_meta])* $field: $ty, )* })?,
            )*
        }

        impl $crate::wire::schema::Wire for $name {
            fn type_name() -> String {
                stringify!($name).to_owned()
            }

            fn describe(table: &mut $crate::wire::schema::TypeTable) {
                table.define(stringify!($name), |table| {
                    let _ = &table;
                    $crate::wire::schema::Shape::Enum(vec![
                        $(
                            $crate::wire::schema::Variant {
                                name: stringify!($variant).to_owned(),
                                fields: vec![
                                    $( table.field::<$inner>("value"), )?
                                    $($( table.field::<$ty>(stringify!($field)), )*)?
                                ],
                            },
                        )*
                    ])
                });
            }
        }
    };
}

/// Defines a message: a [`wire_struct!`] with a version and a size limit of its body.
macro_rules! message {
    (
        $(#[$meta:meta])*
        pub struct $name:ident [version $version:literal, at most $max:literal bytes] { $($body:tt)* }
    ) => {
        $crate::wire::define::wire_struct! {
            $(#[$meta])*
            pub struct $name { $($body)* }
        }

        impl $crate::Message for $name {
            const NAME: &'static str = stringify!($name);
            const VERSION: u16 = $version;
            const MAX_BYTES: usize = $max;

            fn schema() -> &'static $crate::wire::schema::Schema {
                static SCHEMA: std::sync::OnceLock<$crate::wire::schema::Schema> =
                    std::sync::OnceLock::new();
                SCHEMA.get_or_init($crate::wire::schema::Schema::of::<$name>)
            }

            fn decode_body(body: &[u8]) -> Result<Self, $crate::DecodeError> {
                $crate::wire::codec::decode_limited::<$name, $max>(stringify!($name), body)
            }
        }
    };
}

pub(crate) use {message, wire_enum, wire_struct};
