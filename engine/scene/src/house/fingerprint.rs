//! Fingerprint of a house.

use super::HouseData;
use crate::ids::IdVec;
use crate::interrupt;
use glam::Vec3;
use xxhash_rust::xxh3::Xxh3;

/// The number of [`House::fingerprint`](super::House::fingerprint).
pub(super) fn of(data: &HouseData) -> u64 {
    let mut hash = Xxh3::new();
    // Meshes and sounds are hashed below, images and the sky not at all: they only affect looks.
    let tables = HouseData {
        meshes: IdVec::default(),
        textures: IdVec::default(),
        sky: None,
        sound_files: IdVec::default(),
        ..data.clone()
    };
    let tables = postcard::to_stdvec(&tables)
        .expect("a house's tables are plain data that postcard can always write to memory");
    hash.update(&tables);
    for mesh in &data.meshes {
        interrupt::unwind_if_cancelled();
        hash.update(&(mesh.positions.len() as u64).to_le_bytes());
        for position in &mesh.positions {
            hash.update(&bytes_of(position));
        }
        for triangle in &mesh.triangles {
            hash.update(&triangle.map(u32::to_le_bytes).concat());
        }
    }
    for sound in &data.sound_files {
        hash.update(sound.name.as_bytes());
        hash.update(&(sound.bytes.len() as u64).to_le_bytes());
        hash.update(&sound.bytes);
    }
    hash.digest()
}

fn bytes_of(position: &Vec3) -> [u8; 12] {
    let mut bytes = [0; 12];
    for (to, from) in bytes.chunks_exact_mut(4).zip(position.to_array()) {
        to.copy_from_slice(&from.to_le_bytes());
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::super::HouseData;
    use crate::{AgentStart, House, Mesh, ShoeboxMaterials, SoundFile};
    use glam::{Affine3A, Vec3};
    use std::sync::Arc;

    #[test]
    fn houses_that_differ_in_anything_physical_differ_in_their_number() {
        let build = |size| House::shoebox(size, &ShoeboxMaterials::default()).unwrap();
        let house = build([4.0, 2.5, 4.0]);
        assert_eq!(house.fingerprint(), build([4.0, 2.5, 4.0]).fingerprint());
        let changed = |change: &dyn Fn(&mut HouseData)| {
            let mut data = house.data().clone();
            change(&mut data);
            House::new(data).unwrap().fingerprint()
        };
        assert_eq!(house.fingerprint(), changed(&|_| ()));
        let slippery = changed(&|data| data.materials.as_mut_slice()[0].friction = 0.01);
        let larger = changed(&|data| {
            let mesh = &mut data.meshes.as_mut_slice()[0];
            *mesh = Arc::new(mesh.transformed(&Affine3A::from_scale(Vec3::new(1.0, 1.0, 1.001))));
        });
        let turned = changed(&|data| {
            let mesh = &mut data.meshes.as_mut_slice()[0];
            let mut other = Mesh::clone(mesh);
            other.triangles[0].rotate_left(1);
            *mesh = Arc::new(other);
        });
        let started = changed(&|data| {
            data.agent_starts.push(AgentStart {
                position: Vec3::ONE,
                yaw_rad: 0.0,
            });
        });
        let sounding = |bytes: &[u8]| {
            changed(&|data| {
                data.sound_files.push(Arc::new(SoundFile {
                    name: "a.wav".to_owned(),
                    bytes: bytes.to_vec(),
                }));
            })
        };
        let numbers = [
            house.fingerprint(),
            slippery,
            larger,
            turned,
            started,
            sounding(b"a"),
            sounding(b"b"),
        ];
        for (k, number) in numbers.iter().enumerate() {
            assert!(!numbers[..k].contains(number), "{numbers:?}");
        }
    }
}
