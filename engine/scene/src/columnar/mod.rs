//! Plain data as bytes that compress well: values of one field are stored side by side.
//!
//! A thousand contacts, written one after the other, mix places, forces and numbers of faces. Here every field of every
//! type has a column of its own, with a layout of its floats chosen to pack best (`FloatLayout`). For 500 objects that fell
//! in a heap the packed bytes are a third of those in rows, for a house whose objects lie strewn about seven eighths.
//!
//! Readers must know the type, as with `postcard`: the bytes hold no names. Columns are in the order in which the type
//! first reaches them.

mod layout;
mod read;
mod write;

pub use read::from_bytes;
pub use write::to_bytes;

use std::collections::HashMap;
use std::fmt::Display;

/// Bytes of a float.
const FLOAT: usize = size_of::<f32>();
/// The layout of a column's floats.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FloatLayout {
    /// First bytes of all, then second bytes: signs and exponents, which are similar, apart from the low digits.
    ByteShuffled,
    /// One float after the other: repetitions, here or in another column, are found whole.
    Plain,
    /// Rows of `width` floats, repeated ones as back references; of unit rows the largest component is computed from the others.
    Rows { width: usize, unit: bool },
}

impl FloatLayout {
    /// Widths of vectors and quaternions.
    const WIDTHS: [usize; 2] = [3, 4];

    fn byte(self) -> u8 {
        match self {
            Self::ByteShuffled => 0,
            Self::Plain => 1,
            Self::Rows { width, unit } => width as u8 * 2 + u8::from(unit),
        }
    }

    fn from_byte(byte: u8) -> Result<Self, ColumnsError> {
        let (width, unit) = (usize::from(byte / 2), byte % 2 == 1);
        match byte {
            0 => Ok(Self::ByteShuffled),
            1 => Ok(Self::Plain),
            _ if Self::WIDTHS.contains(&width) => Ok(Self::Rows { width, unit }),
            found => Err(ColumnsError::OutOfRange {
                found: found.into(),
                place: "a layout",
            }),
        }
    }
}

/// The reason why data cannot be written or read as columns.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnsError {
    /// A column ends too early.
    #[error("a column ends too early")]
    UnexpectedEnd,
    /// Bytes are left over.
    #[error("{0} bytes are left over")]
    TrailingData(usize),
    /// A number that is too large for its type.
    #[error("{found} is too large for {place}")]
    OutOfRange {
        /// The number.
        found: u64,
        /// The expected item.
        place: &'static str,
    },
    /// Data of unknown length, or whose type is asked for while reading.
    #[error("{0} cannot be held in columns")]
    Unsupported(&'static str),
    /// An error of the type itself.
    #[error("{0}")]
    Custom(String),
}

impl serde::ser::Error for ColumnsError {
    fn custom<T: Display>(message: T) -> Self {
        Self::Custom(message.to_string())
    }
}

impl serde::de::Error for ColumnsError {
    fn custom<T: Display>(message: T) -> Self {
        Self::Custom(message.to_string())
    }
}

/// The column of each field of a type, numbered as they are met. A column for each place where the type occurs would hold
/// fewer values of a kind and pack worse (heap of a hundred objects: 6 %).
struct ColumnIndex {
    columns: HashMap<(&'static str, &'static str), usize>,
    /// The last ones met, by the addresses of their names: an entry that does not match is looked up above.
    recent: Vec<Option<(NamePointers, usize)>>,
}

/// The memory addresses of two names.
type NamePointers = [(usize, usize); 2];

/// Entries of [`ColumnIndex::recent`], a power of two: more than there are fields.
const RECENT: usize = 1024;

impl ColumnIndex {
    fn new() -> Self {
        Self {
            columns: HashMap::new(),
            recent: vec![None; RECENT],
        }
    }

    /// Column 0 holds values outside fields.
    fn column(&mut self, owner: &'static str, field: &'static str) -> usize {
        let place = [owner, field].map(|name| (name.as_ptr().addr(), name.len()));
        let [(one, _), (two, _)] = place;
        let entry = (one.wrapping_mul(31).wrapping_add(two)) % RECENT;
        if let Some((known, column)) = self.recent[entry]
            && known == place
        {
            return column;
        }
        let next = self.columns.len() + 1;
        let column = *self.columns.entry((owner, field)).or_insert(next);
        self.recent[entry] = Some((place, column));
        column
    }
}

/// Writes seven bits a byte, the lowest first.
fn push_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Reads a number written by [`push_varint`].
fn read_varint(bytes: &mut &[u8]) -> Result<u64, ColumnsError> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = byte(bytes)?;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Ok(number);
        }
    }
    Err(ColumnsError::OutOfRange {
        found: number,
        place: "a number of 64 bits",
    })
}

fn byte(bytes: &mut &[u8]) -> Result<u8, ColumnsError> {
    Ok(take(bytes, 1)?[0])
}

