//! Effects on sound that the basic model lacks: one file and one line each.

mod microphone_noise;

use dwell_scene::random::Key;
use dwell_scene::{LawInfo, LawSpec};
use std::sync::LazyLock;

/// A law of this engine: what is known about it, and where it acts.
struct Law {
    info: LawInfo,
    acts: Acts,
}

/// Where a law acts.
enum Acts {
    /// On what microphones give out: changes a block of pressure, Pa. What is drawn depends on the key and the block's
    /// length alone.
    Microphones(fn(&LawSpec, &LawInfo, Key, &mut [f32])),
}

/// The laws of this engine.
static LAWS: [Law; 1] = [microphone_noise::LAW];

/// What is known about each law of sound.
///
/// ```
/// assert!(dwell_acoustics::laws::all().iter().any(|law| law.id == "microphone_noise"));
/// ```
pub fn all() -> &'static [LawInfo] {
    static INFOS: LazyLock<Vec<LawInfo>> =
        LazyLock::new(|| LAWS.iter().map(|law| law.info.clone()).collect());
    &INFOS
}

/// Applies the installed laws of microphones to a block, in the order in which they were installed.
pub(crate) fn at_microphones(installed: &[LawSpec], key: Key, block: &mut [f32]) {
    for (k, spec) in installed.iter().enumerate() {
        if let Some(law) = LAWS.iter().find(|law| law.info.id == spec.id)
            && !spec.is_default(&law.info)
        {
            let Acts::Microphones(change) = law.acts;
            change(spec, &law.info, key.child(k as u64), block);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn every_law_is_consistent_and_does_nothing_by_default() {
        for law in all() {
            assert!(
                !law.equation.is_empty()
                    && !law.source.is_empty()
                    && !law.separating_experiment.is_empty()
            );
            for param in law.params {
                assert!(
                    (param.low..=param.high).contains(&param.default),
                    "{} {}",
                    law.id,
                    param.name
                );
                assert!(param.plausible[0] >= param.low && param.plausible[1] <= param.high);
            }
            let spec = LawSpec {
                id: law.id.to_owned(),
                version: law.version,
                target: None,
                params: BTreeMap::new(),
            };
            spec.check(law).unwrap();
            assert!(spec.is_default(law));
        }
    }
}
