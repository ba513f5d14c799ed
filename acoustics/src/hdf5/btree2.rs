//! B-trees of version 2: names of links and attributes, and addresses of chunks.

use super::bytes::{Cursor, FileBytes, Hdf5Result, unsupported};

/// The layout of a tree's nodes.
struct BTreeLayout {
    kind: u8,
    node_size: u64,
    record_size: usize,
    /// Bytes of the number of records in a child.
    count_width: usize,
    /// Bytes of the number of all records below a child, by its level.
    total_widths: Vec<usize>,
}

/// Deepest tree: one of nodes with two children holds more records than a file has bytes.
const MOST_LEVELS: u16 = 40;

/// Calls `each` with every record of a tree.
pub(super) fn for_each_record(
    source: &FileBytes<'_>,
    address: u64,
    each: &mut impl FnMut(Cursor<'_>) -> Hdf5Result<()>,
) -> Hdf5Result<()> {
    let mut header = source.at(address)?;
    header.check_signature(b"BTHD", 0)?;
    let kind = header.u8()?;
    let node_size = u64::from(header.u32()?);
    let record_size = usize::from(header.u16()?);
    let depth = header.u16()?;
    header.skip(2)?;
    let root = header.address()?;
    let count = u64::from(header.u16()?);
    let Some(root) = root else {
        return Ok(());
    };
    let Some(tree) = BTreeLayout::new(kind, node_size, record_size, depth, header.widths.address)
    else {
        return unsupported(format!(
            "damaged at byte {address}: a tree of {depth} levels with nodes of {node_size} bytes"
        ));
    };
    // Levels fall from node to child, so that loops end.
    let mut open = vec![(root, count, depth)];
    while let Some((address, count, level)) = open.pop() {
        let mut node = source.block(address, tree.node_size)?;
        node.check_signature(if level == 0 { b"BTLF" } else { b"BTIN" }, 0)?;
        if node.u8()? != tree.kind {
            return unsupported(format!("damaged at byte {address}: a node of another tree"));
        }
        for _ in 0..count {
            each(node.sub_cursor(tree.record_size)?)?;
        }
        let Some(below) = level.checked_sub(1) else {
            continue;
        };
        for _ in 0..=count {
            let child = node.defined_address()?;
            let records = node.uint(tree.count_width)?;
            node.skip(tree.total_widths[usize::from(below)])?;
            open.push((child, records, below));
        }
    }
    Ok(())
}

impl BTreeLayout {
    /// Computes the widths from the number of records that fit into a node of each level; `None` where none fits.
    fn new(
        kind: u8,
        node_size: u64,
        record_size: usize,
        depth: u16,
        address: usize,
    ) -> Option<Self> {
        // Signature, version, kind; at the end a checksum.
        const FRAME: u64 = 10;
        let room = node_size.checked_sub(FRAME)?;
        if record_size == 0 || depth > MOST_LEVELS {
            return None;
        }
        let record = record_size as u64;
        let most = room / record;
        let mut tree = Self {
            kind,
            node_size,
            record_size,
            count_width: bytes_to_store(most),
            total_widths: vec![0],
        };
        let mut total = most;
        for level in 1..depth {
            let below = tree.total_widths[usize::from(level) - 1];
            let pointer = (address + tree.count_width + below) as u64;
            let most = room.checked_sub(pointer)? / (record + pointer);
            total = (most + 1).saturating_mul(total).saturating_add(most);
            tree.total_widths.push(bytes_to_store(total));
        }
        (most > 0).then_some(tree)
    }
}

/// Returns the bytes of a number up to this one.
fn bytes_to_store(most: u64) -> usize {
    most.checked_ilog2().unwrap_or(0) as usize / 8 + 1
}