fn take<'de>(bytes: &mut &'de [u8], length: usize) -> Result<&'de [u8], ColumnsError> {
    let (taken, rest) = bytes
        .split_at_checked(length)
        .ok_or(ColumnsError::UnexpectedEnd)?;
    *bytes = rest;
    Ok(taken)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde::{Deserialize, Serialize};
    use std::collections::BTreeMap;

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    enum Kind {
        None,
        One(u16),
        Pair(i8, f64),
        Named { weight: f32, name: String },
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Thing {
        place: [f32; 3],
        number: i64,
        large: u64,
        larger: u128,
        kind: Kind,
        deeper: Option<Box<Thing>>,
        unit: (),
        letter: char,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct All {
        things: Vec<Thing>,
        on: Vec<bool>,
        by_name: BTreeMap<String, (u8, f32)>,
        wrapped: Wrapped,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Wrapped(Vec<i32>);

    fn kinds() -> impl Strategy<Value = Kind> {
        prop_oneof![
            Just(Kind::None),
            any::<u16>().prop_map(Kind::One),
            (any::<i8>(), -1e300_f64..1e300).prop_map(|(a, b)| Kind::Pair(a, b)),
            (-1e30_f32..1e30, ".{0,9}").prop_map(|(weight, name)| Kind::Named { weight, name }),
        ]
    }

    fn things() -> impl Strategy<Value = Thing> {
        let one = (
            [-9.0_f32..9.0, -9.0_f32..9.0, -9.0_f32..9.0],
            any::<i64>(),
            any::<u64>(),
            any::<u128>(),
            kinds(),
            any::<char>(),
        );
        let plain = one.prop_map(|(place, number, large, larger, kind, letter)| Thing {
            place,
            number,
            large,
            larger,
            kind,
            deeper: None,
            unit: (),
            letter,
        });
        plain.prop_recursive(3, 8, 1, |inner| {
            (inner.clone(), inner).prop_map(|(outer, inner)| Thing {
                deeper: Some(Box::new(inner)),
                ..outer
            })
        })
    }

    fn data() -> impl Strategy<Value = All> {
        let by_name = prop::collection::btree_map(".{0,5}", (any::<u8>(), -1.0_f32..1.0), 0..5);
        let numbers = prop::collection::vec(any::<i32>(), 0..9);
        let on = prop::collection::vec(any::<bool>(), 0..9);
        let things = prop::collection::vec(things(), 0..9);
        (things, on, by_name, numbers).prop_map(|(things, on, by_name, numbers)| All {
            things,
            on,
            by_name,
            wrapped: Wrapped(numbers),
        })
    }

    proptest! {
        #[test]
        fn data_comes_back_equal(data in data()) {
            let bytes = to_bytes(&data).unwrap();
            prop_assert_eq!(from_bytes::<All>(&bytes).unwrap(), data);
        }

        /// Damage gives an error or other data, but no panic and no memory beyond what the bytes can hold.
        #[test]
        fn damage_is_survived(data in data(), at in any::<prop::sample::Index>(), change in 1..=255_u8, cut in any::<prop::sample::Index>()) {
            let mut bytes = to_bytes(&data).unwrap();
            prop_assert!(from_bytes::<All>(&bytes[..cut.index(bytes.len())]).is_err());
            let at = at.index(bytes.len());
            bytes[at] ^= change;
            let _read = from_bytes::<All>(&bytes);
        }
    }

    #[test]
    fn floats_keep_every_bit() {
        let odd = [
            f32::NAN,
            -0.0,
            f32::INFINITY,
            f32::MIN_POSITIVE / 2.0,
            -1.5e-40,
        ];
        let back: Vec<f32> = from_bytes(&to_bytes(&odd.to_vec()).unwrap()).unwrap();
        assert!(
            back.iter()
                .zip(odd)
                .all(|(a, b)| a.to_bits() == b.to_bits())
        );
    }

    /// Ten thousand objects whose positions are noise of one size: rows pack to 3.5 bytes a float, separate exponents to 3.1.
    #[test]
    fn columns_pack_better_than_rows() {
        let mut stream = crate::random::RandomKey::root(3).stream();
        let mut number = 0;
        let things: Vec<Thing> = (0..10_000)
            .map(|_| {
                number += 1;
                Thing {
                    place: std::array::from_fn(|_| stream.range(4.0, 5.0)),
                    number,
                    large: 7,
                    larger: 1 << 70,
                    kind: Kind::None,
                    deeper: None,
                    unit: (),
                    letter: 'x',
                }
            })
            .collect();
        let packed = |bytes: &[u8]| crate::packing::pack(bytes, &[]).len();
        let rows = packed(&postcard::to_stdvec(&things).unwrap());
        let columns = packed(&to_bytes(&things).unwrap());
        assert!(columns * 10 < rows * 9, "{columns} of {rows}");
    }

    #[test]
    fn what_is_left_over_is_told() {
        let bytes = to_bytes(&(1_u8, 2_u8)).unwrap();
        let refused = from_bytes::<u8>(&bytes).unwrap_err();
        assert_eq!(refused.to_string(), "1 bytes are left over");
    }
}
