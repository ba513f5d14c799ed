//! The chunks of a variable as a grid, and its values from them.

use super::bytes::{FileBytes, Hdf5Error, Hdf5Result, unsupported};
use super::datatype::Datatype;
use super::filters::FilterPipeline;
use super::index;
use super::layout::ChunkedStorage;
use super::shape::{Dataspace, product};
use dwell_scene::interrupt;

/// Most values of all chunks together, those beyond the variable's edges counted.
const MOST_PADDED: u64 = 2 * super::MAX_ARRAY_VALUES;

/// A chunk in the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct StoredChunk {
    /// Its number in the grid, the last axis first.
    pub(super) number: u64,
    pub(super) address: u64,
    /// Bytes as stored; `None` where nothing was compressed.
    pub(super) size: Option<u64>,
    /// Filters that were not applied, a bit each.
    pub(super) skipped_filters: u32,
}

/// The grid of chunks of a variable.
#[derive(Debug)]
pub(super) struct ChunkGrid {
    /// Values of a chunk along each axis.
    chunk: Vec<u64>,
    /// Chunks along each axis.
    counts: Vec<u64>,
    /// Chunks along each axis at its maximum size; `None` if unlimited.
    longest: Vec<Option<u64>>,
    /// Number of all chunks.
    pub(super) count: u64,
    /// Bytes of a chunk.
    pub(super) bytes: u64,
}

impl ChunkGrid {
    pub(super) fn new(shape: &Dataspace, chunk: &[u64], value_size: usize) -> Hdf5Result<Self> {
        let axes = shape.lengths.len();
        if chunk.len() != axes || axes == 0 || chunk.contains(&0) {
            return unsupported(format!(
                "damaged: chunks of {} axes for a variable of {axes}",
                chunk.len()
            ));
        }
        let over = |lengths: &[u64]| -> Vec<u64> {
            let pairs = lengths.iter().zip(chunk);
            pairs
                .map(|(length, chunk)| length.div_ceil(*chunk))
                .collect()
        };
        let counts = over(&shape.lengths);
        let longest = shape.max_lengths.iter().zip(chunk);
        let sizes = product(&counts).zip(product(chunk));
        let padded = sizes.and_then(|(count, values)| count.checked_mul(values));
        let (Some((count, values)), Some(..=MOST_PADDED)) = (sizes, padded) else {
            return unsupported(format!(
                "chunks of shape {chunk:?} hold more than {MOST_PADDED} numbers with what is beyond the edges"
            ));
        };
        Ok(Self {
            chunk: chunk.to_vec(),
            counts,
            longest: longest
                .map(|(most, chunk)| Some((*most)?.div_ceil(*chunk)))
                .collect(),
            count,
            bytes: values.saturating_mul(value_size as u64),
        })
    }

    pub(super) fn axes(&self) -> usize {
        self.chunk.len()
    }

    /// Returns the number of the chunk at these coordinates, in chunks; `None` outside.
    pub(super) fn chunk_index(&self, at: &[u64]) -> Option<u64> {
        let mut axes = at.iter().zip(&self.counts);
        axes.try_fold(0, |number, (at, count)| {
            Some(number * count + Some(*at).filter(|at| at < count)?)
        })
    }

    /// Returns the number of the chunk that begins with the value at `start`; `None` outside.
    pub(super) fn chunk_starting_at(&self, start: &[u64]) -> Option<u64> {
        let axes = start.iter().zip(&self.chunk);
        let at = axes.map(|(start, chunk)| (start % chunk == 0).then_some(start / chunk));
        self.chunk_index(&at.collect::<Option<Vec<_>>>()?)
    }

    /// Returns the number of the chunk at a place of an array of all chunks that the variable may ever have; `None`
    /// outside. An unlimited axis comes first there.
    pub(super) fn chunk_index_in_array(&self, place: u64) -> Option<u64> {
        let endless = self.longest.iter().position(Option::is_none);
        let others = (0..self.axes()).filter(|axis| Some(*axis) != endless);
        let order: Vec<usize> = endless.into_iter().chain(others).collect();
        let mut at = vec![0; self.axes()];
        let mut rest = place;
        for axis in order.into_iter().rev() {
            match self.longest[axis] {
                Some(0) => return None,
                Some(count) => (rest, at[axis]) = (rest / count, rest % count),
                None => (rest, at[axis]) = (0, rest),
            }
        }
        if rest > 0 {
            None
        } else {
            self.chunk_index(&at)
        }
    }

    /// Returns the first value of a chunk along each axis.
    fn start(&self, number: u64) -> Vec<u64> {
        let mut rest = number;
        let mut start = vec![0; self.axes()];
        for axis in (0..self.axes()).rev() {
            start[axis] = rest % self.counts[axis] * self.chunk[axis];
            rest /= self.counts[axis];
        }
        start
    }

    /// Copies the values of a chunk to their places.
    fn scatter_chunk(
        &self,
        number: u64,
        bytes: &[u8],
        of: Datatype,
        size: usize,
        shape: &Dataspace,
        values: &mut [f64],
    ) {
        let start = self.start(number);
        let last = self.axes() - 1;
        let row = self.chunk[last] as usize;
        let within = (shape.lengths[last] - start[last]).min(self.chunk[last]) as usize;
        'rows: for (k, bytes) in bytes.chunks_exact(row * size).enumerate() {
            let (mut rest, mut to, mut stride) = (k as u64, start[last], shape.lengths[last]);
            for axis in (0..last).rev() {
                let at = start[axis] + rest % self.chunk[axis];
                rest /= self.chunk[axis];
                if at >= shape.lengths[axis] {
                    continue 'rows;
                }
                to += at * stride;
                stride *= shape.lengths[axis];
            }
            let to = to as usize;
            for (value, bytes) in values[to..to + within]
                .iter_mut()
                .zip(bytes.chunks_exact(size))
            {
                *value = of.number(bytes);
            }
        }
    }
}

/// Returns the numbers of a chunked variable.
pub(super) fn numbers(
    source: &FileBytes<'_>,
    shape: &Dataspace,
    chunked: &ChunkedStorage,
    filters: &FilterPipeline,
    of: Datatype,
    size: usize,
) -> Hdf5Result<Vec<f64>> {
    let grid = ChunkGrid::new(shape, &chunked.shape, size)?;
    let mut chunks = index::chunks(source, chunked, &grid)?;
    chunks.sort_by_key(|chunk| chunk.number);
    chunks.dedup_by_key(|chunk| chunk.number);
    if chunks.len() as u64 != grid.count {
        return unsupported(format!(
            "{} of {} chunks were never written, or are lost",
            grid.count.saturating_sub(chunks.len() as u64),
            grid.count
        ));
    }
    let whole = usize::try_from(grid.bytes).or_else(|_| unsupported("chunks too large"))?;
    // Uncompressed chunks must be within the file before memory is allocated.
    for chunk in &chunks {
        source.unbudgeted_bytes(chunk.address, chunk.size.unwrap_or(grid.bytes))?;
    }
    let count = shape.count().unwrap_or(0) as usize;
    let mut values = vec![0.0; count];
    for chunk in &chunks {
        interrupt::unwind_if_cancelled();
        let stored = source.unbudgeted_bytes(chunk.address, chunk.size.unwrap_or(grid.bytes))?;
        let undone = filters.decode(stored, chunk.skipped_filters, whole);
        let bytes =
            undone.map_err(|Hdf5Error(why)| Hdf5Error(format!("chunk {}: {why}", chunk.number)))?;
        grid.scatter_chunk(chunk.number, &bytes, of, size, shape, &mut values);
    }
    Ok(values)
}
