//! The container: one JSON chunk, one binary chunk, accessors into it.

use serde_json::{Value, json};

/// Accessor component type: 32-bit float.
const FLOAT: u32 = 5126;
/// Accessor component type: 32-bit index.
pub(crate) const UNSIGNED_INT: u32 = 5125;
/// Accessor component type: 16-bit index.
pub(crate) const UNSIGNED_SHORT: u32 = 5123;

/// The binary chunk under construction, with its views and accessors.
#[derive(Default)]
pub(crate) struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// Appends bytes and returns their view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        // Every view starts at a multiple of four, which fits all component types.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Appends an accessor over part of a view and returns it.
    pub(crate) fn accessor(
        &mut self,
        view: usize,
        byte_offset: usize,
        component: u32,
        count: usize,
        shape: &str,
    ) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "byteOffset": byte_offset, "componentType": component, "count": count, "type": shape
        }));
        self.accessors.len() - 1
    }

    /// Appends rows of floats as an accessor; `bounds` states their smallest and largest values, as positions need.
    pub(crate) fn floats<const N: usize>(
        &mut self,
        rows: impl Iterator<Item = [f32; N]>,
        shape: &str,
        bounds: bool,
    ) -> usize {
        let (mut low, mut high) = ([f32::MAX; N], [f32::MIN; N]);
        let (mut bytes, mut count) = (Vec::new(), 0);
        for row in rows {
            count += 1;
            for (k, value) in row.into_iter().enumerate() {
                low[k] = low[k].min(value);
                high[k] = high[k].max(value);
                bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
        let view = self.view(&bytes);
        let accessor = self.accessor(view, 0, FLOAT, count, shape);
        if bounds {
            self.accessors[accessor]["min"] = json!(low.to_vec());
            self.accessors[accessor]["max"] = json!(high.to_vec());
        }
        accessor
    }

    /// The whole file: `document` gets the buffer, views and accessors.
    ///
    /// # Errors
    /// A sentence when the file would exceed the format's 4 GiB.
    pub(crate) fn into_glb(self, mut document: Value) -> Result<Vec<u8>, String> {
        if !self.bytes.is_empty() {
            document["buffers"] = json!([{"byteLength": self.bytes.len()}]);
            document["bufferViews"] = Value::Array(self.views);
            document["accessors"] = Value::Array(self.accessors);
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes;
        binary.resize(binary.len().next_multiple_of(4), 0);
        let chunk = if binary.is_empty() {
            0
        } else {
            8 + binary.len()
        };
        let total = 12 + 8 + text.len() + chunk;
        let length = |bytes: usize| {
            u32::try_from(bytes).map_err(|_| format!("{total} bytes; a GLB holds at most 2^32"))
        };
        let mut file = Vec::with_capacity(total);
        file.extend_from_slice(b"glTF");
        file.extend_from_slice(&2_u32.to_le_bytes());
        file.extend_from_slice(&length(total)?.to_le_bytes());
        file.extend_from_slice(&length(text.len())?.to_le_bytes());
        file.extend_from_slice(b"JSON");
        file.append(&mut text);
        if chunk > 0 {
            file.extend_from_slice(&length(binary.len())?.to_le_bytes());
            file.extend_from_slice(b"BIN\0");
            file.append(&mut binary);
        }
        Ok(file)
    }
}
