//! Image files into textures.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::sync::Arc;

use dwell_scene::Texture;
use dwell_scene::parallel::Threads;
use image::ImageReader;

use crate::damage::Damage;
use crate::limits::{MAX_IMAGE_BYTES, MAX_IMAGE_PIXELS, MAX_IMAGE_SIDE};
use crate::report::{At, Report};
use crate::root::DataRoot;

/// The name of a texture: its path's last part without the ending.
pub(crate) fn texture_name(path: &str) -> String {
    let base = path.rsplit(['/', '\\']).next().unwrap_or(path);
    base.rsplit_once('.')
        .map_or(base, |(stem, _)| stem)
        .to_owned()
}

/// Decodes a PNG or JPEG image, whatever its file's ending says.
///
/// # Errors
/// A sentence when the bytes are no such image or the image is too large.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Texture, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| error.to_string())?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    limits.max_alloc = Some(MAX_IMAGE_PIXELS * 8);
    reader.limits(limits);
    let image = reader
        .decode()
        .map_err(|error| error.to_string())?
        .into_rgba8();
    let (width, height) = image.dimensions();
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) > MAX_IMAGE_PIXELS {
        return Err(format!(
            "{width} by {height} pixels; allowed are 1 to {MAX_IMAGE_PIXELS} in all"
        ));
    }
    Ok(Texture::new(
        name.to_owned(),
        width,
        height,
        image.into_raw(),
    ))
}

/// Reads and decodes images of `root`; those that do not exist or cannot be read are reported and absent.
pub(crate) fn read_images(
    root: &DataRoot,
    wanted: BTreeSet<String>,
    threads: Threads,
    report: &mut Report,
) -> BTreeMap<String, Arc<Texture>> {
    let wanted: Vec<String> = wanted.into_iter().collect();
    let decoded = threads.map(wanted.len(), |k| {
        let path = &wanted[k];
        let unreadable = |reason| Damage::UnreadableTexture {
            path: path.clone(),
            reason,
        };
        if !root.has_file(path) {
            return Err(Damage::MissingTexture { path: path.clone() });
        }
        let bytes = root
            .read(path, MAX_IMAGE_BYTES)
            .map_err(|error| unreadable(error.reason()))?;
        decode(&texture_name(path), &bytes).map_err(unreadable)
    });
    let mut textures = BTreeMap::new();
    for (path, result) in wanted.into_iter().zip(decoded) {
        match result {
            Ok(texture) => {
                textures.insert(path, Arc::new(texture));
            }
            Err(damage) => report.warn(At::file(path), damage),
        }
    }
    textures
}

/// A texture as a PNG file, exactly.
///
/// # Errors
/// A sentence when its size does not fit its data or exceeds what is read back.
pub(crate) fn encode_png(texture: &Texture) -> Result<Vec<u8>, String> {
    use image::ImageEncoder as _;
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    let pixels = u64::from(texture.width) * u64::from(texture.height);
    if pixels > MAX_IMAGE_PIXELS {
        return Err(format!(
            "texture {:?}: {pixels} pixels; allowed are {MAX_IMAGE_PIXELS}",
            texture.name
        ));
    }
    let mut bytes = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
    encoder
        .write_image(
            texture.rgba(),
            texture.width,
            texture.height,
            image::ExtendedColorType::Rgba8,
        )
        .map_err(|error| format!("texture {:?}: {error}", texture.name))?;
    Ok(bytes)
}
