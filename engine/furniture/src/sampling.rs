//! Draws of one model: its sizes out of `assets/furniture_sizes.csv`, and its variants.

use dwell_scene::random::{RandomKey, RandomStream};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The distribution of one dimension of one model.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct SizeDistribution {
    /// A model of the catalogue.
    pub model: String,
    /// `width`, `height` and `depth` are those of the whole thing, closed; any other word is the model's own.
    pub dimension: String,
    /// Half of all are smaller, m.
    pub median_m: f32,
    /// None is smaller, m.
    pub low_m: f32,
    /// None is larger, m.
    pub high_m: f32,
    /// The source of the numbers; `docs/furniture.md` lists the works.
    #[cfg(test)]
    source: String,
}

type SizeTable = BTreeMap<String, BTreeMap<String, SizeDistribution>>;

/// All spreads, by model and dimension.
pub(crate) fn size_table() -> &'static SizeTable {
    static TABLE: OnceLock<SizeTable> = OnceLock::new();
    TABLE.get_or_init(|| {
        let text = include_str!("../../../assets/furniture_sizes.csv");
        let mut table = SizeTable::new();
        for row in csv::Reader::from_reader(text.as_bytes()).deserialize::<SizeDistribution>() {
            let row = row.expect("the tables of assets/ are checked by this file's tests");
            table
                .entry(row.model.clone())
                .or_default()
                .insert(row.dimension.clone(), row);
        }
        table
    })
}

/// The draws of one instance of a model. Each draw has a stream of its own, so that one more shifts no other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SizeSampler {
    model: &'static str,
    key: RandomKey,
}

impl SizeSampler {
    /// The draws of `model` under `key`.
    pub(crate) fn new(model: &'static str, key: RandomKey) -> Self {
        Self {
            model,
            key: key.child(model),
        }
    }

    /// One dimension, m: its median in the middle, denser there, never beyond the least and the largest known; whole
    /// multiples of 5 mm, of things below 0.2 m of 1 mm.
    pub(crate) fn sample_m(&self, dimension: &'static str) -> f32 {
        let spread = size_table()
            .get(self.model)
            .and_then(|rows| rows.get(dimension))
            .expect("a test builds every model, so that all rows it asks for are there");
        let mut random = self.key.child(dimension).stream();
        let side = random.uniform_f32() + random.uniform_f32() - 1.0;
        let reach = if side < 0.0 {
            spread.median_m - spread.low_m
        } else {
            spread.high_m - spread.median_m
        };
        let step = if spread.median_m < 0.2 { 0.001 } else { 0.005 };
        let drawn = ((spread.median_m + side * reach) / step).round() * step;
        drawn.clamp(spread.low_m, spread.high_m)
    }

    /// A stream for something of the model's own.
    pub(crate) fn stream(&self, purpose: &'static str) -> RandomStream {
        self.key.child(purpose).stream()
    }

    /// Uniform in [`low`, `high`).
    pub(crate) fn range(&self, purpose: &'static str, low: f32, high: f32) -> f32 {
        self.key.child(purpose).stream().range(low, high)
    }

    /// Uniform in 0..`count`.
    pub(crate) fn below(&self, purpose: &'static str, count: usize) -> usize {
        self.key.child(purpose).stream().below(count)
    }

    /// One of `items`.
    pub(crate) fn choose<T: Copy, const N: usize>(
        &self,
        purpose: &'static str,
        items: [T; N],
    ) -> T {
        const { assert!(N > 0, "a choice needs something to choose from") };
        items[self.below(purpose, N)]
    }

    /// Returns whether something with this chance (0 to 1) is so.
    pub(crate) fn chance(&self, purpose: &'static str, chance: f32) -> bool {
        self.key.child(purpose).stream().uniform_f32() < chance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_an_ordered_spread_with_a_source() {
        for (model, rows) in size_table() {
            for (dimension, row) in rows {
                let at = format!("{model} {dimension}");
                assert!(0.0 < row.low_m, "{at}");
                assert!(
                    row.low_m <= row.median_m && row.median_m <= row.high_m,
                    "{at}"
                );
                assert!(row.high_m < 4.0, "{at}");
                assert!(!row.source.trim().is_empty(), "{at}");
            }
        }
    }

    /// Over 2,000 keys the share below the median is a half within four standard errors (0.045), and ends are kept.
    #[test]
    fn draws_keep_their_median_and_their_ends() {
        let spread = &size_table()["sofa"]["depth"];
        let drawn: Vec<f32> = (0..2000)
            .map(|k| SizeSampler::new("sofa", RandomKey::root(k)).sample_m("depth"))
            .collect();
        let share = |test: &dyn Fn(f32) -> bool| {
            drawn.iter().filter(|d| test(**d)).count() as f32 / drawn.len() as f32
        };
        assert!(share(&|d| d < spread.median_m - 1e-4) < 0.545);
        assert!(share(&|d| d > spread.median_m + 1e-4) < 0.545);
        assert!(
            drawn
                .iter()
                .all(|d| (spread.low_m..=spread.high_m).contains(d))
        );
        let widest = drawn.iter().fold(f32::MIN, |a, b| a.max(*b));
        let least = drawn.iter().fold(f32::MAX, |a, b| a.min(*b));
        assert!(widest - least > 0.8 * (spread.high_m - spread.low_m));
    }
}
