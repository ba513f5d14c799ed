//! Addresses of laws: `law/ID/PARAM`, `law/ID@TARGET/PARAM`, `law/N/PARAM`.
//!
//! `ID` alone is the law without a target, `ID@TARGET` the one on that target; neither need be installed: the first number
//! that differs from its default installs it behind the others, and a law whose numbers are all default has no effect. `N`
//! counts [`State::laws`] from 0, for laws that are installed twice on one target. A target is stored in its canonical
//! spelling ([`LawSpec::canonical_target`]), so that no law acts twice on a thing with two names. Values are stored in
//! [`State::laws`] only, so that they are in snapshot and hash.

use super::{Address, Parameter, State};
use crate::error::SceneError;
use crate::house::House;
use crate::law::{LawInfo, LawSpec, ParamInfo};
use std::collections::BTreeSet;

/// The law and parameter that an address names.
struct LawParameterRef<'a> {
    info: &'a LawInfo,
    param: &'a ParamInfo,
    target: Option<String>,
    /// Its index in [`State::laws`]; `None` for a law that is not installed.
    place: Option<usize>,
}

impl Address {
    /// Returns whether it is the address of a law's parameter, which [`State::law_parameter`] reads.
    pub fn is_law(&self) -> bool {
        self.as_str().starts_with("law/")
    }

    /// The law's name and its parameter's.
    fn law_words(&self) -> Result<(&str, &str), SceneError> {
        let inner = self.as_str().strip_prefix("law/");
        inner
            .and_then(|inner| inner.rsplit_once('/'))
            .ok_or_else(|| {
                self.invalid(
                    "a law's parameter is law/ID/PARAM, law/ID@TARGET/PARAM or law/N/PARAM",
                )
            })
    }
}

