//! Effects on sound that the basic model lacks: one file and one line each.

pub mod microphone_noise;

use dwell_scene::LawInfo;

/// All laws of sound.
pub fn all() -> &'static [&'static LawInfo] {
    static ALL: [&LawInfo; 1] = [&microphone_noise::INFO];
    &ALL
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::LawSpec;
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
