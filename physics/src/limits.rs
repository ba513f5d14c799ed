//! Limits on the size of a world, checked before memory is allocated; houses that people live in stay far below them.

use crate::convert::to_rapier;
use crate::error::PhysicsError;
use crate::joints::{KinematicTree, PhysicsJoint};
use crate::model::{PhysicsModel, shapes};
use dwell_scene::interrupt;
use dwell_scene::{House, ObjectId, State};
use rapier3d::geometry::Aabb;
use rapier3d::parry::bounding_volume::BoundingVolume;
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy};

/// Most rigid bodies that can move. Each takes some 15 KB in a world and its shared initial state.
pub(crate) const MAX_BODIES: usize = 50_000;
/// Most collision pieces of a house, those that never move included.
pub(crate) const MAX_PIECES: usize = 500_000;
/// Most joints that act on each other: their efforts are computed together, in a time that grows with the third power.
pub(crate) const MAX_TREE_JOINTS: usize = 256;
/// Most pairs of a moving piece and another one near it as a world begins. Each takes some 1.5 KB, in the world and in its
/// shared initial state.
pub(crate) const MAX_NEAR_PAIRS: usize = 300_000;
/// Most pairs of pieces whose boxes intersect, including those of one body and of static geometry. Each is visited, and
/// takes 8 bytes for a moment.
pub(crate) const MAX_OVERLAPPING_BOX_PAIRS: usize = 10_000_000;
/// Most pairs of a jointed body and a piece excluded from collision: of one object, and where they overlap.
pub(crate) const MAX_EXCLUDED_PAIRS: usize = 300_000;

/// Margin of pieces' boxes in rapier, m: half of its prediction distance.
const REACH_M: f32 = 0.01;
/// Pairs from which construction of a world checks for cancellation between them.
const MANY_PAIRS: usize = 10_000;

/// Work of rapier's list of pairs in one flush, steps of [`PairWork`]: some tenths of a second, in which it asks nobody.
const STEPS_PER_FLUSH: u64 = 1_000_000;
/// Such work from which on the bodies of a new world are inserted in portions, with a flush behind each.
const MANY_STEPS: u64 = 5 * STEPS_PER_FLUSH;

/// The number of pairs of pieces in a world; with many of them a flush takes long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PairDensity {
    Low,
    High,
}

/// The pairs of pieces of a new world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PairLoad {
    pub(crate) density: PairDensity,
    /// The bodies before which those inserted so far are flushed, in order.
    pub(crate) pauses: Vec<usize>,
}

impl PairLoad {
    pub(crate) const LOW: Self = Self {
        density: PairDensity::Low,
        pauses: Vec::new(),
    };
}

/// The work of adding the pairs of each body with those before it: rapier looks through the pairs that a piece has already.
struct PairWork {
    /// Shape (body,).
    steps: Vec<u64>,
}

impl PairWork {
    /// Returns where to flush in between.
    fn pauses(&self) -> Vec<usize> {
        if self.steps.iter().sum::<u64>() < MANY_STEPS {
            return Vec::new();
        }
        let mut pauses = Vec::new();
        let mut since = 0;
        for (body, steps) in self.steps.iter().enumerate() {
            if since + steps > STEPS_PER_FLUSH && since > 0 {
                pauses.push(body);
                since = 0;
            }
            since += steps;
        }
        pauses
    }
}

fn refuse<T>(
    what: String,
    (found, most): (usize, usize),
    change: &'static str,
) -> Result<T, PhysicsError> {
    Err(PhysicsError::TooMany {
        what,
        found: found.to_string(),
        most,
        change,
    })
}

