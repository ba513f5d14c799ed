//! Addresses of parameters: `object/12/mass_kg`, `material/carpet/absorption/1000`, `pair/oak~steel/friction`.

use crate::error::SceneError;
use crate::ids::{JointId, PartId};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Most words of an address, and of a law's: a law's target may have slashes in its name.
const MOST_WORDS: usize = 5;
const MOST_WORDS_OF_A_LAW: usize = 32;

/// The address of a parameter: two to five words or numbers with slashes between them; up to 32 for a law's.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Address(pub(super) String);

impl Address {
    /// The words, at least two.
    pub fn words(&self) -> Vec<&str> {
        self.0.split('/').collect()
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The address of a joint's field.
    pub(super) fn of_joint(joint: JointId, field: &str) -> Self {
        Self(format!("joint/{}/{field}", joint.0))
    }

    /// Refuses a value out of bounds.
    pub(super) fn check_range(
        &self,
        value: f64,
        low: f64,
        high: f64,
        unit: &str,
    ) -> Result<(), SceneError> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let [low, high] = [low, high].map(plain);
        // "1" is the unit of what has none.
        let unit = if unit == "1" {
            String::new()
        } else {
            format!(" {unit}")
        };
        Err(self.invalid(format!(
            "{value} is out of range; allowed are {low} to {high}{unit}"
        )))
    }

    /// The address of a part's field.
    pub(super) fn of_part(part: PartId, field: &str) -> Self {
        Self(format!("part/{}/{field}", part.0))
    }

    pub(super) fn invalid(&self, what: impl Into<String>) -> SceneError {
        SceneError::Address {
            address: self.0.clone(),
            what: what.into(),
        }
    }
}

/// Formats a number with as few digits as possible: many bounds come from f32s.
fn plain(number: f64) -> String {
    let short = number as f32;
    if f64::from(short) == number {
        short.to_string()
    } else {
        number.to_string()
    }
}

impl FromStr for Address {
    type Err = SceneError;
    fn from_str(text: &str) -> Result<Self, SceneError> {
        let fault = |what: &str| {
            Err(SceneError::Address {
                address: text.to_owned(),
                what: what.to_owned(),
            })
        };
        let words: Vec<&str> = text.split('/').collect();
        let most = if words[0] == "law" {
            MOST_WORDS_OF_A_LAW
        } else {
            MOST_WORDS
        };
        if !(2..=most).contains(&words.len()) {
            return fault(
                "an address has two to five words with slashes between them, as in object/12/mass_kg; that of a law up to 32",
            );
        }
        if words
            .iter()
            .any(|word| word.is_empty() || word.len() > 128 || word.chars().any(char::is_control))
        {
            return fault("each word has 1 to 128 printable characters");
        }
        Ok(Self(text.to_owned()))
    }
}

impl TryFrom<String> for Address {
    type Error = SceneError;
    fn try_from(text: String) -> Result<Self, SceneError> {
        text.parse()
    }
}

impl From<Address> for String {
    fn from(address: Address) -> Self {
        address.0
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
