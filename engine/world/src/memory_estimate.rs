//! Memory estimates of environments and pictures, checked against the machine before their memory is taken.

use crate::env::Env;
use crate::error::WorldError;
use crate::sensors::{Dtype, SensorSpec};
use crate::world::World;
use dwell_render::{Camera, ImageChannels};
use std::fs::read_to_string;
use std::path::Path;

/// Memory of a world beside its bodies, bytes.
const WORLD_BYTES: u64 = 64 << 10;
/// Memory of a free body in a world, with its pieces and their contacts, bytes.
const BODY_BYTES: u64 = 9 << 10;
/// Memory of a fixed piece of the house in a world, bytes.
const PIECE_BYTES: u64 = 768;
/// Memory of a sample of an agent's window of sound, with the echoes and filters on their way to it, bytes.
const SAMPLE_BYTES: u64 = 256;
/// Size of a picture from which on the system is asked whether it fits, bytes.
const PICTURE_BYTES_ASKED_ABOUT: u64 = 64 << 20;

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
        let pictures = views.map(|view| picture_bytes(&view.eye.camera, view.channels));
        let ears = requests.ears.iter();
        let heard: u64 = ears.map(|(_, samples)| *samples as u64).sum();
        let specs = env.specs();
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
    let model = world.engines().physics();
    let (bodies, pieces) = (model.body_count() as u64, model.static_piece_count() as u64);
    WORLD_BYTES + bodies * BODY_BYTES + pieces * PIECE_BYTES
}

fn picture_bytes(camera: &Camera, channels: ImageChannels) -> u64 {
    let ImageChannels {
        rgb,
        depth,
        instance,
        semantic,
        normals,
        albedo,
        flow,
    } = channels;
    let images = [
        (rgb, 3),
        (depth, 4),
        (instance, 4),
        (semantic, 4),
        (normals, 12),
        (albedo, 12),
        (flow, 8),
    ];
    let pixel: u64 = images.iter().map(|(on, size)| u64::from(*on) * size).sum();
    camera.pixels() as u64 * pixel
}

fn observation_bytes(spec: &SensorSpec) -> u64 {
    let bytes = match spec.dtype {
        Dtype::Uint8 => 1,
        Dtype::Float32 | Dtype::Int32 | Dtype::Text => 4,
    };
    spec.len() as u64 * bytes
}

/// Refuses a picture with its observations that the free memory cannot hold. Nothing is refused where the system does not say
/// how much is free.
///
/// # Errors
/// [`WorldError::Config`] with what it takes and what is free.
pub(crate) fn check_picture(
    camera: &Camera,
    channels: ImageChannels,
    specs: &[SensorSpec],
) -> Result<(), WorldError> {
    let observations = specs.iter().map(observation_bytes);
    let need = picture_bytes(camera, channels) + observations.sum::<u64>();
    // Small ones are made without asking the system.
    if need < PICTURE_BYTES_ASKED_ABOUT {
        return Ok(());
    }
    free_bytes().map_or(Ok(()), |free| check_picture_against(camera, need, free))
}

fn check_picture_against(camera: &Camera, need: u64, free: u64) -> Result<(), WorldError> {
    if need <= free {
        return Ok(());
    }
    Err(WorldError::Config {
        field: "camera",
        found: format!("{} by {} pixels", camera.width(), camera.height()),
        allowed: format!(
            "what the memory of this machine holds: they take {}, and {} are free; take a smaller image or fewer channels",
            mib(need),
            mib(free)
        ),
    })
}

fn mib(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
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

/// Returns the memory that this process may still take: of the machine, of its group's limit and of its own; `None` where unknown.
fn free_bytes() -> Option<u64> {
    let of_machine = kibibytes("/proc/meminfo", "MemAvailable:");
    [of_machine, of_group(), of_process()]
        .into_iter()
        .flatten()
        .min()
}

/// The number behind `name` in a file of the system that counts in KiB, bytes.
fn kibibytes(file: &str, name: &str) -> Option<u64> {
    let text = read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let count: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(count << 10)
}

/// The free memory under the limit on addresses (`ulimit -v`).
fn of_process() -> Option<u64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let most = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = most.split_whitespace().next()?.parse().ok()?;
    Some(most.saturating_sub(kibibytes("/proc/self/status", "VmSize:")?))
}

/// The free memory under the limits of the process's control groups, of either version.
fn of_group() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let rooms = groups.lines().filter_map(|line| {
        let (_, line) = line.split_once(':')?;
        let (kinds, path) = line.split_once(':')?;
        let (root, most, used) = match kinds {
            "" => ("/sys/fs/cgroup", "memory.max", "memory.current"),
            "memory" => (
                "/sys/fs/cgroup/memory",
                "memory.limit_in_bytes",
                "memory.usage_in_bytes",
            ),
            _ => return None,
        };
        let groups = Path::new(path).ancestors();
        let folders =
            groups.map(|group| Path::new(root).join(group.strip_prefix("/").unwrap_or(group)));
        folders
            .filter_map(|folder| room_of_group(&folder, most, used))
            .min()
    });
    rooms.min()
}

fn room_of_group(folder: &Path, most: &str, used: &str) -> Option<u64> {
    let number =
        |name: &str| -> Option<u64> { read_to_string(folder.join(name)).ok()?.trim().parse().ok() };
    let most = number(most)?;
    // The system's cache of files is given up when memory is needed.
    let stat = read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let kept = stat
        .lines()
        .find_map(|line| line.strip_prefix("inactive_file "))
        .and_then(|count| count.trim().parse().ok())
        .unwrap_or(0);
    Some(most.saturating_sub(number(used)?.saturating_sub(kept)))
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

    #[test]
    fn a_picture_that_cannot_be_held_is_refused_with_what_it_takes() {
        let camera = Camera::from_fov(8000, 4000, 90.0).unwrap();
        let channels = ImageChannels {
            rgb: true,
            ..ImageChannels::NONE
        };
        let need = picture_bytes(&camera, channels);
        assert_eq!(need, 3 * 8000 * 4000);
        let refused = |free| check_picture_against(&camera, need, free).map_err(|e| e.to_string());
        assert_eq!(refused(need), Ok(()));
        assert_eq!(
            refused(50 << 20).unwrap_err(),
            "camera is 8000 by 4000 pixels; allowed is what the memory of this machine holds: they take 91.6 MiB, and 50.0 MiB \
             are free; take a smaller image or fewer channels"
        );
    }

    #[test]
    fn a_group_has_room_for_its_limit_less_what_it_uses_and_cannot_give_up() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let room = || room_of_group(folder.path(), "memory.max", "memory.current");
        assert_eq!(room(), None);
        write("memory.max", "max\n");
        write("memory.current", "700\n");
        assert_eq!(room(), None);
        write("memory.max", "1000\n");
        assert_eq!(room(), Some(300));
        write("memory.stat", "anon 5\ninactive_file 200\nactive_file 9\n");
        assert_eq!(room(), Some(500));
    }
}
