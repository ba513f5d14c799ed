//! HDF5 reader: the subset of the format that files of measured heads (SOFA, which is netCDF-4) use.
//!
//! Files are untrusted. Only the file's own bytes are read: links, values in other files and virtual datasets are refused.
//! Stated sizes are checked against the file before memory is allocated; trees that loop end at a budget.
//!
//! Supported: superblocks 0 to 3; the variables of the root group, by any kind of index; integers and IEEE floats of either
//! byte order; values in the header, contiguous and in chunks, behind deflate, shuffle and Fletcher-32; attributes of one
//! text each. Names follow the HDF5 File Format Specification 3.0.

mod arrays;
mod attribute;
mod btree1;
mod btree2;
mod bytes;
mod datatype;
mod filters;
mod fractal_heap;
mod global_heap;
mod grid;
mod header;
mod index;
mod layout;
mod links;
mod shape;
mod superblock;

use crate::error::AcousticsError;
use bytes::{FileBytes, Hdf5Error, Hdf5Result, unsupported};
use datatype::Datatype;
use filters::FilterPipeline;
use header::{ObjectHeader, kind};
use layout::StorageLayout;
use shape::Dataspace;
use superblock::Superblock;

/// Most bytes of a file.
pub const MAX_FILE_BYTES: u64 = 1 << 30;
/// Most numbers of a variable.
pub const MAX_ARRAY_VALUES: u64 = 1 << 26;

/// The bytes of a file, and the address of its root.
#[derive(Debug)]
pub struct Hdf5 {
    bytes: Vec<u8>,
    superblock: Superblock,
}

/// The numbers of a variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Hdf5Array {
    /// The lengths of its axes.
    pub shape: Vec<usize>,
    /// Its values, the last axis first.
    pub values: Vec<f64>,
}

impl Hdf5 {
    /// Opens a file by its bytes.
    ///
    /// # Errors
    /// [`AcousticsError::Hdf5`] when they are no HDF5 file.
    pub fn open(bytes: Vec<u8>) -> Result<Self, AcousticsError> {
        let superblock =
            superblock::read(&bytes).map_err(|Hdf5Error(why)| AcousticsError::Hdf5(why))?;
        Ok(Self { bytes, superblock })
    }

    /// Returns the lengths of the axes of a variable; `None` where there is no variable of that name.
    ///
    /// # Errors
    /// [`AcousticsError::Hdf5`] when the file is damaged, or the name leads elsewhere.
    pub fn shape(&self, name: &str) -> Result<Option<Vec<u64>>, AcousticsError> {
        self.query(name, |source| {
            let Some(header) = self.variable(source, name)? else {
                return Ok(None);
            };
            let Some(space) = header.first(kind::DATASPACE) else {
                return Ok(None);
            };
            let shape = Dataspace::read(space.content()?)?;
            Ok(shape.map(|shape| shape.lengths))
        })
    }

    /// Returns the text of an attribute of a variable, or of the file; `None` where there is none of that name.
    ///
    /// # Errors
    /// [`AcousticsError::Hdf5`] when the file is damaged, the name leads elsewhere, or the attribute is no text.
    pub fn attribute_text(
        &self,
        of: Option<&str>,
        name: &str,
    ) -> Result<Option<String>, AcousticsError> {
        self.query(of.unwrap_or("the file"), |source| {
            let header = match of {
                Some(variable) => self.variable(source, variable)?,
                None => Some(self.root(source)?),
            };
            header.map_or(Ok(None), |header| attribute::text(source, &header, name))
        })
    }

    /// Returns the numbers of a variable.
    ///
    /// # Errors
    /// [`AcousticsError::Hdf5`] when there is no such variable, it is damaged or not numeric, its values are in another
    /// file, or it has more than [`MAX_ARRAY_VALUES`].
    pub fn numbers(&self, name: &str) -> Result<Hdf5Array, AcousticsError> {
        self.query(name, |source| match self.variable(source, name)? {
            Some(header) => numbers(source, &header),
            None => unsupported("missing"),
        })
    }

    /// Runs a query of the file; errors name the place `at`.
    fn query<T>(
        &self,
        at: &str,
        work: impl FnOnce(&FileBytes<'_>) -> Hdf5Result<T>,
    ) -> Result<T, AcousticsError> {
        let source = FileBytes::new(
            &self.bytes[self.superblock.base_offset..],
            self.superblock.widths,
        );
        work(&source).map_err(|Hdf5Error(why)| AcousticsError::Hdf5(format!("{at}: {why}")))
    }

    fn root<'s>(&self, source: &'s FileBytes<'_>) -> Hdf5Result<ObjectHeader<'s>> {
        ObjectHeader::read(source, self.superblock.root)
    }

    fn variable<'s>(
        &self,
        source: &'s FileBytes<'_>,
        name: &str,
    ) -> Hdf5Result<Option<ObjectHeader<'s>>> {
        let found = links::find(source, &self.root(source)?, name)?;
        found
            .map(|address| ObjectHeader::read(source, address))
            .transpose()
    }
}

fn numbers(source: &FileBytes<'_>, header: &ObjectHeader<'_>) -> Hdf5Result<Hdf5Array> {
    let content = |kind, what: &str| match header.first(kind) {
        Some(message) => message.content(),
        None => unsupported(format!("{what} is missing; it is no variable")),
    };
    if header.first(kind::EXTERNAL_FILES).is_some() {
        return unsupported("its values stand in another file; only the file itself is read");
    }
    let Some(shape) = Dataspace::read(content(kind::DATASPACE, "its dataspace")?)? else {
        return unsupported("has no values");
    };
    let count = shape.count().filter(|count| *count <= MAX_ARRAY_VALUES);
    let Some(count) = count else {
        return unsupported(format!(
            "shape {:?} has more than the {MAX_ARRAY_VALUES} numbers that are read",
            shape.lengths
        ));
    };
    let datatype = Datatype::read(content(kind::DATATYPE, "its datatype")?)?;
    let Some(size) = datatype.number_size() else {
        return unsupported("is text; expected numbers");
    };
    let layout = StorageLayout::read(content(kind::LAYOUT, "its layout")?)?;
    let filters = match header.first(kind::FILTERS) {
        Some(message) => FilterPipeline::read(message.content()?)?,
        None => FilterPipeline::default(),
    };
    let needed = count * size as u64;
    let plain = |bytes: &[u8], stated: u64| {
        if stated != needed || !filters.is_empty() {
            return unsupported(format!(
                "damaged: {stated} bytes of values; its shape {:?} takes {needed}",
                shape.lengths
            ));
        }
        Ok(bytes
            .chunks_exact(size)
            .map(|bytes| datatype.number(bytes))
            .collect())
    };
    let values = match layout {
        _ if count == 0 => Vec::new(),
        StorageLayout::Compact(mut bytes) => {
            let stated = bytes.remaining();
            plain(bytes.take(stated)?, stated as u64)?
        }
        StorageLayout::Contiguous(Some(address), stated) => {
            plain(source.unbudgeted_bytes(address, stated)?, stated)?
        }
        StorageLayout::Contiguous(None, _) => return unsupported("its values were never written"),
        StorageLayout::Chunked(chunked) => {
            grid::numbers(source, &shape, &chunked, &filters, datatype, size)?
        }
    };
    let shape = shape
        .lengths
        .iter()
        .map(|length| *length as usize)
        .collect();
    Ok(Hdf5Array { shape, values })
}
