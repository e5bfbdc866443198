//! The file itself: its JSON, its buffers, and lists of numbers in them.
//!
//! The `gltf` crate reads and validates the JSON, so that every index in it is valid; the bytes behind its accessors
//! are read here, with all bounds checked.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::{Accessor, Node};

use super::error::GltfError;

/// Length of a .glb's header, bytes.
const HEADER: usize = 12;

/// A glTF file in memory.
pub(super) struct Document {
    /// Validated JSON.
    pub(super) json: gltf::Document,
    /// The bytes of each buffer.
    buffers: Vec<Vec<u8>>,
}

impl Document {
    /// Reads a .glb, or a .gltf whose buffers are data URIs.
    ///
    /// # Errors
    /// [`GltfError::NotGltf`], [`GltfError::Truncated`] or [`GltfError::External`].
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, GltfError> {
        whole(bytes)?;
        let gltf::Gltf { document, mut blob } =
            gltf::Gltf::from_slice_without_validation(bytes).map_err(not_gltf)?;
        let json = document.into_json();
        attributes(&json)?;
        let document = gltf::Document::from_json(json).map_err(not_gltf)?;
        let buffers = document
            .buffers()
            .map(|buffer| {
                let data = match buffer.source() {
                    Source::Bin => blob.take().unwrap_or_default(),
                    Source::Uri(uri) => embedded(uri)?,
                };
                if data.len() < buffer.length() {
                    return Err(GltfError::Truncated {
                        what: format!("buffer {}", buffer.index()),
                        has: data.len(),
                        wants: buffer.length(),
                    });
                }
                Ok(data)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self {
            json: document,
            buffers,
        })
    }

    /// The numbers of an accessor in order; unsigned ones are normalised to 0..1.
    ///
    /// # Errors
    /// [`GltfError::Data`] or [`GltfError::NotFinite`].
    pub(super) fn numbers(
        &self,
        accessor: &Accessor<'_>,
        list: List,
    ) -> Result<Vec<f64>, GltfError> {
        let read: fn(&[u8]) -> f64 = match accessor.data_type() {
            DataType::F32 => |b| f64::from(f32::from_le_bytes(bytes_of(b))),
            DataType::U8 => |b| f64::from(b[0]) / 255.0,
            DataType::U16 => |b| f64::from(u16::from_le_bytes(bytes_of(b))) / 65535.0,
            other => return Err(list.fault(format!("has numbers of type {other:?}"))),
        };
        let numbers: Vec<f64> = self.components(accessor, &list)?.map(read).collect();
        if numbers.iter().all(|number| number.is_finite()) {
            Ok(numbers)
        } else {
            Err(GltfError::NotFinite {
                what: list.what,
                node: list.node,
            })
        }
    }

    /// The integers of an accessor in order.
    ///
    /// # Errors
    /// [`GltfError::Data`].
    pub(super) fn indices(
        &self,
        accessor: &Accessor<'_>,
        list: List,
    ) -> Result<Vec<usize>, GltfError> {
        let read: fn(&[u8]) -> usize = match accessor.data_type() {
            DataType::U8 => |b| usize::from(b[0]),
            DataType::U16 => |b| usize::from(u16::from_le_bytes(bytes_of(b))),
            DataType::U32 => |b| u32::from_le_bytes(bytes_of(b)) as usize,
            other => return Err(list.fault(format!("has indices of type {other:?}"))),
        };
        Ok(self.components(accessor, &list)?.map(read).collect())
    }

    /// The bytes of each component of an accessor.
    fn components<'a>(
        &'a self,
        accessor: &Accessor<'_>,
        list: &List,
    ) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, GltfError> {
        let shape = accessor.dimensions();
        if shape != list.shape {
            return Err(list.fault(format!("is a list of {shape:?}, not {:?}", list.shape)));
        }
        let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
            return Err(list.fault("is sparse".to_owned()));
        };
        let within = || {
            let start = view.offset();
            let data = self.buffers.get(view.buffer().index())?;
            let data = data.get(start..start.checked_add(view.length())?)?;
            let stride = view.stride().unwrap_or(accessor.size());
            let last = accessor.count().checked_sub(1)?.checked_mul(stride)?;
            let end = accessor.offset().checked_add(last)?;
            let end = end.checked_add(accessor.size())?;
            Some((data.get(accessor.offset()..end)?, stride))
        };
        let (data, stride) =
            within().ok_or_else(|| list.fault("lies outside of its buffer".to_owned()))?;
        let (size, part) = (accessor.size(), accessor.data_type().size());
        let items = (0..accessor.count()).map(move |i| &data[i * stride..i * stride + size]);
        Ok(items.flat_map(move |item| item.chunks_exact(part)))
    }
}

/// Description of a list of numbers, for the errors of reading it.
pub(super) struct List {
    /// Its name, for example `POSITION`.
    pub(super) what: &'static str,
    /// The node it belongs to.
    pub(super) node: String,
    /// Type of its elements.
    pub(super) shape: Dimensions,
}

impl List {
    /// The error of reading this list, for the reason `why`.
    pub(super) fn fault(&self, why: String) -> GltfError {
        GltfError::Data {
            what: self.what,
            node: self.node.clone(),
            why,
        }
    }
}

/// The name of a node, or its number.
pub(super) fn name_of(node: &Node<'_>) -> String {
    match node.name() {
        Some(name) => name.to_owned(),
        None => format!("node {}", node.index()),
    }
}

fn bytes_of<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

/// Checks that a .glb has the number of bytes in its header.
fn whole(bytes: &[u8]) -> Result<(), GltfError> {
    if !bytes.starts_with(b"glTF") {
        return Ok(());
    }
    let wants = match bytes.get(8..HEADER) {
        Some(length) => u32::from_le_bytes(bytes_of(length)) as usize,
        None => HEADER,
    };
    if bytes.len() < wants.max(HEADER) {
        return Err(GltfError::Truncated {
            what: "the .glb".to_owned(),
            has: bytes.len(),
            wants: wants.max(HEADER),
        });
    }
    // The reader subtracts the header from it.
    if wants < HEADER {
        Err(GltfError::NotGltf(format!("its length is {wants}")))
    } else {
        Ok(())
    }
}

/// Checks that the accessors of all vertices exist: gltf-json 1.4.1 reads that of `POSITION` before it has checked
/// its number.
fn attributes(json: &gltf::json::Root) -> Result<(), GltfError> {
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut accessors = primitives.flat_map(|primitive| primitive.attributes.values());
    match accessors.find(|accessor| accessor.value() >= json.accessors.len()) {
        Some(accessor) => Err(GltfError::NotGltf(format!(
            "there is no accessor {}",
            accessor.value()
        ))),
        None => Ok(()),
    }
}

fn not_gltf(error: gltf::Error) -> GltfError {
    GltfError::NotGltf(match error {
        gltf::Error::Validation(faults) => match &faults[..] {
            [(path, fault), ..] => format!("{path}: {fault}"),
            [] => "it is invalid".to_owned(),
        },
        other => other.to_string(),
    })
}

/// The bytes of a data URI (RFC 2397).
fn embedded(uri: &str) -> Result<Vec<u8>, GltfError> {
    let Some(rest) = uri.strip_prefix("data:") else {
        return Err(GltfError::External {
            uri: uri.to_owned(),
        });
    };
    let coded = rest.split_once(";base64,").map(|(_, coded)| coded);
    coded
        .and_then(|coded| STANDARD.decode(coded).ok())
        .ok_or_else(|| GltfError::NotGltf("a data URI is not in base64".to_owned()))
}
