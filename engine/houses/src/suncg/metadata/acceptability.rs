//! `houseAnnoMturk.csv`: whether people found a storey realistic.

use std::collections::BTreeMap;

use super::rows::CsvRows;
use crate::report::{FileLocation, LoadReport};

/// Votes on one storey.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AcceptabilityVotes {
    /// Votes for "realistic".
    pub positive: u32,
    /// Votes against.
    pub negative: u32,
}

impl AcceptabilityVotes {
    /// Returns whether all votes are positive.
    pub fn is_realistic(self) -> bool {
        self.positive > 0 && self.negative == 0
    }
}

/// All votes by house and storey.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VoteTable {
    rows: BTreeMap<(String, u32), AcceptabilityVotes>,
}

impl VoteTable {
    /// Reads the table.
    pub fn read(text: &[u8], file: &str, report: &mut LoadReport) -> Self {
        let at = FileLocation::file(file);
        let mut table = Self::default();
        let Some(rows) = CsvRows::new(
            text,
            &["sceneId", "level", "posvote", "negvote"],
            &at,
            "no storey has votes",
            report,
        ) else {
            return table;
        };
        rows.for_each(&at, report, |row| {
            let level = row.number(1).ok_or("level is no number")?;
            let positive = row.number(2).ok_or("posvote is no number")?;
            let negative = row.number(3).ok_or("negvote is no number")?;
            table.rows.insert(
                (row.cell(0).to_owned(), level),
                AcceptabilityVotes { positive, negative },
            );
            Ok(())
        });
        table
    }

    /// The votes on a storey.
    pub fn get(&self, house: &str, level: u32) -> Option<AcceptabilityVotes> {
        self.rows.get(&(house.to_owned(), level)).copied()
    }

    /// Returns the number of storeys with votes.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}
