//! Dataspaces: numbers of values along axes.

use super::bytes::{Cursor, Hdf5Result, unsupported};

/// Most axes of a variable; SOFA's have at most 4.
const MOST_AXES: u8 = 8;

/// The axes of a variable; empty for a scalar.
#[derive(Debug, Clone)]
pub(super) struct Dataspace {
    /// Their lengths.
    pub(super) lengths: Vec<u64>,
    /// Their maximum lengths; `None` if unlimited.
    pub(super) max_lengths: Vec<Option<u64>>,
}

impl Dataspace {
    /// Reads the axes; `None` for a null dataspace.
    pub(super) fn read(mut cursor: Cursor<'_>) -> Hdf5Result<Option<Self>> {
        let version = cursor.u8()?;
        let axes = cursor.u8()?;
        let flags = cursor.u8()?;
        match version {
            1 => cursor.skip(5)?,
            2 => {
                if cursor.u8()? == 2 {
                    return Ok(None);
                }
            }
            _ => {
                return unsupported(format!(
                    "a dataspace of version {version}; read are 1 and 2"
                ));
            }
        }
        if axes > MOST_AXES {
            return unsupported(format!("{axes} axes; allowed are {MOST_AXES}"));
        }
        let lengths = (0..axes)
            .map(|_| cursor.length())
            .collect::<Hdf5Result<Vec<_>>>()?;
        let longest = if flags & 1 == 0 {
            lengths.iter().copied().map(Some).collect()
        } else {
            let unlimited = u64::MAX >> (64 - 8 * cursor.widths.length);
            let longest = (0..axes).map(|_| cursor.length());
            longest
                .map(|found| Ok(Some(found?).filter(|found| *found != unlimited)))
                .collect::<Hdf5Result<_>>()?
        };
        Ok(Some(Self {
            lengths,
            max_lengths: longest,
        }))
    }

    /// Returns the number of values, if it can be represented.
    pub(super) fn count(&self) -> Option<u64> {
        product(&self.lengths)
    }
}

/// Returns the product, if it can be represented.
pub(super) fn product(numbers: &[u64]) -> Option<u64> {
    numbers.iter().try_fold(1_u64, |all, n| all.checked_mul(*n))
}
