//! What an episode of a question has come to.

use crate::error::WorldError;
use serde::{Deserialize, Serialize};

/// What is kept of the episode beside the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct QuestionProgress {
    /// The walkable way from the start, m.
    pub(super) start_m: Option<f64>,
    /// The way now, and the shortest one so far, m.
    now_m: Option<f64>,
    least_m: Option<f64>,
    /// Whether the agent is in the room in which the answer is seen, and has been there.
    is_there: bool,
    was_there: bool,
    /// Whether the answer was right, once it was given.
    pub(super) answered: Option<bool>,
}

impl QuestionProgress {
    pub(super) fn begin(start_m: Option<f64>, is_there: bool) -> Self {
        Self {
            start_m,
            now_m: start_m,
            least_m: start_m,
            is_there,
            was_there: is_there,
            answered: None,
        }
    }

    /// Takes in a step, after which the way is `now_m`.
    pub(super) fn advance(&mut self, now_m: Option<f64>, is_there: bool) {
        self.now_m = now_m;
        self.least_m = match (self.least_m, now_m) {
            (Some(least), Some(now)) => Some(least.min(now)),
            (least, now) => least.or(now),
        };
        self.is_there = is_there;
        self.was_there |= is_there;
    }

    /// In the order of the task's `measures`; NaN for what is not known.
    pub(super) fn measures(&self) -> [f64; 5] {
        let share = |is: bool| f64::from(u8::from(is));
        let decrease = self.start_m.zip(self.now_m).map(|(start, now)| start - now);
        [
            self.answered.map_or(f64::NAN, share),
            decrease.unwrap_or(f64::NAN),
            self.least_m.unwrap_or(f64::NAN),
            share(self.is_there),
            share(self.was_there),
        ]
    }

    pub(super) fn to_bytes(self) -> Vec<u8> {
        postcard::to_stdvec(&self).expect("plain data can always be written to memory")
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, WorldError> {
        let told = |why: &str| WorldError::Snapshot(format!("the progress of its question: {why}"));
        let read = postcard::take_from_bytes::<Self>(bytes);
        match read.map_err(|error| told(&error.to_string()))? {
            (progress, []) => {
                let ways = [progress.start_m, progress.now_m, progress.least_m];
                let fits = |way: &f64| (0.0..=1e9).contains(way);
                if ways.iter().flatten().all(fits) {
                    Ok(progress)
                } else {
                    Err(told("a distance is no number from 0 on"))
                }
            }
            (_, rest) => Err(told(&format!("{} bytes are left over", rest.len()))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_comes_back_from_bytes_and_nothing_else_is_taken() {
        let mut progress = QuestionProgress::begin(Some(4.0), false);
        progress.advance(Some(2.5), true);
        progress.advance(Some(3.0), false);
        progress.answered = Some(true);
        assert_eq!(progress.measures(), [1.0, 1.0, 2.5, 0.0, 1.0]);
        let bytes = progress.to_bytes();
        assert_eq!(QuestionProgress::from_bytes(&bytes).unwrap(), progress);
        for cut in 0..bytes.len() {
            assert!(QuestionProgress::from_bytes(&bytes[..cut]).is_err());
        }
        let mut long = bytes.clone();
        long.push(0);
        assert!(QuestionProgress::from_bytes(&long).is_err());
        let wrong = QuestionProgress::begin(Some(f64::NAN), false).to_bytes();
        assert!(QuestionProgress::from_bytes(&wrong).is_err());
    }
}