impl State {
    fn find_law<'a>(
        &self,
        house: &House,
        known: &[&'a LawInfo],
        address: &'a Address,
    ) -> Result<LawParameterRef<'a>, SceneError> {
        let (name, param) = address.law_words()?;
        let info_of = |id: &str| {
            LawInfo::find(known.iter().copied(), id)
                .map_err(|unknown| address.invalid(unknown.to_string()))
        };
        let (info, target, place) = if let Ok(place) = name.parse::<usize>() {
            let spec = self.laws.get(place).ok_or_else(|| {
                let count = self.laws.len();
                address.invalid(format!(
                    "no law {place}; {count} are installed, counted from 0"
                ))
            })?;
            (info_of(&spec.id)?, None, Some(place))
        } else {
            let (id, target) = match name.split_once('@') {
                Some((id, target)) => (id, Some(target)),
                None => (name, None),
            };
            let info = info_of(id)?;
            let target = target.map(|target| LawSpec::canonical_target(house, info, target));
            let is = |spec: &LawSpec| {
                spec.id == id
                    && match (&spec.target, &target) {
                        (None, None) => true,
                        (Some(a), Some(b)) => LawSpec::is_same_target(house, info, a, b),
                        _ => false,
                    }
            };
            let mut places = (0..self.laws.len()).filter(|place| is(&self.laws[*place]));
            let place = places.next();
            if let (Some(first), Some(second)) = (place, places.next()) {
                return Err(address.invalid(format!(
                    "this law is installed more than once; say which by its number: law/{first}/{param}, law/{second}/{param}"
                )));
            }
            let installed = place.and_then(|place| self.laws[place].target.as_deref());
            if let (Some(there), Some(asked)) = (installed, &target)
                && there.contains('~')
                && there != asked
            {
                return Err(address.invalid(format!(
                    "this law is installed as law/{id}@{there}: the surface stands first"
                )));
            }
            (info, target, place)
        };
        let param = info.param(param).ok_or_else(|| {
            let names: Vec<_> = info.params.iter().map(|known| known.name).collect();
            address.invalid(format!(
                "no parameter {param:?}; law {} has {names:?}",
                info.id
            ))
        })?;
        Ok(LawParameterRef {
            info,
            param,
            target,
            place,
        })
    }

    /// Returns the parameter of a law at an address; its default where the law is not installed. `known`: the laws of all
    /// engines.
    ///
    /// # Errors
    /// [`SceneError::Address`] names the wrong word and the allowed ones.
    pub fn law_parameter(
        &self,
        house: &House,
        known: &[&LawInfo],
        address: &Address,
    ) -> Result<Parameter, SceneError> {
        let named = self.find_law(house, known, address)?;
        let value = named
            .place
            .and_then(|place| self.laws[place].params.get(named.param.name).copied());
        Ok(Parameter {
            value: value.unwrap_or(named.param.default),
            unit: named.param.unit,
            low: named.param.low,
            high: named.param.high,
        })
    }

    /// Sets a law's parameter. A default is not stored, and laws at the end of the list whose numbers are all default are
    /// removed, so that setting a value and setting it back leaves no trace.
    ///
    /// # Errors
    /// [`SceneError::Address`] for an address that names nothing or a value out of bounds, [`SceneError::Range`] for a law
    /// on a joint on which the same law acts under another name.
    pub fn set_law_parameter(
        &mut self,
        house: &House,
        known: &[&LawInfo],
        address: &Address,
        value: f64,
    ) -> Result<(), SceneError> {
        self.set_law_parameters(house, known, &[(address.clone(), value)])
    }

    /// Sets parameters of laws together: all of them, or none.
    ///
    /// # Errors
    /// As [`State::set_law_parameter`], and for a parameter that is given twice, in whatever spelling. Nothing has changed then.
    pub fn set_law_parameters(
        &mut self,
        house: &House,
        known: &[&LawInfo],
        values: &[(Address, f64)],
    ) -> Result<(), SceneError> {
        let before = self.laws.clone();
        let set = self.try_set_laws(house, known, values);
        if set.is_err() {
            self.laws = before;
        }
        set
    }

    fn try_set_laws(
        &mut self,
        house: &House,
        known: &[&LawInfo],
        values: &[(Address, f64)],
    ) -> Result<(), SceneError> {
        let mut there = BTreeSet::new();
        for (address, _) in values {
            let named = self.find_law(house, known, address)?;
            let target = named.target.filter(|_| named.place.is_none());
            if !there.insert((named.place, named.info.id, target, named.param.name)) {
                return Err(address.invalid(
                    "it is set twice at once, in one or two spellings; allowed is each parameter once",
                ));
            }
        }
        for (address, value) in values {
            self.put_law(house, known, address, *value)?;
        }
        // Only now: numbers of laws refer to the list before the call.
        let idle = |spec: &LawSpec| {
            let info = LawInfo::find(known.iter().copied(), &spec.id);
            info.is_ok_and(|info| spec.is_default(info))
        };
        while self.laws.last().is_some_and(idle) {
            self.laws.pop();
        }
        LawSpec::check_targets(house, known, &self.laws)
    }

    fn put_law(
        &mut self,
        house: &House,
        known: &[&LawInfo],
        address: &Address,
        value: f64,
    ) -> Result<(), SceneError> {
        let named = self.find_law(house, known, address)?;
        let param = named.param;
        address.check_range(value, param.low, param.high, param.unit)?;
        let place = named.place.unwrap_or(self.laws.len());
        if named.place.is_none() {
            self.laws.push(LawSpec {
                target: named.target,
                ..named.info.spec(&[])
            });
        }
        let params = &mut self.laws[place].params;
        if value == param.default {
            params.remove(param.name);
        } else {
            params.insert(param.name.to_owned(), value);
        }
        Ok(())
    }

    /// Returns the addresses of all parameters of laws: of those that are installed, in order, then of the others without
    /// target. A law whose target does not fit in an address (too many words, an empty one) is listed by its number.
    ///
    /// # Panics
    /// Never: laws' ids and their parameters' names are words.
    pub fn law_addresses(&self, known: &[&LawInfo]) -> Vec<Address> {
        let named = |name: &str, info: &LawInfo| -> Option<Vec<Address>> {
            let of = |param: &ParamInfo| format!("law/{name}/{}", param.name).parse().ok();
            info.params.iter().map(of).collect()
        };
        let certain = "laws' ids, their numbers and their parameters' names are words";
        let mut addresses = Vec::new();
        for (place, spec) in self.laws.iter().enumerate() {
            let Ok(info) = LawInfo::find(known.iter().copied(), &spec.id) else {
                continue;
            };
            let same = self.laws.iter().filter(|other| spec.is_same_law(other));
            let twice = same.count() > 1;
            let by_name = match &spec.target {
                _ if twice => None,
                Some(target) => named(&format!("{}@{target}", spec.id), info),
                None => named(&spec.id, info),
            };
            let by_number = || named(&place.to_string(), info);
            addresses.extend(by_name.or_else(by_number).expect(certain));
        }
        for info in known {
            let plain = |spec: &LawSpec| spec.id == info.id && spec.target.is_none();
            if !self.laws.iter().any(plain) {
                addresses.extend(named(info.id, info).expect(certain));
            }
        }
        addresses
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::EngineKind;
    use crate::{House, ShoeboxMaterials};

    const fn param(name: &'static str, default: f64) -> ParamInfo {
        ParamInfo {
            name,
            unit: "1",
            default,
            low: 0.0,
            high: 20.0,
            plausible: [0.0, 1.0],
        }
    }

    const DRAG: LawInfo = LawInfo {
        id: "drag",
        version: 3,
        name: "drag",
        equation: "",
        source: "",
        engine: EngineKind::Physics,
        acts_on: "object",
        params: &[param("c_d", 0.0), param("density", 1.2)],
        regimes: &[],
        probes: &[],
        rivals: &[],
        separating_experiment: "",
    };
    const LAG: LawInfo = LawInfo {
        id: "lag",
        params: &[param("tau_s", 0.0)],
        ..DRAG
    };

    fn empty() -> State {
        State::new(&room())
    }

    fn room() -> House {
        House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap()
    }

    fn set(state: &mut State, address: &str, value: f64) -> Result<(), String> {
        let address = address.parse().unwrap();
        let set = state.set_law_parameter(&room(), &[&DRAG, &LAG], &address, value);
        set.map_err(|error| error.to_string())
    }

    fn get(state: &State, address: &str) -> f64 {
        let address = address.parse().unwrap();
        let there = state.law_parameter(&room(), &[&DRAG, &LAG], &address);
        there.unwrap().value
    }

    /// The third law is removed and another one added in the same call: the second one's number still refers to the second one.
    #[test]
    fn numbers_of_laws_count_those_that_were_there_before() {
        let mut state = empty();
        for (target, value) in [("a", 0.1), ("b", 0.2), ("c", 0.3)] {
            set(&mut state, &format!("law/drag@{target}/c_d"), value).unwrap();
        }
        set(&mut state, "law/1/c_d", 0.0).unwrap();
        let values = [
            ("law/2/c_d", 0.0),
            ("law/drag@d/c_d", 0.9),
            ("law/1/c_d", 0.4),
        ]
        .map(|(address, value)| (address.parse().unwrap(), value));
        state
            .set_law_parameters(&room(), &[&DRAG, &LAG], &values)
            .unwrap();
        let there =
            ["a", "b", "c", "d"].map(|target| get(&state, &format!("law/drag@{target}/c_d")));
        assert_eq!(there, [0.1, 0.4, 0.0, 0.9]);
        let both = [("law/1/c_d", 0.0), ("law/1/density", 2.0)];
        for order in [both, [both[1], both[0]]] {
            let mut state = state.clone();
            let values = order.map(|(address, value)| (address.parse().unwrap(), value));
            state
                .set_law_parameters(&room(), &[&DRAG, &LAG], &values)
                .unwrap();
            assert_eq!(get(&state, "law/1/density"), 2.0);
        }
    }

    #[test]
    fn the_first_number_installs_a_law_and_the_last_default_takes_it_off() {
        let mut state = empty();
        let before = state.hash();
        assert_eq!(get(&state, "law/drag@a/b/density"), 1.2);
        set(&mut state, "law/drag@a/b/c_d", 0.4).unwrap();
        assert_eq!(state.laws[0].target.as_deref(), Some("a/b"));
        assert_eq!((state.laws[0].version, state.laws[0].params.len()), (3, 1));
        assert_eq!(get(&state, "law/drag@a/b/c_d"), 0.4);
        assert_eq!(get(&state, "law/0/c_d"), 0.4);
        assert_eq!(get(&state, "law/drag/c_d"), 0.0);
        set(&mut state, "law/lag/tau_s", 0.1).unwrap();
        let both = state.hash();
        // In the middle of the list a law keeps its place, so that the order is the same when it comes back.
        set(&mut state, "law/drag@a/b/c_d", 0.0).unwrap();
        assert_eq!(state.laws.len(), 2);
        set(&mut state, "law/0/c_d", 0.4).unwrap();
        assert_eq!(state.hash(), both);
        set(&mut state, "law/drag@a/b/c_d", 0.0).unwrap();
        set(&mut state, "law/lag/tau_s", 0.0).unwrap();
        assert_eq!(state.hash(), before);
    }

    #[test]
    fn wrong_words_and_numbers_say_what_is_allowed() {
        let mut state = empty();
        for (address, value, part) in [
            ("law/lift/c_l", 0.1, "\"drag\""),
            ("law/drag/c_l", 0.1, "\"density\""),
            ("law/drag/c_d", 21.0, "0 to 20"),
            ("law/drag/c_d", f64::NAN, "0 to 20"),
            ("law/0/c_d", 1.0, "0 are installed"),
            ("law/drag", 1.0, "law/ID/PARAM"),
        ] {
            let message = set(&mut state, address, value).unwrap_err();
            assert!(message.contains(part), "{message}");
            assert!(state.laws.is_empty());
        }
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let address = "law/drag/c_d".parse().unwrap();
        let message = state.parameter(&house, &address).unwrap_err().to_string();
        assert!(message.contains("world"), "{message}");
    }

    #[test]
    fn laws_that_are_installed_twice_are_told_apart_by_number() {
        let mut state = empty();
        set(&mut state, "law/lag/tau_s", 0.1).unwrap();
        let again = state.laws[0].clone();
        state.laws.push(again);
        let message = set(&mut state, "law/lag/tau_s", 0.2).unwrap_err();
        assert!(message.contains("law/0/tau_s, law/1/tau_s"), "{message}");
        set(&mut state, "law/1/tau_s", 0.2).unwrap();
        assert_eq!(
            (get(&state, "law/0/tau_s"), get(&state, "law/1/tau_s")),
            (0.1, 0.2)
        );
        let known: &[&LawInfo] = &[&DRAG, &LAG];
        for address in state.law_addresses(known) {
            state.law_parameter(&room(), known, &address).unwrap();
        }
        assert_eq!(state.law_addresses(known).len(), 4);
    }

    /// Regression: an address of more than five words was silently left out of the list.
    #[test]
    fn no_installed_law_is_missing_from_the_list() {
        let mut state = empty();
        let known: &[&LawInfo] = &[&DRAG, &LAG];
        for target in [
            "plain",
            "a/b",
            "a/very/long/name/of/some/thing",
            "a//b",
            "tab\t",
        ] {
            state.laws = vec![DRAG.spec(&[("c_d", 0.5)]).with_target(target)];
            let listed = state.law_addresses(known);
            assert_eq!(listed.len(), 2 + 2 + 1, "{target}: {listed:?}");
            let read = |address: &Address| {
                let there = state.law_parameter(&room(), known, address);
                there.unwrap().value
            };
            assert_eq!((read(&listed[0]), read(&listed[1])), (0.5, 1.2), "{target}");
        }
    }
}