/// Returns whether a world can hold a house in the given state.
pub(crate) fn check(model: &PhysicsModel, state: &State) -> Result<PairLoad, PhysicsError> {
    let house = &model.house;
    let bodies = model.bodies.len();
    if bodies > MAX_BODIES {
        let what = format!("house {:?}: bodies that can move", house.name);
        let change = "Make some of its objects fixed, or leave some out.";
        return refuse(what, (bodies, MAX_BODIES), change);
    }
    let pieces = model.static_pieces.len()
        + model
            .bodies
            .iter()
            .map(|plan| plan.pieces.len())
            .sum::<usize>();
    if pieces > MAX_PIECES {
        let what = format!("house {:?}: collision pieces", house.name);
        let change = "Give its objects fewer pieces, or leave some out.";
        return refuse(what, (pieces, MAX_PIECES), change);
    }
    // Fewer pieces have no more pairs.
    if pieces * pieces.saturating_sub(1) / 2 <= MANY_PAIRS {
        return Ok(PairLoad::LOW);
    }
    let (near, work) = broad_phase_pairs(model, state)?;
    Ok(PairLoad {
        density: if near > MANY_PAIRS {
            PairDensity::High
        } else {
            PairDensity::Low
        },
        pauses: work.pauses(),
    })
}

/// Returns whether joints that act on each other are few enough.
pub(crate) fn check_trees(
    house: &House,
    joints: &[PhysicsJoint],
    trees: &[KinematicTree],
) -> Result<(), PhysicsError> {
    let Some(tree) = trees.iter().max_by_key(|tree| tree.joints.len()) else {
        return Ok(());
    };
    let count = tree.joints.len();
    if count <= MAX_TREE_JOINTS {
        return Ok(());
    }
    let first = &house.joints[joints[tree.joints[0]].id];
    let what = format!(
        "object {:?}: joints that act on each other, from {:?} on",
        house.objects[first.object].name, first.name
    );
    let change = "Leave some out, or fix some of its parts to each other.";
    refuse(what, (count, MAX_TREE_JOINTS), change)
}

/// Returns whether an object's excluded pairs, with those before it, are few enough.
pub(crate) fn check_excluded_pairs(
    house: &House,
    object: ObjectId,
    pairs: usize,
) -> Result<(), PhysicsError> {
    if pairs <= MAX_EXCLUDED_PAIRS {
        return Ok(());
    }
    let what = format!(
        "object {:?}: pairs of a part on a joint and a collision piece that pass through each other, with those before",
        house.objects[object].name
    );
    let change = "Make several objects of it, or give it fewer joints or pieces.";
    refuse(what, (pairs, MAX_EXCLUDED_PAIRS), change)
}

