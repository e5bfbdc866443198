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

/// Defines a message: a [`wire_struct!`] with a version and a size limit of its body. One of a contract keeps the hash of
/// its first field table: fields are only appended, and programs of other versions read it.
macro_rules! message {
    (
        $(#[$meta:meta])*
        pub struct $name:ident [version $version:literal, at most $max:literal bytes] { $($body:tt)* }
    ) => {
        $crate::wire::define::message! {
            @define [$(#[$meta])*] $name $version $max false { $($body)* }
            $crate::wire::schema::Schema::of::<$name>,
            |_, body| $crate::wire::codec::decode_limited::<$name, $max>(stringify!($name), body)
        }
    };
    (
        $(#[$meta:meta])*
        pub struct $name:ident
        [contract of hash $hash:literal, version $version:literal, at most $max:literal bytes]
        { $($body:tt)* }
    ) => {
        $crate::wire::define::message! {
            @define [$(#[$meta])*] $name $version $max true { $($body)* }
            || $crate::wire::schema::Schema::frozen::<$name>($hash),
            |sent, body| $crate::wire::codec::decode_contract::<$name, $max>(
                stringify!($name), $version, sent, body,
            )
        }
    };
    (
        @define [$($meta:tt)*] $name:ident $version:literal $max:literal $frozen:literal { $($body:tt)* }
        $schema:expr, $decode:expr
    ) => {
        $crate::wire::define::wire_struct! {
            $($meta)*
            pub struct $name { $($body)* }
        }

        impl $crate::Message for $name {
            const NAME: &'static str = stringify!($name);
            const VERSION: u16 = $version;
            const MAX_BYTES: usize = $max;
            const IN_CONTRACT: bool = $frozen;

            fn schema() -> &'static $crate::wire::schema::Schema {
                static SCHEMA: std::sync::OnceLock<$crate::wire::schema::Schema> =
                    std::sync::OnceLock::new();
                SCHEMA.get_or_init($schema)
            }

            fn decode_body(version: u16, body: &[u8]) -> Result<Self, $crate::DecodeError> {
                let decode: fn(u16, &[u8]) -> Result<Self, $crate::DecodeError> = $decode;
                decode(version, body)
            }
        }
    };
}

pub(crate) use {message, wire_enum, wire_struct};
