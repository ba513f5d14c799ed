//! Caps that hold before memory is taken. Real files stay far below; hostile ones end here.

/// Largest JSON, XML or CSV text, bytes; that of a GLB, too. The largest SUNCG house is a few MiB. As a tree of values a text
/// takes up to 16 times its length.
pub(crate) const MAX_TEXT_BYTES: u64 = 64 << 20;
/// Largest OBJ or MTL file, bytes. The largest SUNCG model is a few MiB.
pub(crate) const MAX_MESH_BYTES: u64 = 512 << 20;
/// Largest image file, bytes.
pub(crate) const MAX_IMAGE_BYTES: u64 = 64 << 20;
/// Largest image side, pixels; the scene's own bound.
pub(crate) const MAX_IMAGE_SIDE: u32 = 16_384;
/// Largest image after decoding, pixels (64 Mpx are 256 MiB as RGBA).
pub(crate) const MAX_IMAGE_PIXELS: u64 = 64 << 20;
/// Most pixels of all images that a file names, after decoding (2 GiB as RGBA). Those above it are left out.
pub(crate) const MAX_ALL_PIXELS: u64 = 512 << 20;
/// Most vertices and indices that the meshes of a glTF file or of the native form have, that its nodes, parts and pieces of the
/// building show, and that rooms of SUNCG show: all may name the same bytes any number of times.
pub(crate) const MAX_CORNERS_SHOWN: u64 = 64 << 20;
/// Most MTL files of one OBJ file.
pub(crate) const MAX_LIBRARIES: usize = 1000;
/// Most XML files that include or attach each other, and how deep they may.
pub(crate) const MAX_XML_FILES: usize = 64;
/// Most XML elements, those of included files counted each time.
pub(crate) const MAX_XML_ELEMENTS: u64 = 1_000_000;
/// Most attributes of an XML element, and most namespaces that a file declares: the parser compares each with all others.
pub(crate) const MAX_XML_ATTRIBUTES: u64 = 128;
/// Deepest nesting of XML elements.
pub(crate) const MAX_XML_DEPTH: usize = 200;
/// Deepest nesting of folders that a pattern of a data set names.
pub(crate) const MAX_PATTERN_WORDS: usize = 12;
/// Most letters of names that are compared with the patterns of a map: some ten seconds, in which the call can be stopped.
pub(crate) const MAX_LETTERS_COMPARED: u64 = 10_000_000_000;
/// Largest binary buffer of glTF and of the native form, bytes.
pub(crate) const MAX_BUFFER_BYTES: u64 = 2 << 30;
/// Most bytes of all sound files of a house.
pub(crate) const MAX_ALL_SOUND_BYTES: u64 = 512 << 20;
/// Most nodes in a house, all levels together: what rests on what is asked for every pair. The largest SUNCG houses have a
/// few thousand.
pub(crate) const MAX_NODES: usize = 50_000;
/// Most corners of one face of an OBJ file.
pub(crate) const MAX_CORNERS: usize = 100_000;
/// Most corners of the outline of a room, which is cut into triangles.
pub(crate) const MAX_OUTLINE: usize = 500;
/// Largest voxel grid side of a binvox file (SUNCG has 128).
pub(crate) const MAX_VOXEL_SIDE: u32 = 512;
/// Most names of a folder. The largest of Habitat's data sets keeps some thousand objects in one.
pub(crate) const MAX_FOLDER_ENTRIES: usize = 100_000;

#[cfg(test)]
mod tests {
    use super::*;

    /// The page's table states every cap of this file, as it is.
    #[test]
    fn the_page_states_the_caps() {
        let page = include_str!("../../../docs/hostile-input.md");
        let here = include_str!("limits.rs");
        let caps = [
            ("MAX_TEXT_BYTES", MAX_TEXT_BYTES),
            ("MAX_MESH_BYTES", MAX_MESH_BYTES),
            ("MAX_IMAGE_BYTES", MAX_IMAGE_BYTES),
            ("MAX_IMAGE_SIDE", u64::from(MAX_IMAGE_SIDE)),
            ("MAX_IMAGE_PIXELS", MAX_IMAGE_PIXELS),
            ("MAX_ALL_PIXELS", MAX_ALL_PIXELS),
            ("MAX_BUFFER_BYTES", MAX_BUFFER_BYTES),
            ("MAX_ALL_SOUND_BYTES", MAX_ALL_SOUND_BYTES),
            ("MAX_CORNERS_SHOWN", MAX_CORNERS_SHOWN),
            ("MAX_NODES", MAX_NODES as u64),
            ("MAX_CORNERS", MAX_CORNERS as u64),
            ("MAX_OUTLINE", MAX_OUTLINE as u64),
            ("MAX_LIBRARIES", MAX_LIBRARIES as u64),
            ("MAX_XML_FILES", MAX_XML_FILES as u64),
            ("MAX_XML_ELEMENTS", MAX_XML_ELEMENTS),
            ("MAX_XML_ATTRIBUTES", MAX_XML_ATTRIBUTES),
            ("MAX_XML_DEPTH", MAX_XML_DEPTH as u64),
            ("MAX_PATTERN_WORDS", MAX_PATTERN_WORDS as u64),
            ("MAX_LETTERS_COMPARED", MAX_LETTERS_COMPARED),
            ("MAX_VOXEL_SIDE", u64::from(MAX_VOXEL_SIDE)),
            ("MAX_FOLDER_ENTRIES", MAX_FOLDER_ENTRIES as u64),
        ];
        for (name, value) in caps {
            let row = format!("| `{name}` | {value} |");
            assert!(page.contains(&row), "{row}");
        }
        let constants = here.matches("pub(crate) const MAX_").count();
        // One match is this line's own.
        assert_eq!(
            constants - 1,
            caps.len(),
            "a cap that the page does not state"
        );
        // The table of the physics follows, which has a test of its own.
        let (own, _) = page.split_once("\n| `MAX_BODIES`").expect("its first row");
        assert_eq!(own.matches("\n| `MAX_").count(), caps.len());
    }
}
