//! The numbers of a law that acts.

use super::{LawInfo, LawSpec};

/// A law that is asked for, with what is known about it.
#[derive(Clone, Copy, Debug)]
pub struct LawValues<'a> {
    /// The installed specification.
    pub spec: &'a LawSpec,
    /// Its description.
    pub info: &'static LawInfo,
}

impl LawValues<'_> {
    /// Returns the value of a parameter, or its default, in the unit of [`ParamInfo::unit`](super::ParamInfo::unit).
    ///
    /// # Panics
    /// When the law has no parameter of this name, which is a mistake in the law's own file.
    pub fn get(&self, name: &str) -> f64 {
        let value = self.spec.value(self.info, name);
        value.unwrap_or_else(|| panic!("law {} has no parameter {name:?}", self.info.id))
    }

    /// As [`Self::get`], in single precision.
    ///
    /// # Panics
    /// As [`Self::get`].
    pub fn get_f32(&self, name: &str) -> f32 {
        self.get(name) as f32
    }
}
