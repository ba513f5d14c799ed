//! An environment at one moment, as bytes.

use crate::env::Env;
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use dwell_scene::{AgentId, IdVec, Pose};
use serde::{Deserialize, Serialize};

/// Header of [`Env::snapshot`]: its kind and version.
const MAGIC: &[u8] = b"dwenv4";

/// An episode at one moment. Its goal comes from the seed again.
#[derive(Serialize, Deserialize)]
struct EnvSnapshot {
    task: String,
    seed: u64,
    steps: u64,
    done: bool,
    instruction: String,
    starts: IdVec<AgentId, Pose>,
    progress: NavigationMetrics,
    world: Vec<u8>,
}

impl Env {
    /// World and episode as bytes.
    ///
    /// # Errors
    /// [`WorldError::Usage`] before the first reset.
    ///
    /// # Panics
    /// Never: plain data can always be written to memory.
    pub fn snapshot(&self) -> Result<Vec<u8>, WorldError> {
        let Some(episode) = &self.episode else {
            let message = "snapshot: no episode has begun; call reset first";
            return Err(WorldError::Usage(message.to_owned()));
        };
        let moment = EnvSnapshot {
            task: self.kind.name.to_owned(),
            seed: self.seed,
            steps: self.steps,
            done: self.done,
            instruction: episode.instruction.clone(),
            starts: episode.starts.clone(),
            progress: episode.progress,
            world: self.world.snapshot(),
        };
        let body =
            postcard::to_stdvec(&moment).expect("plain data can always be written to memory");
        Ok([MAGIC, &body].concat())
    }

    /// Restores [`Self::snapshot`] in an environment of the same make; the next steps give the same bits as
    /// they did then. Only the scripted expert forgets a manoeuvre that it was about.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] with the reason; no episode runs then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), WorldError> {
        let refuse = |why: String| WorldError::Snapshot(why);
        let body = bytes
            .strip_prefix(MAGIC)
            .ok_or_else(|| refuse("it does not begin with \"dwenv4\"".to_owned()))?;
        let moment: EnvSnapshot =
            postcard::from_bytes(body).map_err(|error| refuse(error.to_string()))?;
        if moment.task != self.kind.name {
            return Err(refuse(format!("it is of the task {}", moment.task)));
        }
        self.reset(moment.seed)?;
        let tokens = self.tokens_of(&moment.instruction);
        let restored = self.world.restore(&moment.world).and(tokens);
        let (Some(episode), Ok(tokens)) = (self.episode.as_mut(), &restored) else {
            self.episode = None;
            return restored.map(drop);
        };
        episode.tokens.clone_from(tokens);
        episode.instruction = moment.instruction;
        (episode.starts, episode.progress) = (moment.starts, moment.progress);
        (self.steps, self.done) = (moment.steps, moment.done);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::DiscreteAction;
    use crate::engines::Engines;
    use crate::env::EnvConfig;
    use crate::episode::StepInfo;
    use std::sync::Arc;

    fn env() -> Env {
        let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
        let config: EnvConfig =
            serde_json::from_str(r#"{"sensors": [{"kind": "compass"}]}"#).unwrap();
        Env::new(Engines::new(Arc::new(house)), &config).unwrap()
    }

    #[test]
    fn a_restored_episode_goes_on_and_is_judged_as_before() {
        use DiscreteAction::{MoveForward, Stop, TurnLeft};

        let mut env = env();
        assert!(matches!(env.snapshot(), Err(WorldError::Usage(_))));
        env.reset(3).unwrap();
        let go = |env: &mut Env, actions: &[DiscreteAction]| -> Vec<(u64, StepInfo)> {
            let step = |action: &DiscreteAction| {
                let info = env.step(*action).unwrap();
                env.listen().unwrap();
                (env.world().hash(), info)
            };
            actions.iter().map(step).collect()
        };
        go(&mut env, &[MoveForward, TurnLeft, MoveForward]);
        let text = env.episode().unwrap().instruction.clone();
        let saved = env.snapshot().unwrap();
        let rest = [MoveForward, MoveForward, TurnLeft, Stop];
        let first = go(&mut env, &rest);
        assert!(env.check_can_step().is_err());
        env.restore(&saved).unwrap();
        assert_eq!(go(&mut env, &rest), first);
        let mut other = self::env();
        other.reset(8).unwrap();
        other.restore(&saved).unwrap();
        assert_eq!(other.steps(), 3);
        assert_eq!(other.episode().unwrap().instruction, text);
        assert_eq!(go(&mut other, &rest), first);
        for cut in [0, 5, 30, saved.len() / 2, saved.len() - 1] {
            assert!(other.restore(&saved[..cut]).is_err(), "{cut}");
        }
    }
}
