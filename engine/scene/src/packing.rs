//! How snapshots are packed.

use crate::error::SceneError;

/// How hard (1 to 10). 1 is twice as quick for a twelfth more; 8 and above take five times as long for a hundredth less.
const LEVEL: u8 = 6;
/// Nothing that is packed is larger, bytes.
const MOST_UNPACKED: usize = 1 << 30;

/// Bytes in fewer bytes (zlib); the same bytes give the same.
pub fn pack(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, LEVEL)
}

/// What [`pack`] packed.
///
/// # Errors
/// [`SceneError::Snapshot`] for bytes that are damaged, or larger than 1 GiB unpacked.
pub fn unpack(packed: &[u8]) -> Result<Vec<u8>, SceneError> {
    miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, MOST_UNPACKED)
        .map_err(|error| SceneError::Snapshot(format!("it cannot be unpacked: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_bytes_come_back_and_damage_is_refused() {
        let bytes: Vec<u8> = (0..10_000_u32).map(|k| (k * k % 251) as u8).collect();
        let packed = pack(&bytes);
        assert!(packed.len() < bytes.len() / 2);
        assert_eq!(unpack(&packed).unwrap(), bytes);
        let empty = unpack(&pack(&[])).unwrap();
        assert!(empty.is_empty());
        for length in [0, 1, packed.len() / 2, packed.len() - 1] {
            let refused = unpack(&packed[..length]).unwrap_err().to_string();
            assert!(refused.contains("cannot be unpacked"), "{refused}");
        }
    }
}
