//! Image files into textures.

use std::io::Cursor;

use dwell_scene::Texture;
use image::ImageReader;

use crate::limits::{MAX_IMAGE_PIXELS, MAX_IMAGE_SIDE};

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
    Ok(Texture {
        name: name.to_owned(),
        width,
        height,
        rgba: image.into_raw(),
    })
}
