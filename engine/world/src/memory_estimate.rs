//! Memory estimates of environments, checked against the machine before their memory is taken.

use crate::env::Env;
use crate::error::WorldError;
use crate::free_memory::{free_bytes, mib};
use crate::sensors::{image_bytes, observation_bytes};
use crate::world::World;

/// Memory of a world beside its bodies, bytes.
const WORLD_BYTES: u64 = 64 << 10;
/// Memory of a free body in a world, with its pieces and their contacts, bytes.
const BODY_BYTES: u64 = 9 << 10;
/// Memory of a fixed piece of the house in a world, bytes.
const PIECE_BYTES: u64 = 768;
/// Memory of a sample of a channel of an agent's window of sound, with the echoes and filters on their way to it, bytes.
const SAMPLE_BYTES: u64 = 128;

/// The memory of one environment beside what it shares with others over its house, bytes: rather more than it comes to need where
/// most lies still.
struct MemoryEstimate {
    world: u64,
    pictures: u64,
    /// The caller's array, and a copy for a caller that keeps it.
    observations: u64,
}

impl MemoryEstimate {
    fn of(env: &Env) -> Self {
        let requests = env.requests();
        let views = requests.views.iter();
        let pictures = views.map(|view| image_bytes(&view.eye.camera, view.channels));
        let ears = requests.listeners.iter();
        let heard: u64 = ears
            .map(|(listener, samples)| (listener.channels() * samples) as u64)
            .sum();
        let specs = env.sensor_specs();
        Self {
            world: world_bytes(env.world()) + heard * SAMPLE_BYTES,
            pictures: pictures.sum(),
            observations: 2 * specs.iter().map(observation_bytes).sum::<u64>(),
        }
    }

    fn bytes(&self) -> u64 {
        self.world + self.pictures + self.observations
    }
}

fn world_bytes(world: &World) -> u64 {
    let model = world.engines().physics_model();
    let (bodies, pieces) = (model.body_count() as u64, model.static_piece_count() as u64);
    WORLD_BYTES + bodies * BODY_BYTES + pieces * PIECE_BYTES
}

/// Refuses `count` environments like `env` that the free memory cannot hold. Nothing is refused where the system does not
/// say how much is free.
///
/// # Errors
/// [`WorldError::Config`] with what one takes, what is free, and how many there could be.
pub fn check(env: &Env, count: usize) -> Result<(), WorldError> {
    free_bytes().map_or(Ok(()), |free| {
        check_against(&MemoryEstimate::of(env), count, free)
    })
}

fn check_against(need: &MemoryEstimate, count: usize, free: u64) -> Result<(), WorldError> {
    let fitting = free / need.bytes().max(1);
    if count as u64 <= fitting {
        return Ok(());
    }
    let one = format!(
        "an environment takes {}, of which pictures {} and observations {}, and {} are free",
        mib(need.bytes()),
        mib(need.pictures),
        mib(need.observations),
        mib(free)
    );
    Err(if fitting == 0 {
        WorldError::Config {
            field: "sensors",
            found: "too large for this machine".to_owned(),
            allowed: format!("what its memory holds: {one}; take smaller images"),
        }
    } else {
        WorldError::Config {
            field: "num_envs",
            found: count.to_string(),
            allowed: format!("at most {fitting} on this machine: {one}"),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_held_is_refused_with_how_many_could_be() {
        let need = MemoryEstimate {
            world: 1 << 20,
            pictures: 3 << 20,
            observations: 6 << 20,
        };
        let refused = |count, free| check_against(&need, count, free).map_err(|e| e.to_string());
        assert_eq!(refused(10, 100 << 20), Ok(()));
        let one =
            "an environment takes 10.0 MiB, of which pictures 3.0 MiB and observations 6.0 MiB";
        assert_eq!(
            refused(11, 105 << 20).unwrap_err(),
            format!(
                "num_envs is 11; allowed is at most 10 on this machine: {one}, and 105.0 MiB are free"
            )
        );
        assert_eq!(
            refused(1, 9 << 20).unwrap_err(),
            format!(
                "sensors is too large for this machine; allowed is what its memory holds: {one}, and 9.0 MiB are free; take \
                 smaller images"
            )
        );
    }
}
