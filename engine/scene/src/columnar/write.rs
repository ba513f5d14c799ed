//! Conversion of data to columns.

use super::{ColumnIndex, ColumnsError, layout, push_varint};
use serde::Serialize;
use serde::ser::{self, Serializer};

/// Returns data as columns.
///
/// # Errors
/// [`ColumnsError::Unsupported`] for sequences and maps of unknown length.
pub fn to_bytes<T: Serialize + ?Sized>(data: &T) -> Result<Vec<u8>, ColumnsError> {
    let mut writer = ColumnarWriter {
        names: ColumnIndex::new(),
        columns: vec![Column::default()],
        at: 0,
    };
    data.serialize(&mut writer)?;
    Ok(writer.bytes())
}

/// The column of one name.
#[derive(Default)]
struct Column {
    /// The bits of floats.
    floats: Vec<u32>,
    /// All other bytes.
    rest: Vec<u8>,
}

struct ColumnarWriter {
    names: ColumnIndex,
    columns: Vec<Column>,
    /// The current column.
    at: usize,
}

impl ColumnarWriter {
    /// Returns the number of columns; for each the number of its floats, their layout, the length of their bytes and of the
    /// rest; then the columns.
    fn bytes(self) -> Vec<u8> {
        let (mut head, mut body) = (Vec::new(), Vec::new());
        push_varint(&mut head, self.columns.len() as u64);
        for column in &self.columns {
            let start = body.len();
            let layout = layout::write_floats(&column.floats, &mut body);
            push_varint(&mut head, column.floats.len() as u64);
            head.push(layout.byte());
            push_varint(&mut head, (body.len() - start) as u64);
            push_varint(&mut head, column.rest.len() as u64);
            body.extend_from_slice(&column.rest);
        }
        head.extend(body);
        head
    }

    fn non_float_bytes(&mut self) -> &mut Vec<u8> {
        &mut self.columns[self.at].rest
    }

    #[expect(clippy::unnecessary_wraps, reason = "as serde's methods end")]
    fn whole(&mut self, number: u64) -> Result<(), ColumnsError> {
        push_varint(self.non_float_bytes(), number);
        Ok(())
    }

    fn signed(&mut self, number: i64) -> Result<(), ColumnsError> {
        // Zigzag encoding: small numbers of either sign become small ones.
        self.whole(((number << 1) ^ (number >> 63)) as u64)
    }

    fn length(&mut self, length: Option<usize>) -> Result<(), ColumnsError> {
        let length = length.ok_or(ColumnsError::Unsupported("data of unknown length"))?;
        self.whole(length as u64)
    }
}

/// Writes a struct with named fields.
struct StructWriter<'a> {
    writer: &'a mut ColumnarWriter,
    owner: &'static str,
    outside: usize,
}

impl StructWriter<'_> {
    fn field<T: Serialize + ?Sized>(
        &mut self,
        name: &'static str,
        value: &T,
    ) -> Result<(), ColumnsError> {
        let column = self.writer.names.column(self.owner, name);
        if column == self.writer.columns.len() {
            self.writer.columns.push(Column::default());
        }
        self.writer.at = column;
        let done = value.serialize(&mut *self.writer);
        self.writer.at = self.outside;
        done
    }
}

impl<'a> Serializer for &'a mut ColumnarWriter {
    type Ok = ();
    type Error = ColumnsError;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = StructWriter<'a>;
    type SerializeStructVariant = StructWriter<'a>;

    fn is_human_readable(&self) -> bool {
        false
    }

    fn serialize_bool(self, v: bool) -> Result<(), ColumnsError> {
        self.serialize_u8(u8::from(v))
    }

    fn serialize_i8(self, v: i8) -> Result<(), ColumnsError> {
        self.serialize_u8(v.cast_unsigned())
    }

    fn serialize_i16(self, v: i16) -> Result<(), ColumnsError> {
        self.signed(v.into())
    }

    fn serialize_i32(self, v: i32) -> Result<(), ColumnsError> {
        self.signed(v.into())
    }

    fn serialize_i64(self, v: i64) -> Result<(), ColumnsError> {
        self.signed(v)
    }

    fn serialize_u8(self, v: u8) -> Result<(), ColumnsError> {
        self.non_float_bytes().push(v);
        Ok(())
    }

    fn serialize_u16(self, v: u16) -> Result<(), ColumnsError> {
        self.whole(v.into())
    }

