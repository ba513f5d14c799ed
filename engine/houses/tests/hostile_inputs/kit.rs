//! Building blocks of the cases: folders, GLBs, PNGs, and the expected end of a case.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// The expected end of reading a hostile file.
pub(crate) enum Ends {
    /// In an error whose sentence holds all of these words.
    Fails(&'static [&'static str]),
    /// In a house, and one warning of the report that holds all of these words.
    Warns(&'static [&'static str]),
}

/// A hostile input.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    /// Writes the files into an empty folder and gives the HOUSE string.
    pub(crate) make: fn(&Path) -> PathBuf,
    pub(crate) ends: Ends,
    /// True if it is read up to the caps, which are large, instead of being refused at sight.
    pub(crate) heavy: bool,
}

impl Case {
    /// The same case, which takes memory up to the caps.
    pub(crate) const fn heavy(self) -> Self {
        Self {
            heavy: true,
            ..self
        }
    }
}

/// A case that is refused.
pub(crate) const fn fails(
    name: &'static str,
    make: fn(&Path) -> PathBuf,
    words: &'static [&'static str],
) -> Case {
    let ends = Ends::Fails(words);
    let heavy = false;
    Case {
        name,
        make,
        ends,
        heavy,
    }
}

/// A case that is survived and reported.
pub(crate) const fn warns(
    name: &'static str,
    make: fn(&Path) -> PathBuf,
    words: &'static [&'static str],
) -> Case {
    let ends = Ends::Warns(words);
    let heavy = false;
    Case {
        name,
        make,
        ends,
        heavy,
    }
}

/// Writes a file below the folder and gives its path.
pub(crate) fn put(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    path
}

/// A triangle of glTF with one buffer of 42 bytes in `triangle_bytes`.
pub(crate) fn triangle() -> Value {
    json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "floor"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "oak"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 42}],
    })
}

/// Its positions and indices.
pub(crate) fn triangle_bytes() -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let positions = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let indices = [0_u16, 1, 2].into_iter().flat_map(u16::to_le_bytes);
    positions.chain(indices).collect()
}

/// The same file with one value set, where a JSON pointer says.
pub(crate) fn with(mut file: Value, pointer: &str, value: Value) -> Value {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match file.pointer_mut(parent).unwrap() {
        Value::Array(items) => items[key.parse::<usize>().unwrap()] = value,
        Value::Object(fields) => {
            fields.insert(key.to_owned(), value);
        }
        other => panic!("{other} at {parent}"),
    }
    file
}

/// The bytes of a GLB.
pub(crate) fn glb(json: &Value, blob: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut blob = blob.to_vec();
    blob.resize(blob.len().next_multiple_of(4), 0);
    let word = |x: usize| u32::try_from(x).unwrap().to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(word(2));
    bytes.extend(word(28 + text.len() + blob.len()));
    bytes.extend(word(text.len()));
    bytes.extend(b"JSON");
    bytes.extend(text);
    bytes.extend(word(blob.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(blob);
    bytes
}

/// Writes `a.glb` with the triangle's buffer.
pub(crate) fn put_glb(folder: &Path, json: &Value) -> PathBuf {
    put(folder, "a.glb", glb(json, &triangle_bytes()))
}

/// A PNG's start: a header that states a size in grey of one bit, and image data that holds nothing of it.
pub(crate) fn png_of(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([1, 0, 0, 0, 0]);
    png_chunk(&mut bytes, *b"IHDR", &header);
    png_chunk(
        &mut bytes,
        *b"IDAT",
        &[0x78, 0x9c, 0x03, 0x00, 0x00, 0x00, 0x00, 0x01],
    );
    png_chunk(&mut bytes, *b"IEND", &[]);
    bytes
}

/// Appends a chunk with its checksum (CRC-32 of IEEE 802.3).
pub(crate) fn png_chunk(bytes: &mut Vec<u8>, kind: [u8; 4], data: &[u8]) {
    bytes.extend(u32::try_from(data.len()).unwrap().to_be_bytes());
    let start = bytes.len();
    bytes.extend(kind);
    bytes.extend(data);
    let mut crc = u32::MAX;
    for byte in &bytes[start..] {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ (0xEDB8_8320 * (crc & 1));
        }
    }
    bytes.extend((!crc).to_be_bytes());
}

/// A sound grey PNG, all black: the smaller, the more it is in memory for a byte of the file.
pub(crate) fn black_png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    image::GrayImage::new(width, height)
        .write_to(
            &mut std::io::Cursor::new(&mut bytes),
            image::ImageFormat::Png,
        )
        .unwrap();
    bytes
}

/// The text of an OBJ file with one triangle under a material library.
pub(crate) fn obj_of(library: &str) -> String {
    format!("mtllib {library}\no floor\nv 0 0 0\nv 0 0 1\nv 1 0 0\nusemtl a\nf 1 2 3\n")
}
