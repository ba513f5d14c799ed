//! Decoding of image files into textures.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::sync::Arc;

use dwell_scene::Texture;
use dwell_scene::parallel::Threads;
use image::{ColorType, ImageDecoder, ImageReader};

use crate::data_root::DataRoot;
use crate::limits::{MAX_ALL_PIXELS, MAX_IMAGE_BYTES, MAX_IMAGE_PIXELS, MAX_IMAGE_SIDE};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Magic number of JPEG files.
const JPEG_START: [u8; 2] = [0xff, 0xd8];

/// The name of a texture: its path's last part without the ending.
pub(crate) fn texture_name(path: &str) -> String {
    let base = path.rsplit(['/', '\\']).next().unwrap_or(path);
    base.rsplit_once('.')
        .map_or(base, |(stem, _)| stem)
        .to_owned()
}

/// The number of pixels that an image states, by its header alone.
///
/// # Errors
/// A sentence when the bytes are no PNG or JPEG image, or it is too large to be read.
pub(crate) fn header_pixel_count(bytes: &[u8]) -> Result<u64, String> {
    open_decoder(bytes).map(|(_, pixels)| pixels)
}

/// A decoder behind the image's header, and the number of pixels that this states.
fn open_decoder(bytes: &[u8]) -> Result<(impl ImageDecoder + '_, u64), String> {
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
    // Before decoding: a few KiB can state, and fill, any number of pixels.
    if pixels == 0 || pixels > MAX_IMAGE_PIXELS {
        return Err(format!(
            "{width} by {height} pixels; allowed are 1 to {MAX_IMAGE_PIXELS} in all"
        ));
    }
    // Each block of 8 by 8 pixels takes one bit or more of a JPEG's first scan (ITU-T T.81, F.1.2 and G.1.2).
    let blocks = u64::from(width.div_ceil(8)) * u64::from(height.div_ceil(8));
    if bytes.starts_with(&JPEG_START) && (bytes.len() as u64) * 8 < blocks {
        return Err(format!(
            "{width} by {height} pixels in {} bytes, which cannot hold them",
            bytes.len()
        ));
    }
    Ok((decoder, pixels))
}

/// Decodes a PNG or JPEG image, whatever its file's ending says.
///
/// # Errors
/// A sentence when the bytes are no such image or the image is too large.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Texture, String> {
    let (decoder, pixels) = open_decoder(bytes)?;
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    let mut raw = try_with_capacity(decoder.total_bytes())?;
    raw.resize(decoder.total_bytes() as usize, 0);
    decoder
        .read_image(&mut raw)
        .map_err(|error| error.to_string())?;
    let rgba = rgba(raw, color, pixels)?;
    Ok(Texture::new(name.to_owned(), width, height, rgba))
}

/// An empty vector with room for so many bytes. `image` itself panics, or ends the process, where memory does not suffice.
fn try_with_capacity(count: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let reserved = bytes.try_reserve_exact(usize::try_from(count).unwrap_or(usize::MAX));
    reserved.map_err(|_| format!("the {count} bytes that it takes are not free"))?;
    Ok(bytes)
}

/// Pixels of any colour as RGBA of 8 bits.
fn rgba(mut raw: Vec<u8>, color: ColorType, pixels: u64) -> Result<Vec<u8>, String> {
    let channels = usize::from(color.channel_count());
    if usize::from(color.bytes_per_pixel()) == 2 * channels {
        // 65535 is 257 times 255.
        raw = raw
            .as_chunks()
            .0
            .iter()
            .map(|two| ((u32::from(u16::from_ne_bytes(*two)) + 128) / 257) as u8)
            .collect();
    }
    if channels == 4 {
        return Ok(raw);
    }
    let mut rgba = try_with_capacity(pixels * 4)?;
    for pixel in raw.chunks_exact(channels) {
        rgba.extend(match *pixel {
            [grey] => [grey, grey, grey, u8::MAX],
            [grey, alpha] => [grey, grey, grey, alpha],
            [r, g, b] => [r, g, b, u8::MAX],
            _ => return Err(format!("{color:?} is not read")),
        });
    }
    Ok(rgba)
}