    fn serialize_u32(self, v: u32) -> Result<(), ColumnsError> {
        self.whole(v.into())
    }

    fn serialize_u64(self, v: u64) -> Result<(), ColumnsError> {
        self.whole(v)
    }

    /// The low half, then the high one.
    fn serialize_u128(self, v: u128) -> Result<(), ColumnsError> {
        self.whole(v as u64)?;
        self.whole((v >> 64) as u64)
    }

    fn serialize_f32(self, v: f32) -> Result<(), ColumnsError> {
        self.columns[self.at].floats.push(v.to_bits());
        Ok(())
    }

    fn serialize_f64(self, v: f64) -> Result<(), ColumnsError> {
        self.non_float_bytes().extend_from_slice(&v.to_le_bytes());
        Ok(())
    }

    fn serialize_char(self, v: char) -> Result<(), ColumnsError> {
        self.whole(u32::from(v).into())
    }

    fn serialize_str(self, v: &str) -> Result<(), ColumnsError> {
        self.serialize_bytes(v.as_bytes())
    }

    fn serialize_bytes(self, v: &[u8]) -> Result<(), ColumnsError> {
        self.whole(v.len() as u64)?;
        self.non_float_bytes().extend_from_slice(v);
        Ok(())
    }

    fn serialize_none(self) -> Result<(), ColumnsError> {
        self.serialize_u8(0)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), ColumnsError> {
        self.non_float_bytes().push(1);
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<(), ColumnsError> {
        Ok(())
    }

    fn serialize_unit_struct(self, _name: &'static str) -> Result<(), ColumnsError> {
        Ok(())
    }

    fn serialize_unit_variant(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
    ) -> Result<(), ColumnsError> {
        self.whole(index.into())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _name: &'static str,
        value: &T,
    ) -> Result<(), ColumnsError> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
        value: &T,
    ) -> Result<(), ColumnsError> {
        self.whole(index.into())?;
        value.serialize(self)
    }

    fn serialize_seq(self, length: Option<usize>) -> Result<Self, ColumnsError> {
        self.length(length)?;
        Ok(self)
    }

    fn serialize_tuple(self, _length: usize) -> Result<Self, ColumnsError> {
        Ok(self)
    }

    fn serialize_tuple_struct(
        self,
        _name: &'static str,
        _length: usize,
    ) -> Result<Self, ColumnsError> {
        Ok(self)
    }

    fn serialize_tuple_variant(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
        _length: usize,
    ) -> Result<Self, ColumnsError> {
        self.whole(index.into())?;
        Ok(self)
    }

    fn serialize_map(self, length: Option<usize>) -> Result<Self, ColumnsError> {
        self.length(length)?;
        Ok(self)
    }

    fn serialize_struct(
        self,
        name: &'static str,
        _length: usize,
    ) -> Result<StructWriter<'a>, ColumnsError> {
        Ok(StructWriter {
            owner: name,
            outside: self.at,
            writer: self,
        })
    }

    fn serialize_struct_variant(
        self,
        _name: &'static str,
        index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<StructWriter<'a>, ColumnsError> {
        self.whole(index.into())?;
        self.serialize_struct(variant, length)
    }
}

macro_rules! one_after_the_other {
    ($trait:ident, $method:ident) => {
        impl ser::$trait for &mut ColumnarWriter {
            type Ok = ();
            type Error = ColumnsError;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), ColumnsError> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), ColumnsError> {
                Ok(())
            }
        }
    };
}

one_after_the_other!(SerializeSeq, serialize_element);
one_after_the_other!(SerializeTuple, serialize_element);
one_after_the_other!(SerializeTupleStruct, serialize_field);
one_after_the_other!(SerializeTupleVariant, serialize_field);

impl ser::SerializeMap for &mut ColumnarWriter {
    type Ok = ();
    type Error = ColumnsError;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), ColumnsError> {
        key.serialize(&mut **self)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), ColumnsError> {
        value.serialize(&mut **self)
    }

    fn end(self) -> Result<(), ColumnsError> {
        Ok(())
    }
}

macro_rules! by_field {
    ($trait:ident) => {
        impl ser::$trait for StructWriter<'_> {
            type Ok = ();
            type Error = ColumnsError;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), ColumnsError> {
                self.field(name, value)
            }

            fn end(self) -> Result<(), ColumnsError> {
                Ok(())
            }
        }
    };
}

by_field!(SerializeStruct);
by_field!(SerializeStructVariant);
