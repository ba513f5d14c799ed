//! Ogg Vorbis, by `lewton`.

use super::{MonoMix, damaged, vorbis_headers};
use crate::error::AcousticsError;
use lewton::inside_ogg::OggStreamReader;
use lewton::samples::InterleavedSamples;
use std::io::Cursor;

pub(super) fn decode<'a>(name: &'a str, bytes: &[u8]) -> Result<MonoMix<'a>, AcousticsError> {
    let Some(length) = length(bytes) else {
        return Err(damaged(name, &"it breaks off before its last page"));
    };
    vorbis_headers::check(bytes).map_err(|error| damaged(name, &error))?;
    let broken = |error: lewton::VorbisError| damaged(name, &error);
    let mut reader = OggStreamReader::new(Cursor::new(bytes)).map_err(broken)?;
    let (rate_hz, channels) = (
        reader.ident_hdr.audio_sample_rate,
        reader.ident_hdr.audio_channels,
    );
    let mut mix = MonoMix::new(name, rate_hz, u32::from(channels))?;
    while let Some(packet) = reader
        .read_dec_packet_generic::<InterleavedSamples<f32>>()
        .map_err(broken)?
    {
        // Chained files may change both.
        let header = &reader.ident_hdr;
        if (header.audio_sample_rate, header.audio_channels) != (rate_hz, channels) {
            return Err(damaged(name, &"rate or channels change on the way"));
        }
        for sample in packet.samples {
            mix.push(f64::from(sample))?;
        }
    }
    // The last block is complete, the sound in it need not be.
    let beyond = (mix.samples.len() as u64).saturating_sub(length);
    if beyond < LONGEST_BLOCK {
        mix.samples.truncate(mix.samples.len() - beyond as usize);
    }
    Ok(mix)
}

/// Samples of the longest block of the format.
const LONGEST_BLOCK: u64 = 8192;

/// Returns the number of samples given by the last page; `None` when the file does not end.
fn length(bytes: &[u8]) -> Option<u64> {
    const LAST_PAGE: u8 = 4;
    let last = bytes
        .windows(14)
        .rposition(|page| page.starts_with(b"OggS"))?;
    let header = &bytes[last..last + 14];
    let position = header[6..].try_into().map(u64::from_le_bytes).ok()?;
    (header[5] & LAST_PAGE != 0).then_some(position)
}

#[cfg(test)]
mod tests {
    use super::super::vorbis_headers::tests::{file_with, packets};
    use dwell_scene::random::RandomKey;

    /// Packets of random contents with valid checksums: a decoder gives sound, or an error.
    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn packets_of_nonsense_end_nothing() {
        let packets = packets();
        let mut stream = RandomKey::root(11).stream();
        let mut heard = 0;
        for _ in 0..4_000 {
            let which = 2 + stream.below(packets.len() - 2);
            let mut packet = packets[which].clone();
            for _ in 0..=stream.below(8) {
                let byte = stream.below(packet.len());
                packet[byte] = stream.below(256) as u8;
            }
            let found = crate::Recording::decode("noise", &file_with(which, packet));
            heard += u32::from(found.is_ok());
        }
        assert!(heard > 1_000, "{heard}");
    }

    /// A byte of the setup header, found by fuzzing, that makes the curves of blocks fall below their least value.
    #[test]
    fn a_curve_that_leaves_its_range_ends_nothing() {
        let packets = packets();
        let mut header = packets[2].clone();
        assert_eq!(header[3353], 3);
        header[3353] = 33;
        let found = crate::Recording::decode("noise", &file_with(2, header)).unwrap();
        assert!(found.samples().iter().all(|sample| sample.is_finite()));
    }
}