/// Returns whether a JPEG image ends before its end marker: the decoder fills the rest with grey.
pub(crate) fn is_truncated_jpeg(bytes: &[u8]) -> bool {
    if !bytes.starts_with(&JPEG_START) {
        return false;
    }
    let mut at = JPEG_START.len();
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

/// A budget of decoded pixels: the images of a house up to [`MAX_ALL_PIXELS`], in order; those above it are left out.
#[derive(Default)]
pub(crate) struct PixelBudget {
    used: u64,
}

impl PixelBudget {
    /// Takes the pixels of one image.
    ///
    /// # Errors
    /// A sentence when they are more than what is left.
    pub(crate) fn reserve(&mut self, pixels: u64) -> Result<(), String> {
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
        if !root.exists(path) {
            return Err(WarningKind::MissingTexture { path: path.clone() });
        }
        let bytes = root
            .read(path, MAX_IMAGE_BYTES)
            .map_err(|error| unreadable(error.reason()))?;
        let pixels = header_pixel_count(&bytes).map_err(unreadable)?;
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
            budget.reserve(pixels).map_err(unreadable)?;
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
        Ok((texture, is_truncated_jpeg(bytes)))
    });
    let mut textures = BTreeMap::new();
    for (path, result) in wanted.into_iter().zip(decoded) {
        match result {
            Ok((texture, cut)) => {
                if cut {
                    let damage = WarningKind::TruncatedTexture { path: path.clone() };
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
    use image::DynamicImage;

    #[test]
    fn every_colour_type_is_decoded_as_image_does() {
        let noise = image::ImageBuffer::from_fn(37, 23, |x, y| {
            let value = |k: u32| (x * 2311 + y * 17033 + k * 29027) as u16;
            image::Rgba([value(1), value(2), value(3), value(4)])
        });
        let noise = DynamicImage::ImageRgba16(noise);
        let all = [
            DynamicImage::from(noise.to_luma8()),
            noise.to_luma_alpha8().into(),
            noise.to_rgb8().into(),
            noise.to_rgba8().into(),
            noise.to_luma16().into(),
            noise.to_luma_alpha16().into(),
            noise.to_rgb16().into(),
            noise,
        ];
        for image in all {
            let mut png = Vec::new();
            let form = image::ImageFormat::Png;
            image.write_to(&mut Cursor::new(&mut png), form).unwrap();
            let texture = decode("a", &png).unwrap();
            assert_eq!(
                texture.rgba(),
                image.to_rgba8().as_raw(),
                "{:?}",
                image.color()
            );
        }
    }

    #[test]
    fn memory_that_is_not_there_is_an_error() {
        assert!(
            try_with_capacity(1 << 62)
                .unwrap_err()
                .contains("are not free")
        );
    }

    #[test]
    fn an_image_is_cut_unless_its_end_marker_is_there() {
        let mut bytes = Vec::new();
        let picture =
            image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8 * 6, y as u8 * 8, 0xff]));
        let jpeg = image::ImageFormat::Jpeg;
        picture
            .write_to(&mut Cursor::new(&mut bytes), jpeg)
            .unwrap();
        assert!(!is_truncated_jpeg(&bytes));
        assert!(!is_truncated_jpeg(&[&bytes[..], b"more"].concat()));
        for length in 2..bytes.len() {
            assert!(
                is_truncated_jpeg(&bytes[..length]),
                "{length} of {}",
                bytes.len()
            );
        }
        // A header that states more than the scan can hold is refused before it is decoded.
        let frame = bytes
            .windows(2)
            .position(|two| two == [0xff, 0xc0])
            .unwrap();
        let mut huge = bytes.clone();
        huge[frame + 5..frame + 9].copy_from_slice(&[0x1f, 0x40, 0x1f, 0x40]);
        assert_eq!(
            header_pixel_count(&huge),
            Err(format!(
                "8000 by 8000 pixels in {} bytes, which cannot hold them",
                huge.len()
            ))
        );
        // Truncated files of other formats are errors of their decoders.
        assert!(!is_truncated_jpeg(b"\x89PNG"));
    }
}
