//! Binvox files: solid voxels of a model.
//!
//! The grid is of the model in z-up form, (x, z, y), so `translate` is (min x, min z, min y).

use crate::error::HousesError;
use crate::limits::MAX_VOXEL_SIDE;
use crate::report::FileLocation;

/// A grid of solid voxels.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelGrid {
    /// Voxels along each side.
    pub dims: [u32; 3],
    /// Smallest corner, m: (min x, min z, min y) of the model.
    pub translate: [f64; 3],
    /// Length of the grid's side, m.
    pub scale: f64,
    /// True for each solid voxel, as the file orders them. Shape (dims product,).
    pub solid: Vec<bool>,
}

impl VoxelGrid {
    /// Returns the number of solid voxels.
    pub fn count(&self) -> u64 {
        self.solid.iter().filter(|solid| **solid).count() as u64
    }

    /// The edge of a voxel, m.
    pub fn edge_m(&self) -> f64 {
        self.scale / f64::from(self.dims[0])
    }

    /// The solid volume, m³.
    pub fn volume_m3(&self) -> f64 {
        self.count() as f64 * self.edge_m().powi(3)
    }
}

/// Reads the bytes of a binvox file.
///
/// # Errors
/// [`HousesError::Syntax`] or [`HousesError::TooLarge`] with the line of the header or the byte of the runs.
pub fn read_binvox(bytes: &[u8], file: &str) -> Result<VoxelGrid, HousesError> {
    let at = FileLocation::file(file);
    let syntax = |line: u32, message: String| HousesError::Syntax {
        at: at.line(line),
        message,
    };
    let mut rest = bytes;
    let (mut dims, mut translate, mut scale) = (None, [0.0; 3], 1.0);
    for line_number in 1.. {
        let end = rest.iter().take(200).position(|&b| b == b'\n');
        let Some(end) = end else {
            return Err(syntax(
                line_number,
                "the header ends without \"data\"".to_owned(),
            ));
        };
        let line = String::from_utf8_lossy(&rest[..end]).into_owned();
        rest = &rest[end + 1..];
        let mut words = line.split_ascii_whitespace();
        let keyword = words.next().unwrap_or("");
        let numbers: Vec<f64> = words
            .map_while(|word| word.parse().ok())
            .filter(|x: &f64| x.is_finite())
            .collect();
        match (keyword, numbers.as_slice()) {
            ("#binvox", _) if line_number == 1 => {}
            ("dim", &[x, y, z])
                if line_number > 1 && [x, y, z].iter().all(|side| side.fract() == 0.0) =>
            {
                dims = Some([x as u32, y as u32, z as u32]);
            }
            ("translate", &[x, y, z]) if line_number > 1 => translate = [x, y, z],
            ("scale", &[s]) if line_number > 1 && s > 0.0 => scale = s,
            ("data", _) if line_number > 1 => break,
            _ => {
                let expected = if line_number == 1 {
                    "\"#binvox 1\""
                } else {
                    "dim with whole numbers, or translate, scale or data with numbers"
                };
                return Err(syntax(
                    line_number,
                    format!("expected {expected}, found {line:?}"),
                ));
            }
        }
    }
    let dims = dims.ok_or_else(|| syntax(2, "no dim line".to_owned()))?;
    if let Some(&side) = dims
        .iter()
        .find(|side| **side > MAX_VOXEL_SIDE || **side == 0)
    {
        let (found, allowed) = (u64::from(side), u64::from(MAX_VOXEL_SIDE));
        return Err(HousesError::TooLarge {
            at: at.field("dim"),
            what: "voxels a side",
            found,
            allowed,
        });
    }
    let total: usize = dims.iter().map(|side| *side as usize).product();
    let mut solid = Vec::new();
    for (k, run) in rest.chunks(2).enumerate() {
        let &[value, count] = run else { break };
        if value > 1 || solid.len() + usize::from(count) > total {
            let message = format!(
                "run {k} ({value} for {count} voxels) does not fit {total} voxels of 0 or 1"
            );
            return Err(HousesError::Syntax {
                at: at.field("data"),
                message,
            });
        }
        solid.resize(solid.len() + usize::from(count), value == 1);
    }
    if solid.len() != total {
        let message = format!("the runs end after {} of {total} voxels", solid.len());
        return Err(HousesError::Syntax {
            at: at.field("data"),
            message,
        });
    }
    Ok(VoxelGrid {
        dims,
        translate,
        scale,
        solid,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_become_voxels_and_a_volume() {
        let mut bytes = b"#binvox 1\ndim 2 2 2\ntranslate -1 0 2\nscale 3\ndata\n".to_vec();
        bytes.extend([0, 3, 1, 5]);
        let voxels = read_binvox(&bytes, "a.binvox").unwrap();
        assert_eq!((voxels.count(), voxels.translate), (5, [-1.0, 0.0, 2.0]));
        assert!((voxels.volume_m3() - 5.0 * 1.5_f64.powi(3)).abs() < 1e-12);
    }

    #[test]
    fn bad_files_are_refused_with_the_place() {
        let message = |text: &[u8]| read_binvox(text, "a.binvox").unwrap_err().to_string();
        assert_eq!(
            message(b"hello\n"),
            "a.binvox:1: expected \"#binvox 1\", found \"hello\""
        );
        assert_eq!(
            message(b"#binvox 1\ndim 2 2"),
            "a.binvox:2: the header ends without \"data\""
        );
        assert_eq!(
            message(b"#binvox 1\ndim 99999 9 9\ndata\n"),
            "a.binvox: dim: voxels a side 99999 is more than the 512 that are read"
        );
        assert_eq!(
            message(b"#binvox 1\ndim 2 2 2\ndata\n\x01\x09"),
            "a.binvox: data: run 0 (1 for 9 voxels) does not fit 8 voxels of 0 or 1"
        );
        assert_eq!(
            message(b"#binvox 1\ndim 2 2 2\ndata\n\x01\x07"),
            "a.binvox: data: the runs end after 7 of 8 voxels"
        );
    }
}
