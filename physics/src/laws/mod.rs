//! Physical effects that the basic model lacks. One file each, one line in the list.
//!
//! A law at its default is not installed, so that nothing changes bit for bit.

mod backlash;
mod drag;

use crate::body::Body;
use crate::engine::Engine;
use crate::error::PhysicsError;
use crate::model::PhysicsModel;
use dwell_scene::{JointId, LawInfo, LawSpec, State};
use std::fmt::Debug;
use std::sync::LazyLock;

/// A law of this engine: what is known about it, and how it is put to work.
struct Law {
    info: LawInfo,
    install: Install,
}

/// Puts a law to work on what its spec names.
type Install = fn(&LawSpec, &LawInfo, &PhysicsModel, &State) -> Result<Box<dyn Acts>, PhysicsError>;

/// The laws of this engine.
static LAWS: [Law; 2] = [drag::LAW, backlash::LAW];

/// What is known about each law of this engine.
///
/// ```
/// let drag = dwell_physics::laws::all().iter().find(|law| law.id == "drag").unwrap();
/// assert_eq!(drag.params[0].name, "c_d");
/// ```
pub fn all() -> &'static [LawInfo] {
    static INFOS: LazyLock<Vec<LawInfo>> =
        LazyLock::new(|| LAWS.iter().map(|law| law.info.clone()).collect());
    &INFOS
}

/// A law at work in a world.
pub(crate) trait Acts: Debug + Send + Sync {
    /// Acts on bodies for half a physics step, before and after it (Strang's splitting).
    fn half_step(&self, _engine: &mut Engine, _bodies: &[Body], _half_dt_s: f32) {}

    /// Where a joint's motor goes when its servo is told `target`.
    fn servo_target(&mut self, _joint: JointId, target: f32) -> f32 {
        target
    }

    /// What it remembers, for snapshots.
    fn memory(&self) -> Vec<f32> {
        Vec::new()
    }

    /// Takes back what [`Acts::memory`] gave.
    fn recall(&mut self, _memory: &[f32]) {}

    /// A copy.
    fn boxed(&self) -> Box<dyn Acts>;
}

/// An installed law with the words it was installed by.
#[derive(Debug)]
pub(crate) struct Installed {
    pub(crate) spec: LawSpec,
    pub(crate) law: Box<dyn Acts>,
}

impl Clone for Installed {
    fn clone(&self) -> Self {
        Self {
            spec: self.spec.clone(),
            law: self.law.boxed(),
        }
    }
}

/// Installs the state's laws that belong to this engine and differ from their default. A law that was there before, on
/// the same target, keeps its memory.
pub(crate) fn install(
    model: &PhysicsModel,
    state: &State,
    before: &[Installed],
) -> Result<Vec<Installed>, PhysicsError> {
    let mut installed = Vec::new();
    for spec in &state.laws {
        let Some(law) = LAWS.iter().find(|law| law.info.id == spec.id) else {
            continue;
        };
        spec.check(&law.info)?;
        if spec.is_default(&law.info) {
            continue;
        }
        let mut acts = (law.install)(spec, &law.info, model, state)?;
        let same = |old: &&Installed| old.spec.id == spec.id && old.spec.target == spec.target;
        if let Some(old) = before.iter().find(same) {
            acts.recall(&old.law.memory());
        }
        installed.push(Installed {
            spec: spec.clone(),
            law: acts,
        });
    }
    Ok(installed)
}

fn no_target<'a>(
    law: &'static str,
    kind: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a str>,
) -> PhysicsError {
    PhysicsError::LawTarget {
        law,
        kind,
        name: name.to_owned(),
        known: known.take(12).map(str::to_owned).collect(),
    }
}
