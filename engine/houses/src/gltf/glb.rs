//! The container: one JSON chunk, one binary chunk, accessors into it.

use dwell_scene::file::{CancellableStream, write_in_pieces};
use dwell_scene::interrupt::CancelPoller;
use serde_json::{Value, json};

/// Accessor component type: 32-bit float.
const FLOAT: u32 = 5126;
/// Rows of numbers between checks for cancellation.
const ROWS_PER_CHECK: usize = 100_000;
/// Accessor component type: 32-bit index.
pub(crate) const UNSIGNED_INT: u32 = 5125;
/// Accessor component type: 16-bit index.
pub(crate) const UNSIGNED_SHORT: u32 = 5123;

/// A file of bytes that a URI names.
pub(crate) struct SidecarFile {
    /// Its folder and name: `object/<hash>.bin`.
    pub(crate) path: String,
    pub(crate) bytes: Vec<u8>,
}

/// Prefix of [`SidecarFile::path`] in URIs: a native house is at `house/NAME.dwell/`.
pub(crate) const LIBRARY_PREFIX: &str = "../../";

/// The name of a shared file: 128 bits of its content.
pub(crate) fn content_name(bytes: &[u8]) -> String {
    format!("{:032x}", xxhash_rust::xxh3::xxh3_128(bytes))
}

/// Bytes of accessors.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    /// The file that holds them; `None`: the binary chunk.
    path: Option<String>,
}

/// The binary chunk, and buffers beside the file, under construction, with their views and accessors.
pub(crate) struct GlbBufferBuilder {
    /// The chunk first.
    buffers: Vec<Buffer>,
    /// The buffer that is written to.
    open: usize,
    beside: Vec<SidecarFile>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Default for GlbBufferBuilder {
    fn default() -> Self {
        Self {
            buffers: vec![Buffer::default()],
            open: 0,
            beside: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
        }
    }
}

impl GlbBufferBuilder {
    /// Runs `write`, whose data go into the chunk, or, if `apart`, into a file of its own in `folder`, named by its content.
    pub(crate) fn with_buffer<T>(
        &mut self,
        folder: &str,
        apart: bool,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        if !apart {
            return write(self);
        }
        self.open = self.buffers.len();
        self.buffers.push(Buffer::default());
        let result = write(self);
        self.open = 0;
        if let Some(buffer) = self.buffers.pop_if(|buffer| buffer.bytes.is_empty()) {
            debug_assert!(buffer.path.is_none());
        } else if let Some(buffer) = self.buffers.last_mut() {
            buffer.path = Some(format!("{folder}/{}.bin", content_name(&buffer.bytes)));
        }
        result
    }

    /// Adds a file beside the GLB, named by its content; returns its URI.
    pub(crate) fn add_sidecar(&mut self, folder: &str, ending: &str, bytes: Vec<u8>) -> String {
        let path = format!("{folder}/{}.{ending}", content_name(&bytes));
        let uri = format!("{LIBRARY_PREFIX}{path}");
        self.beside.push(SidecarFile { path, bytes });
        uri
    }

    /// Appends bytes and returns their view.
    pub(crate) fn add_buffer_view(&mut self, bytes: &[u8]) -> usize {
        let to = &mut self.buffers[self.open].bytes;
        // Every view starts at a multiple of four, which fits all component types.
        to.resize(to.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": self.open, "byteOffset": to.len(), "byteLength": bytes.len()}));
        to.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Appends an accessor over part of a view and returns it.
    pub(crate) fn add_accessor(
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
    pub(crate) fn add_float_accessor<const N: usize>(
        &mut self,
        rows: impl Iterator<Item = [f32; N]>,
        shape: &str,
        bounds: bool,
    ) -> usize {
        let (mut low, mut high) = ([f32::MAX; N], [f32::MIN; N]);
        let (mut bytes, mut count) = (Vec::new(), 0);
        let mut poller = CancelPoller::new(ROWS_PER_CHECK);
        for row in rows {
            poller.count_one();
            count += 1;
            for (k, value) in row.into_iter().enumerate() {
                low[k] = low[k].min(value);
                high[k] = high[k].max(value);
                bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
        let view = self.add_buffer_view(&bytes);
        let accessor = self.add_accessor(view, 0, FLOAT, count, shape);
        if bounds {
            self.accessors[accessor]["min"] = json!(low.to_vec());
            self.accessors[accessor]["max"] = json!(high.to_vec());
        }
        accessor
    }

    /// Returns the whole file, and those beside it: `document` gets the buffers, views and accessors.
    ///
    /// # Errors
    /// A sentence when the file would exceed the format's 4 GiB.
    pub(crate) fn into_glb(
        mut self,
        mut document: Value,
    ) -> Result<(Vec<u8>, Vec<SidecarFile>), String> {
        if !self.views.is_empty() {
            // The format forbids empty buffers, and the chunk is the first one.
            let chunk = &mut self.buffers[0].bytes;
            chunk.resize(chunk.len().max(4), 0);
            let row = |buffer: &Buffer| match &buffer.path {
                None => json!({"byteLength": buffer.bytes.len()}),
                Some(path) => json!({
                    "byteLength": buffer.bytes.len(), "uri": format!("{LIBRARY_PREFIX}{path}")
                }),
            };
            document["buffers"] = self.buffers.iter().map(row).collect();
            document["bufferViews"] = Value::Array(self.views);
            document["accessors"] = Value::Array(self.accessors);
        }
        let mut buffers = self.buffers.into_iter();
        let mut binary = buffers.next().unwrap_or_default().bytes;
        let mut beside = self.beside;
        beside.extend(
            buffers
                .filter_map(|Buffer { bytes, path }| path.map(|path| SidecarFile { path, bytes })),
        );
        let mut text = CancellableStream::new(Vec::new());
        serde_json::to_writer(&mut text, &document).map_err(|error| error.to_string())?;
        let mut text = text.into_inner();
        text.resize(text.len().next_multiple_of(4), b' ');
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
            write_in_pieces(&mut file, &binary).map_err(|error| error.to_string())?;
        }
        Ok((file, beside))
    }
}
