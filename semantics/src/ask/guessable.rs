//! Questions that their words answer: "Is there a toilet in the bathroom?"

use std::collections::BTreeSet;
use std::sync::LazyLock;

/// Returns whether a text, in its fixed wording, is left out because who knows no house but many answers it: `assets/guessable_questions.txt`.
///
/// # Source
/// The filter of A. Das et al., "Embodied Question Answering", CVPR 2018, section 4.2, which leaves out questions whose answers
/// over all houses have a low entropy.
pub fn is_guessable(text: &str) -> bool {
    static TEXTS: LazyLock<BTreeSet<&'static str>> = LazyLock::new(|| {
        include_str!("../../../assets/guessable_questions.txt")
            .lines()
            .collect()
    });
    TEXTS.contains(text)
}
