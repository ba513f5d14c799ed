//! The laws of one engine.

use super::{LawInfo, LawSpec, LawValues};
use crate::error::SceneError;
use crate::house::House;
use std::fmt::Debug;

/// A law: what is known about it, and how it acts in its engine.
#[derive(Clone, Debug)]
pub struct Law<A> {
    /// Its description.
    pub info: LawInfo,
    /// Its effect, in the engine's own type, such as the stage of a step together with a function.
    pub effect: A,
}

/// The laws of one engine, in the order in which they are listed.
///
/// ```
/// use dwell_scene::law::{EngineKind, Law, LawInfo, LawRegistry, LawSpec, ParamInfo};
///
/// // An engine whose laws change one number.
/// static LAWS: LawRegistry<fn(f64, f64) -> f64> = LawRegistry::new(&[Law {
///     info: LawInfo {
///         id: "gain",
///         version: 1,
///         name: "gain",
///         equation: "y = factor x",
///         source: "by definition",
///         engine: EngineKind::Acoustics,
///         acts_on: "world",
///         params: &[ParamInfo {
///             name: "factor",
///             unit: "1",
///             default: 1.0,
///             low: 0.0,
///             high: 10.0,
///             plausible: [0.5, 2.0],
///         }],
///         regimes: &[],
///         probes: &[],
///         rivals: &["offset"],
///         separating_experiment: "measure at two inputs",
///     },
///     effect: |factor, x| factor * x,
/// }]);
///
/// let specs = [LawSpec::new("gain", 1, &[("factor", 2.0)]), LawSpec::new("gain", 1, &[])];
/// let y = LAWS.active(&specs).fold(3.0, |x, law| (law.effect)(law.values.get("factor"), x));
/// assert_eq!(y, 6.0);
/// ```
#[derive(Debug)]
pub struct LawRegistry<A: 'static> {
    laws: &'static [Law<A>],
}

/// A law that does something, as an engine finds it among the installed ones.
#[derive(Debug)]
pub struct ActiveLaw<'a, A: 'static> {
    /// Its position among the installed laws, those of other engines included.
    pub index: usize,
    /// Its numbers.
    pub values: LawValues<'a>,
    /// Its effect.
    pub effect: &'static A,
}

impl<A> LawRegistry<A> {
    /// Returns a registry of these laws.
    pub const fn new(laws: &'static [Law<A>]) -> Self {
        Self { laws }
    }

    /// Returns what is known about each law, in order.
    pub fn infos(&self) -> impl Iterator<Item = &'static LawInfo> + Clone + use<A> {
        self.laws.iter().map(|law| &law.info)
    }

    fn find(&self, id: &str) -> Option<&'static Law<A>> {
        self.laws.iter().find(|law| law.info.id == id)
    }

    /// Returns those of the installed laws that belong to this engine and do something, in order: a law at its defaults does
    /// nothing.
    pub fn active<'a>(&self, installed: &'a [LawSpec]) -> impl Iterator<Item = ActiveLaw<'a, A>> {
        let numbered = installed.iter().enumerate();
        numbered.filter_map(|(place, spec)| {
            let Law { info, effect: acts } = self.find(&spec.id)?;
            (!spec.is_default(info)).then_some(ActiveLaw {
                index: place,
                values: LawValues { spec, info },
                effect: acts,
            })
        })
    }

    /// Checks those of the installed laws that belong to this engine: version, names and bounds of parameters, and that no
    /// target is there in two spellings.
    ///
    /// # Errors
    /// Those of [`LawSpec::check_targets`] and [`LawSpec::check`].
    pub fn check(&self, house: &House, installed: &[LawSpec]) -> Result<(), SceneError> {
        let known: Vec<&LawInfo> = self.infos().collect();
        LawSpec::check_targets(house, &known, installed)?;
        for spec in installed {
            if let Some(law) = self.find(&spec.id) {
                spec.check(&law.info)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::house::ShoeboxMaterials;
    use crate::law::{EngineKind, ParamInfo};

    const FACTOR: ParamInfo = ParamInfo {
        name: "factor",
        unit: "1",
        default: 1.0,
        low: 0.0,
        high: 10.0,
        plausible: [0.5, 2.0],
    };
    const GAIN: LawInfo = LawInfo {
        id: "gain",
        version: 2,
        name: "gain",
        equation: "y = factor x + offset",
        source: "by definition",
        engine: EngineKind::Acoustics,
        acts_on: "agent",
        params: &[
            FACTOR,
            ParamInfo {
                name: "offset",
                default: 0.0,
                ..FACTOR
            },
        ],
        regimes: &[],
        probes: &[],
        rivals: &["lag"],
        separating_experiment: "measure at two inputs",
    };
    /// Of another engine.
    const LAG: LawInfo = LawInfo {
        id: "lag",
        params: &[FACTOR],
        ..GAIN
    };
    static LAWS: LawRegistry<&str> = LawRegistry::new(&[Law {
        info: GAIN,
        effect: "before the step",
    }]);

    fn house() -> House {
        House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap()
    }

    #[test]
    fn an_engine_finds_its_laws_that_do_something_with_their_places() {
        let specs = [
            LAG.spec(&[("factor", 3.0)]),
            GAIN.spec(&[("factor", 1.0)]),
            GAIN.spec(&[("offset", 0.5)]),
        ];
        let acting: Vec<_> = LAWS.active(&specs).collect();
        assert_eq!((acting.len(), acting[0].index), (1, 2));
        assert_eq!(*acting[0].effect, "before the step");
        let values = acting[0].values;
        assert_eq!((values.get("factor"), values.get_f32("offset")), (1.0, 0.5));
    }

    #[test]
    fn an_engine_checks_its_own_laws() {
        let check = |spec: LawSpec| LAWS.check(&house(), &[spec]).map_err(|e| e.to_string());
        assert_eq!(check(LAG.spec(&[("factor", 99.0)])), Ok(()));
        assert_eq!(check(GAIN.spec(&[("factor", 2.0)])), Ok(()));
        for (spec, part) in [
            (
                GAIN.spec(&[("factor", 99.0)]),
                "factor = 99 (bounds 0 to 10 1)",
            ),
            (GAIN.spec(&[("shift", 1.0)]), "no parameter \"shift\""),
            (LawSpec::new("gain", 1, &[]), "1 (this build has 2)"),
        ] {
            let message = check(spec).unwrap_err();
            assert!(message.contains(part), "{message}");
        }
        let twice = [
            GAIN.spec(&[]).with_target("1"),
            GAIN.spec(&[]).with_target("+1"),
        ];
        assert!(LAWS.check(&house(), &twice).is_err());
    }

    #[test]
    fn installed_laws_have_one_spelling_and_no_defaults() {
        let known = [&GAIN, &LAG];
        let installed = crate::law::check_and_canonicalize(
            &house(),
            &known,
            &[
                LAG.spec(&[("factor", 1.0)]),
                GAIN.spec(&[("factor", 1.0), ("offset", 0.5)])
                    .with_target("+1"),
            ],
        );
        let expected = GAIN.spec(&[("offset", 0.5)]).with_target("1");
        assert_eq!(installed, Ok(vec![expected]));
        let unknown =
            crate::law::check_and_canonicalize(&house(), &known, &[LawSpec::new("lift", 1, &[])]);
        assert_eq!(
            unknown.unwrap_err().to_string(),
            "no law \"lift\"; there are [\"gain\", \"lag\"]"
        );
    }
}
