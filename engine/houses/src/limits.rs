//! Caps that hold before memory is taken. Real files stay far below; hostile ones end here.

/// Largest JSON or CSV text, bytes. The largest SUNCG house is a few MiB; `ModelCategoryMapping.csv` is 150 KiB.
pub(crate) const MAX_TEXT_BYTES: u64 = 256 << 20;
/// Largest OBJ or MTL file, bytes. The largest SUNCG model is a few MiB.
pub(crate) const MAX_MESH_BYTES: u64 = 512 << 20;
/// Largest image file, bytes.
pub(crate) const MAX_IMAGE_BYTES: u64 = 64 << 20;
/// Largest image side, pixels; the scene's own bound.
pub(crate) const MAX_IMAGE_SIDE: u32 = 16_384;
/// Largest image after decoding, pixels (64 Mpx are 256 MiB as RGBA).
pub(crate) const MAX_IMAGE_PIXELS: u64 = 64 << 20;
/// Largest binary buffer of glTF and of the native form, bytes.
pub(crate) const MAX_BUFFER_BYTES: u64 = 2 << 30;
/// Most nodes in a house, all levels together: what rests on what is asked for every pair. The largest SUNCG houses have a
/// few thousand.
pub(crate) const MAX_NODES: usize = 50_000;
/// Most corners of one polygon.
pub(crate) const MAX_CORNERS: usize = 100_000;
/// Largest voxel grid side of a binvox file (SUNCG has 128).
pub(crate) const MAX_VOXEL_SIDE: u32 = 1024;
/// Most names of a folder. The largest of Habitat's data sets keeps some thousand objects in one.
pub(crate) const MAX_FOLDER_ENTRIES: usize = 100_000;
