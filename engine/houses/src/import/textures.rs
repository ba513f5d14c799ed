//! Image files into textures.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::sync::Arc;

use dwell_scene::Texture;
use dwell_scene::parallel::Threads;
use image::{DynamicImage, ImageDecoder, ImageReader};

use crate::data_root::DataRoot;
use crate::limits::{MAX_ALL_PIXELS, MAX_IMAGE_BYTES, MAX_IMAGE_PIXELS, MAX_IMAGE_SIDE};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The name of a texture: its path's last part without the ending.
pub(crate) fn texture_name(path: &str) -> String {
    let base = path.rsplit(['/', '\\']).next().unwrap_or(path);
    base.rsplit_once('.')
        .map_or(base, |(stem, _)| stem)
        .to_owned()
}

/// The pixels that an image says it has, by its header alone.
///
/// # Errors
/// A sentence when the bytes are no PNG or JPEG image, or it is too large to be read.
pub(crate) fn pixels(bytes: &[u8]) -> Result<u64, String> {
    header(bytes).map(|(_, pixels)| pixels)
}

/// A decoder that stands behind the image's header, and the pixels that this states.
fn header(bytes: &[u8]) -> Result<(impl ImageDecoder + '_, u64), String> {
    let told = |error: image::ImageError| error.to_string();
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| error.to_string())?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    limits.max_alloc = Some(MAX_IMAGE_PIXELS * 8);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(told)?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    // Before anything is decoded: a few KiB can state, and fill, any number of pixels.
    if pixels == 0 || pixels > MAX_IMAGE_PIXELS {
        return Err(format!(
            "{width} by {height} pixels; allowed are 1 to {MAX_IMAGE_PIXELS} in all"
        ));
    }
    Ok((decoder, pixels))
}

/// Decodes a PNG or JPEG image, whatever its file's ending says.
///
/// # Errors
/// A sentence when the bytes are no such image or the image is too large.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Texture, String> {
    let (decoder, _) = header(bytes)?;
    let image = DynamicImage::from_decoder(decoder)
        .map_err(|error| error.to_string())?
        .into_rgba8();
    let (width, height) = image.dimensions();
    Ok(Texture::new(
        name.to_owned(),
        width,
        height,
        image.into_raw(),
    ))
}

/// Returns whether a JPEG image ends before its end marker: the decoder makes grey of what is missing.
pub(crate) fn is_cut(bytes: &[u8]) -> bool {
    const START: [u8; 2] = [0xff, 0xd8];
    if !bytes.starts_with(&START) {
        return false;
    }
    let mut at = START.len();
    loop {
        // In a scan, 0 behind 0xff stands for 0xff itself, and eight markers do not end it.
        let Some(found) = bytes
            .get(at..)
            .and_then(|rest| rest.iter().position(|b| *b == 0xff))
        else {
            return true;
        };
        at += found + 1;
        let length = |at: usize| {
            let length = bytes.get(at..at + 2)?;
            Some(usize::from(u16::from_be_bytes([length[0], length[1]])))
        };
        match bytes.get(at) {
            None => return true,
            // The end.
            Some(0xd9) => return false,
            // Filling: the next one counts.
            Some(0xff) => {}
            Some(0x00 | 0x01 | 0xd0..=0xd8) => at += 1,
            Some(_) => match length(at + 1) {
                Some(length) => at += 1 + length,
                None => return true,
            },
        }
    }
}

/// The images of a house as far as [`MAX_ALL_PIXELS`] reach, in order; what is above it is left out.
#[derive(Default)]
pub(crate) struct PixelBudget {
    used: u64,
}

impl PixelBudget {
    /// Takes the pixels of one image.
    ///
    /// # Errors
    /// A sentence when they are more than what is left.
    pub(crate) fn take(&mut self, pixels: u64) -> Result<(), String> {
        let used = self.used.saturating_add(pixels);
        if used > MAX_ALL_PIXELS {
            return Err(format!(
                "with it the images have {used} pixels; allowed are {MAX_ALL_PIXELS} in all"
            ));
        }
        self.used = used;
        Ok(())
    }
}

/// Reads and decodes images of `root`; those that do not exist or cannot be read are reported and absent.
pub(crate) fn read_images(
    root: &DataRoot,
    wanted: BTreeSet<String>,
    threads: Threads,
    report: &mut LoadReport,
) -> BTreeMap<String, Arc<Texture>> {
    let wanted: Vec<String> = wanted.into_iter().collect();
    let read = threads.map(wanted.len(), |k| {
        let path = &wanted[k];
        let unreadable = |reason| WarningKind::UnreadableTexture {
            path: path.clone(),
            reason,
        };
        if !root.has_file(path) {
            return Err(WarningKind::MissingTexture { path: path.clone() });
        }
        let bytes = root
            .read(path, MAX_IMAGE_BYTES)
            .map_err(|error| unreadable(error.reason()))?;
        let pixels = pixels(&bytes).map_err(unreadable)?;
        Ok((bytes, pixels))
    });
    let mut budget = PixelBudget::default();
    let within: Vec<Result<Vec<u8>, WarningKind>> = read
        .into_iter()
        .zip(&wanted)
        .map(|(read, path)| {
            let (bytes, pixels) = read?;
            let path = path.clone();
            let unreadable = |reason| WarningKind::UnreadableTexture { path, reason };
            budget.take(pixels).map_err(unreadable)?;
            Ok(bytes)
        })
        .collect();
    let decoded = threads.map(wanted.len(), |k| {
        let path = &wanted[k];
        let unreadable = |reason| WarningKind::UnreadableTexture {
            path: path.clone(),
            reason,
        };
        let bytes = within[k].as_ref().map_err(Clone::clone)?;
        let texture = decode(&texture_name(path), bytes).map_err(unreadable)?;
        Ok((texture, is_cut(bytes)))
    });
    let mut textures = BTreeMap::new();
    for (path, result) in wanted.into_iter().zip(decoded) {
        match result {
            Ok((texture, cut)) => {
                if cut {
                    let damage = WarningKind::CutTexture { path: path.clone() };
                    report.warn(FileLocation::file(path.as_str()), damage);
                }
                textures.insert(path, Arc::new(texture));
            }
            Err(damage) => report.warn(FileLocation::file(path), damage),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_cut_unless_its_end_marker_is_there() {
        let mut bytes = Vec::new();
        let picture =
            image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8 * 6, y as u8 * 8, 0xff]));
        let jpeg = image::ImageFormat::Jpeg;
        picture
            .write_to(&mut Cursor::new(&mut bytes), jpeg)
            .unwrap();
        assert!(!is_cut(&bytes));
        assert!(!is_cut(&[&bytes[..], b"more"].concat()));
        for length in 2..bytes.len() {
            assert!(is_cut(&bytes[..length]), "{length} of {}", bytes.len());
        }
        // Other forms say themselves where they end.
        assert!(!is_cut(b"\x89PNG"));
    }
}
