//! The house that is most like another one.

use crate::facts::Facts;

/// Houses with the same rooms and doors that share this much of their furniture are near copies.
pub(crate) const COPY_OVERLAP: f64 = 0.9;

/// The house most like one, by its rooms first and its furniture second.
#[derive(Clone, Debug)]
pub(crate) struct Nearest {
    pub(crate) seed: u64,
    pub(crate) other: u64,
    /// Edits of rooms and of doors that are needed at least to make one plan of the other.
    pub(crate) graph: usize,
    /// Things that both have over things that either has, by kind of room and category: 0 to 1.
    pub(crate) overlap: f64,
}

impl Nearest {
    pub(crate) fn of(all: &[Facts], own: usize) -> Self {
        let house = &all[own];
        let mut best = Self {
            seed: house.seed,
            other: house.seed,
            graph: usize::MAX,
            overlap: 0.0,
        };
        for (k, other) in all.iter().enumerate() {
            if k == own {
                continue;
            }
            let graph = edits(house, other);
            if graph > best.graph {
                continue;
            }
            let shared = common(&house.things, &other.things);
            let either = house.things.len() + other.things.len() - shared;
            let overlap = shared as f64 / either.max(1) as f64;
            if graph < best.graph || overlap > best.overlap {
                best.other = other.seed;
                best.graph = graph;
                best.overlap = overlap;
            }
        }
        best
    }

    pub(crate) fn is_copy(&self) -> bool {
        self.graph == 0 && self.overlap >= COPY_OVERLAP
    }
}

/// A lower bound of the edit distance of two room graphs: rooms and doors that have no partner of the same label.
///
/// # Source
/// The label bound of K. Riesen, H. Bunke, Image and Vision Computing 27, 950 (2009).
fn edits(a: &Facts, b: &Facts) -> usize {
    let kinds = |facts: &Facts| {
        let mut kinds: Vec<String> = facts.rooms.iter().map(|room| room.kind.clone()).collect();
        kinds.sort_unstable();
        kinds
    };
    let apart = |p: &[String], q: &[String]| p.len().max(q.len()) - common(p, q);
    apart(&kinds(a), &kinds(b)) + apart(&a.links, &b.links)
}

/// Returns how many elements two sorted lists share.
fn common<T: Ord>(a: &[T], b: &[T]) -> usize {
    let (mut i, mut j, mut shared) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => {
                shared += 1;
                i += 1;
                j += 1;
            }
        }
    }
    shared
}
