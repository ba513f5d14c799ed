//! The specification of a law: its values and target.

use super::LawInfo;
use crate::error::SceneError;
use crate::ids::{AgentId, Id};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A law that is installed in a world, with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawSpec {
    /// The law's id, such as `"drag"`.
    pub id: String,
    /// The version of the law's equation.
    pub version: u32,
    /// The thing that it acts on; `None`: everything it can act on. For a law on objects an object's name
    /// (all of its bodies, free or moved by joints) or `OBJECT/PART`; on joints a joint's name,
    /// `OBJECT/JOINT` or a number; on contacts `NAME` (all contacts of it) or `NAME~NAME` (those between the two), where a
    /// name is an object's, a piece of structure's or a substance's; laws on the world take none.
    #[serde(default)]
    pub target: Option<String>,
    /// Values by parameter name, in the units of [`ParamInfo::unit`](super::ParamInfo::unit).
    pub params: BTreeMap<String, f64>,
}

impl LawSpec {
    /// Returns what installs a law of this version on everything it can act on, with these values.
    pub fn new(id: &str, version: u32, values: &[(&str, f64)]) -> Self {
        let values = values.iter();
        Self {
            id: id.to_owned(),
            version,
            target: None,
            params: values
                .map(|(name, value)| ((*name).to_owned(), *value))
                .collect(),
        }
    }

    /// Returns the same law on `target`.
    #[must_use]
    pub fn with_target(mut self, target: &str) -> Self {
        self.target = Some(target.to_owned());
        self
    }

    /// The value of parameter `name`, or its default from `info`; `None` when the law has no such parameter.
    pub fn value(&self, info: &LawInfo, name: &str) -> Option<f64> {
        let param = info.param(name)?;
        Some(self.params.get(name).copied().unwrap_or(param.default))
    }

    /// Returns whether every parameter has its default: such a law is not installed, so that nothing changes bit for bit.
    pub fn is_default(&self, info: &LawInfo) -> bool {
        info.params.iter().all(|param| {
            self.params
                .get(param.name)
                .is_none_or(|value| *value == param.default)
        })
    }

    /// Checks version, names and bounds against `info`.
    ///
    /// # Errors
    /// [`SceneError`] names the parameter, what was found and what is allowed.
    pub fn check(&self, info: &LawInfo) -> Result<(), SceneError> {
        let at = format!("law {}", self.id);
        if self.version != info.version {
            let found = format!("{} (this build has {})", self.version, info.version);
            return Err(SceneError::Range {
                at,
                field: "version",
                found,
                allowed: "this build's version",
            });
        }
        for (name, value) in &self.params {
            let Some(param) = info.param(name) else {
                let known = info
                    .params
                    .iter()
                    .map(|param| param.name.to_owned())
                    .collect();
                return Err(SceneError::Unknown {
                    at,
                    kind: "parameter",
                    name: name.clone(),
                    known,
                });
            };
            if !(param.low..=param.high).contains(value) {
                let found = format!(
                    "{name} = {value} (bounds {} to {} {})",
                    param.low, param.high, param.unit
                );
                return Err(SceneError::Range {
                    at,
                    field: "parameter",
                    found,
                    allowed: "a value within its bounds",
                });
            }
        }
        Ok(())
    }

    /// Returns whether two specs ask for one law on one target, with whatever values: a law that comes in the place of such
    /// a one goes on from what that one remembers.
    pub fn is_same_law(&self, other: &Self) -> bool {
        self.id == other.id && self.target == other.target
    }

    /// Returns for each of the laws `now` the position of the one among those `before` that it goes on from: the same law,
    /// and of several the one with the same number. Shape as `now`.
    pub fn predecessor_indices<S: std::borrow::Borrow<Self>>(
        before: &[S],
        now: &[S],
    ) -> Vec<Option<usize>> {
        let same = |a: &S, b: &S| a.borrow().is_same_law(b.borrow());
        let numbered = now.iter().enumerate();
        numbered
            .map(|(k, law)| {
                let earlier = now[..k].iter().filter(|other| same(law, other)).count();
                let old = before.iter().enumerate();
                old.filter(|(_, old)| same(law, old))
                    .map(|(place, _)| place)
                    .nth(earlier)
            })
            .collect()
    }

    /// Returns the agent that the target of a law on agents names, of the `count` that there are; `None` without a target.
    ///
    /// # Errors
    /// The target, where it is not one of their numbers.
    pub fn target_agent(&self, count: usize) -> Result<Option<AgentId>, &str> {
        let Some(target) = self.target.as_deref() else {
            return Ok(None);
        };
        let number = target.parse().ok().filter(|number| *number < count);
        number.map(AgentId::from_index).map(Some).ok_or(target)
    }

    /// Returns whether a law on agents acts on this one: it has no target, or its target is the agent's number.
    pub fn is_on_agent(&self, agent: AgentId) -> bool {
        let number = self.target.as_ref().map(|target| target.parse::<usize>());
        number.is_none_or(|number| number == Ok(agent.index()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_go_on_from_the_same_law_with_the_same_number() {
        let lag = LawSpec::new("lag", 1, &[("tau_s", 0.1)]);
        let other = LawSpec::new("lag", 1, &[]).with_target("elbow");
        let wind = LawSpec::new("wind", 1, &[]);
        let before = [&lag, &other, &lag];
        let now = [&wind, &lag, &lag, &other, &lag];
        let places = LawSpec::predecessor_indices(&before, &now);
        assert_eq!(places, [None, Some(0), Some(2), Some(1), None]);
    }

    #[test]
    fn a_target_on_agents_is_the_number_of_one() {
        let law = LawSpec::new("noise", 1, &[]);
        assert_eq!(law.target_agent(0), Ok(None));
        assert!(law.is_on_agent(AgentId(3)));
        let law = law.with_target("1");
        assert_eq!(law.target_agent(2), Ok(Some(AgentId(1))));
        assert!(law.is_on_agent(AgentId(1)) && !law.is_on_agent(AgentId(0)));
        assert_eq!(law.target_agent(1), Err("1"));
        let law = law.with_target("robot");
        assert_eq!(law.target_agent(9), Err("robot"));
        assert!(!law.is_on_agent(AgentId(0)));
    }
}
