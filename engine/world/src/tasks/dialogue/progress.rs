//! What an episode of a dialogue has come to.

use crate::error::WorldError;
use dwell_semantics::dialogue::Reply;
use serde::{Deserialize, Serialize};

/// The longest reply that a snapshot holds, bytes.
const MOST_BYTES: usize = 4096;

/// What is kept of the episode beside the world.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct DialogueProgress {
    /// Whether each thing has had the replies of the one that is meant so far. Shape (thing,).
    left: Vec<bool>,
    /// Questions that were answered, and those of them that were not understood.
    asked: u32,
    not_understood: u32,
    /// Whether it stopped at a thing that the instruction fits, once it stopped.
    stopped_at: Option<bool>,
}

/// The progress and the latest reply, as snapshots hold them.
#[derive(Serialize, Deserialize)]
struct Saved {
    progress: DialogueProgress,
    reply: Option<(String, bool)>,
}

impl DialogueProgress {
    /// Of an instruction that fits so many things.
    pub(super) fn begin(things: usize) -> Self {
        Self {
            left: vec![true; things],
            asked: 0,
            not_understood: 0,
            stopped_at: None,
        }
    }

    /// The places of the things that are left, ascending.
    pub(super) fn remaining(&self) -> Vec<usize> {
        let places = self.left.iter().enumerate();
        places
            .filter_map(|(place, left)| left.then_some(place))
            .collect()
    }

    pub(super) fn asked(&self) -> u32 {
        self.asked
    }

    /// Rules out the things of which `fits` is false.
    pub(super) fn retain(&mut self, fits: impl Fn(usize) -> bool) {
        for (place, left) in self.left.iter_mut().enumerate() {
            *left = *left && fits(place);
        }
    }

    pub(super) fn count_question(&mut self, understood: bool) {
        self.asked += 1;
        self.not_understood += u32::from(!understood);
    }

    /// Takes in at which thing the agent stopped.
    pub(super) fn record_stop(&mut self, place: Option<usize>) {
        self.stopped_at = Some(place.is_some());
    }

    /// In the order of the task's `measures`; NaN for what is not known.
    pub(super) fn measures(&self) -> [f64; 4] {
        let stopped = self.stopped_at.map(|is| f64::from(u8::from(is)));
        [
            f64::from(self.asked),
            f64::from(self.not_understood),
            self.left.len() as f64,
            stopped.unwrap_or(f64::NAN),
        ]
    }

    pub(super) fn to_bytes(&self, reply: Option<&Reply>) -> Vec<u8> {
        let saved = Saved {
            progress: self.clone(),
            reply: reply.map(|reply| (reply.text.clone(), reply.understood)),
        };
        postcard::to_stdvec(&saved).expect("plain data can always be written to memory")
    }

    /// Of an instruction that fits so many things, with at most so many questions.
    pub(super) fn from_bytes(
        bytes: &[u8],
        things: usize,
        max_questions: u32,
    ) -> Result<(Self, Option<Reply>), WorldError> {
        let told = |why: &str| WorldError::Snapshot(format!("the progress of its dialogue: {why}"));
        let read = postcard::take_from_bytes::<Saved>(bytes);
        let (Saved { progress, reply }, rest) = read.map_err(|error| told(&error.to_string()))?;
        if !rest.is_empty() {
            return Err(told(&format!("{} bytes are left over", rest.len())));
        }
        let Self {
            left,
            asked,
            not_understood,
            ..
        } = &progress;
        if left.len() != things || *asked > max_questions || not_understood > asked {
            return Err(told("it is of another episode"));
        }
        if reply
            .as_ref()
            .is_some_and(|(text, _)| text.len() > MOST_BYTES)
        {
            return Err(told("its reply is too long"));
        }
        let reply = reply.map(|(text, understood)| Reply { text, understood });
        Ok((progress, reply))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_comes_back_from_bytes_and_nothing_else_is_taken() {
        let mut progress = DialogueProgress::begin(3);
        progress.retain(|place| place != 1);
        progress.count_question(true);
        progress.count_question(false);
        assert_eq!(progress.remaining(), [0, 2]);
        progress.record_stop(Some(2));
        assert_eq!(progress.measures(), [2.0, 1.0, 3.0, 1.0]);
        let reply = Reply::undecided();
        let bytes = progress.to_bytes(Some(&reply));
        let read = |bytes: &[u8], things, most| DialogueProgress::from_bytes(bytes, things, most);
        assert_eq!(read(&bytes, 3, 8).unwrap(), (progress.clone(), Some(reply)));
        for cut in 0..bytes.len() {
            assert!(read(&bytes[..cut], 3, 8).is_err());
        }
        assert!(read(&[&bytes[..], &[0]].concat(), 3, 8).is_err());
        assert!(read(&bytes, 4, 8).is_err());
        assert!(read(&bytes, 3, 1).is_err());
    }
}