/// Returns the number of pairs that rapier keeps as a world begins, and the work of adding them.
fn broad_phase_pairs(
    model: &PhysicsModel,
    state: &State,
) -> Result<(usize, PairWork), PhysicsError> {
    /// The owner of all static pieces.
    const STATIC_OWNER: u32 = u32::MAX;
    let mut boxes: Vec<Aabb> = Vec::new();
    let mut owners: Vec<u32> = Vec::new();
    let mut add = |owner: u32, bounds: dwell_scene::Aabb| {
        boxes.push(Aabb::new(bounds.min, bounds.max).loosened(REACH_M));
        owners.push(owner);
    };
    let statics = |add: &mut dyn FnMut(u32, dwell_scene::Aabb)| {
        for piece in &model.static_pieces {
            add(STATIC_OWNER, shapes::bounds(&piece.shape, &piece.pose));
        }
    };
    // In the order in which they are inserted.
    let statics_last = model.inserts_statics_last();
    if !statics_last {
        statics(&mut add);
    }
    for (index, plan) in model.bodies.iter().enumerate() {
        let place = to_rapier(&state.part_pose[plan.root()]);
        for piece in &plan.pieces {
            add(
                index as u32,
                shapes::bounds(&piece.shape, &(place * piece.pose)),
            );
        }
    }
    if statics_last {
        statics(&mut add);
    }
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    let (mut met, mut near) = (0, 0);
    let mut steps = vec![0; model.bodies.len()];
    for (first, bounds) in boxes.iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let mut found = 0_u64;
        for second in tree.intersect_aabb(bounds) {
            // Each pair once.
            if second as usize <= first {
                continue;
            }
            met += 1;
            let other = owners[second as usize];
            if owners[first] != other {
                near += 1;
                found += 1;
                // Pairs with static pieces that are inserted last are added behind all portions.
                if other != STATIC_OWNER {
                    steps[other as usize] += found;
                }
            }
            let (what, most) = if near > MAX_NEAR_PAIRS {
                ("pairs of collision pieces near each other", MAX_NEAR_PAIRS)
            } else if met > MAX_OVERLAPPING_BOX_PAIRS {
                (
                    "pairs of collision pieces whose boxes meet",
                    MAX_OVERLAPPING_BOX_PAIRS,
                )
            } else {
                continue;
            };
            return Err(PhysicsError::TooMany {
                what: format!("house {:?}: {what}", model.house.name),
                found: format!("more than {most}"),
                most,
                change: "Spread its things, or let fewer of them stand in each other.",
            });
        }
    }
    Ok((near, PairWork { steps }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{
        Category, Id, LevelId, MaterialId, Mesh, Mobility, Object, Part, PartId, Pose,
        ShoeboxMaterials,
    };
    use glam::{Affine3A, Vec3};
    use std::sync::Arc;

    /// A room with boxes at one place, or `apart_m` from each other.
    fn boxes(count: usize, apart_m: f32) -> (PhysicsModel, State) {
        let room = House::shoebox([4.0, 3.0, 4.0], &ShoeboxMaterials::default()).unwrap();
        let mut data = room.data().clone();
        let half = Vec3::splat(0.1);
        let mesh = data.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
        for k in 0..count {
            data.parts.push(Part {
                object: ObjectId::from_index(k),
                name: "body".into(),
                fixed: false,
                world_from_part: Pose::from_position(Vec3::new(k as f32 * apart_m, 1.0, 2.0)),
                mesh,
                part_from_mesh: Affine3A::IDENTITY,
                materials: vec![MaterialId(0)],
                colliders: vec![dwell_scene::Collider::Cuboid {
                    part_from_box: Pose::IDENTITY,
                    half_extents: half,
                }],
                mass_kg: None,
                density_kg_m3: 500.0,
                inertial: None,
            });
            data.objects.push(Object {
                name: format!("box_{k}"),
                source_id: String::new(),
                model: String::new(),
                category: Category::default(),
                level: LevelId(0),
                room: None,
                mobility: Mobility::Movable,
                pickable: true,
                switch: None,
                first_part: PartId::from_index(k),
                part_count: 1,
            });
        }
        let model = PhysicsModel::new(Arc::new(House::new(data).unwrap()));
        let state = State::new(&model.house);
        (model, state)
    }

    /// The same in a room with a door that comes first.
    fn behind_a_door(model: &PhysicsModel) -> (PhysicsModel, State) {
        let mut data = model.house.data().clone();
        let part = &mut data.parts[PartId(0)];
        part.world_from_part = Pose::from_position(Vec3::new(1.0, 1.0, 1.0));
        let (name, kind) = ("hinge", dwell_scene::JointKind::Hinge);
        let joint = dwell_scene::Joint::new(name, ObjectId(0), PartId(0), kind, Vec3::Y);
        data.joints.push(joint);
        data.objects[ObjectId(0)].mobility = Mobility::Articulated;
        let model = PhysicsModel::new(Arc::new(House::new(data).unwrap()));
        let state = State::new(&model.house);
        (model, state)
    }

    /// rapier looks through all pairs of a piece for each that it adds, and asks nobody meanwhile.
    #[test]
    fn a_heap_is_inserted_in_portions_of_bounded_work() {
        let (model, state) = boxes(400, 0.0);
        assert_portions_are_bounded(&model, &state);
        let (model, state) = behind_a_door(&boxes(401, 0.0).0);
        assert!(model.bodies[0].joint.is_some());
        assert_portions_are_bounded(&model, &state);
        // As many that hardly touch are inserted at once.
        let (model, state) = boxes(400, 0.15);
        assert_eq!(check(&model, &state).unwrap(), PairLoad::LOW);
    }

    fn assert_portions_are_bounded(model: &PhysicsModel, state: &State) {
        let (near, work) = broad_phase_pairs(model, state).unwrap();
        assert!(near >= 400 * 399 / 2, "{near}");
        let pauses = check(model, state).unwrap().pauses;
        let ends = pauses.iter().copied().chain([model.bodies.len()]);
        let starts = std::iter::once(0).chain(pauses.iter().copied());
        let largest = *work.steps.iter().max().unwrap();
        for (start, end) in starts.zip(ends) {
            let steps: u64 = work.steps[start..end].iter().sum();
            assert!(
                steps <= STEPS_PER_FLUSH.max(largest),
                "{start}..{end}: {steps}"
            );
        }
        assert!((5..20).contains(&pauses.len()), "{pauses:?}");
    }

    /// rapier looks through the pairs of the piece that was inserted first, which would be the floor for each thing on it.
    #[test]
    fn many_things_on_one_floor_are_not_compared_with_each_other() {
        let on_floor = |count: usize| {
            let mut data = boxes(1, 0.0).0.house.data().clone();
            let part = data.parts[PartId(0)].clone();
            let object = data.objects[ObjectId(0)].clone();
            let half = Vec3::new(2000.0, 0.1, 2000.0);
            let mesh = data.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
            data.parts[PartId(0)] = Part {
                fixed: true,
                world_from_part: Pose::from_position(Vec3::new(0.0, -0.1, 0.0)),
                mesh,
                colliders: vec![dwell_scene::Collider::Cuboid {
                    part_from_box: Pose::IDENTITY,
                    half_extents: half,
                }],
                ..part.clone()
            };
            data.objects[ObjectId(0)].mobility = Mobility::Fixed;
            for k in 1..=count {
                let (x, z) = ((k % 100) as f32, (k / 100) as f32);
                data.parts.push(Part {
                    object: ObjectId::from_index(k),
                    world_from_part: Pose::from_position(Vec3::new(x, 0.1, z)),
                    ..part.clone()
                });
                data.objects.push(Object {
                    name: format!("thing_{k}"),
                    first_part: PartId::from_index(k),
                    ..object.clone()
                });
            }
            let model = PhysicsModel::new(Arc::new(House::new(data).unwrap()));
            let state = State::new(&model.house);
            let (near, work) = broad_phase_pairs(&model, &state).unwrap();
            assert!(near >= count, "{near}");
            work.steps.iter().sum::<u64>()
        };
        let (few, many) = (on_floor(5_000), on_floor(10_000));
        assert!(few >= 5_000 * 4_999 / 2, "{few}");
        assert!(many < 100_000, "{many}");
    }

    /// The page's table gives every cap of this file.
    #[test]
    fn the_page_states_the_caps() {
        let page = include_str!("../../docs/hostile-input.md");
        let here = include_str!("limits.rs");
        let caps = [
            ("MAX_BODIES", MAX_BODIES),
            ("MAX_PIECES", MAX_PIECES),
            ("MAX_TREE_JOINTS", MAX_TREE_JOINTS),
            ("MAX_NEAR_PAIRS", MAX_NEAR_PAIRS),
            ("MAX_OVERLAPPING_BOX_PAIRS", MAX_OVERLAPPING_BOX_PAIRS),
            ("MAX_EXCLUDED_PAIRS", MAX_EXCLUDED_PAIRS),
        ];
        for (name, value) in caps {
            let row = format!("| `{name}` | {value} |");
            assert!(page.contains(&row), "{row}");
        }
        // One match is this line's own.
        let constants = here.matches("pub(crate) const MAX_").count() - 1;
        assert_eq!(constants, caps.len(), "a cap that the page does not state");
    }
}
