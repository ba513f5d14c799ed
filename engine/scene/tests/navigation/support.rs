//! Rooms with boxes, doors and stairs.

use dwell_scene::navigation::{NavCell, NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{
    Aabb, Category, Collider, House, HouseData, Joint, JointKind, Level, LevelId, MaterialId, Mesh,
    Mobility, Object, ObjectId, Part, PartId, Pose, ShoeboxMaterials, State, Structure,
    StructureKind,
};
use glam::{Affine3A, Vec2, Vec3};
use std::sync::Arc;

pub(crate) const ROOM: [f32; 3] = [5.0, 2.6, 4.0];

/// An empty room.
pub(crate) fn room() -> HouseData {
    let room = House::shoebox(ROOM, &ShoeboxMaterials::default()).expect("a valid room");
    room.data().clone()
}

pub(crate) fn add_mesh(data: &mut HouseData, kind: StructureKind, mesh: Mesh) {
    let mesh = data.meshes.push(Arc::new(mesh));
    data.structure.push(Structure {
        name: format!("piece {}", data.structure.len()),
        kind,
        room: None,
        level: LevelId(0),
        mesh,
        materials: vec![MaterialId(0)],
    });
}

/// A box that never moves.
pub(crate) fn add_box(data: &mut HouseData, kind: StructureKind, [min, max]: [Vec3; 2]) {
    add_mesh(data, kind, Mesh::cuboid(min, max));
}

/// A thing of one part that moves: a box around its own origin.
fn add_thing(data: &mut HouseData, mobility: Mobility, half: Vec3, world_from_part: Pose) {
    let mesh = data.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
    let (object, part) = (
        ObjectId(data.objects.len() as u32),
        PartId(data.parts.len() as u32),
    );
    data.objects.push(Object {
        name: format!("thing {}", object.0),
        source_id: String::new(),
        model: String::new(),
        category: Category::default(),
        level: LevelId(0),
        room: None,
        mobility,
        pickable: false,
        switch: None,
        first_part: part,
        part_count: 1,
    });
    data.parts.push(Part {
        object,
        name: "body".into(),
        fixed: false,
        world_from_part,
        mesh,
        part_from_mesh: Affine3A::IDENTITY,
        materials: vec![MaterialId(0)],
        colliders: vec![Collider::Cuboid {
            part_from_box: Pose::IDENTITY,
            half_extents: half,
        }],
        mass_kg: None,
        density_kg_m3: 300.0,
        inertial: None,
    });
}

/// A box that can be moved.
pub(crate) fn add_movable(data: &mut HouseData, [min, max]: [Vec3; 2]) {
    let pose = Pose::from_position((min + max) * 0.5);
    add_thing(data, Mobility::Movable, (max - min) * 0.5, pose);
}

/// A wall across the room at x = 2.5 with an opening from z = 1.5 to 2.5, and a door leaf in it that is shut at 0 and opens
/// towards +x to 90 degrees about a hinge at z = 1.5.
pub(crate) fn room_with_door() -> HouseData {
    let mut data = room();
    let wall = |low: f32, high: f32| [Vec3::new(2.45, 0.0, low), Vec3::new(2.55, 2.6, high)];
    add_box(&mut data, StructureKind::Wall, wall(0.0, 1.5));
    add_box(&mut data, StructureKind::Wall, wall(2.5, 4.0));
    let shut = Pose::from_position(Vec3::new(2.5, 1.0, 2.0));
    add_thing(
        &mut data,
        Mobility::Articulated,
        Vec3::new(0.02, 0.98, 0.48),
        shut,
    );
    data.joints.push(Joint {
        name: "hinge".into(),
        object: ObjectId(0),
        parent: None,
        child: PartId(0),
        kind: JointKind::Hinge,
        axis: Vec3::Y,
        parent_from_joint: Pose::from_position(Vec3::new(2.5, 1.0, 1.5)),
        child_from_joint: Pose::from_position(Vec3::new(0.0, 0.0, -0.5)),
        limits: Some([0.0, std::f32::consts::FRAC_PI_2]),
        closed: 0.0,
        open: std::f32::consts::FRAC_PI_2,
        initial: 0.0,
        friction: 0.0,
        damping: 0.0,
        servo: None,
        armature: 0.0,
        mimic: None,
        toggles_switch: false,
    });
    data
}

/// Opens the door of [`room_with_door`] so far.
pub(crate) fn open_door(house: &House, state: &mut State, openness: f32) {
    let id = dwell_scene::JointId(0);
    let joint = &house.joints[id];
    state.joint_position[id] = joint.position_at(openness);
    state.part_pose[joint.child] =
        joint.world_from_child(&Pose::IDENTITY, state.joint_position[id]);
}

pub(crate) fn house(data: HouseData) -> Arc<House> {
    Arc::new(House::new(data).expect("a valid house"))
}

/// A room with boxes from one corner to the other.
pub(crate) fn furnished(boxes: &[[Vec3; 2]]) -> Arc<House> {
    let mut data = room();
    for corners in boxes {
        add_box(&mut data, StructureKind::Other, *corners);
    }
    house(data)
}

pub(crate) fn grid_of(house: &House, config: &NavConfig) -> NavGrid {
    NavGrid::build(house, &State::new(house), config).expect("valid settings")
}

/// Two floors, 5 by 8 m, the upper one 2.88 m above the lower; `stairs`: 16 steps of 0.18 m by 0.28 m, 1 m wide, under a
/// hole in the upper floor, with a wall beside them.
pub(crate) fn two_storeys(stairs: bool) -> Arc<House> {
    let mut data = room();
    data.structure = std::iter::empty().collect();
    let (low, high) = (Vec3::ZERO, Vec3::new(5.0, 5.6, 8.0));
    data.levels[LevelId(0)].bounds = Aabb::new(low, high.with_y(2.7));
    data.levels.push(Level {
        name: "upper".into(),
        bounds: Aabb::new(low.with_y(2.7), high),
    });
    let slab = |x0: f32, x1: f32, z0: f32, z1: f32, top: f32| {
        [Vec3::new(x0, top - 0.1, z0), Vec3::new(x1, top, z1)]
    };
    add_box(
        &mut data,
        StructureKind::Floor,
        slab(0.0, 5.0, 0.0, 8.0, 0.0),
    );
    // The hole is 1.2 m wide and as long as the stairs, up to z = 6.48.
    for [x0, x1, z0, z1] in [
        [1.2, 5.0, 0.0, 8.0],
        [0.0, 1.2, 0.0, 2.0],
        [0.0, 1.2, 6.48, 8.0],
    ] {
        add_box(&mut data, StructureKind::Floor, slab(x0, x1, z0, z1, 2.88));
    }
    // Beside hole and stairs, up through both storeys.
    let wall = [Vec3::new(1.15, 0.0, 2.0), Vec3::new(1.25, 5.0, 6.48)];
    add_box(&mut data, StructureKind::Wall, wall);
    if stairs {
        for k in 0..16 {
            let z = 2.0 + 0.28 * k as f32;
            let top = 0.18 * (k + 1) as f32;
            let step = [Vec3::new(0.1, top - 0.18, z), Vec3::new(1.1, top, z + 0.28)];
            add_box(&mut data, StructureKind::Other, step);
        }
    }
    house(data)
}

/// Up to seven boxes on the floor, some of them in the way, some low, some hanging.
pub(crate) fn scattered(key: RandomKey) -> Vec<[Vec3; 2]> {
    let mut stream = key.stream();
    let count = stream.below(8);
    let one = |_| {
        let corner = Vec3::new(stream.range(0.2, 4.2), 0.0, stream.range(0.2, 3.2));
        let size = Vec3::new(
            stream.range(0.05, 1.5),
            stream.range(0.3, 2.0),
            stream.range(0.05, 1.5),
        );
        let base = if stream.below(4) == 0 {
            stream.range(0.3, 1.2)
        } else {
            0.0
        };
        let min = corner + Vec3::Y * base;
        let max = (min + size).min(Vec3::new(4.99, 2.59, 3.99));
        [min, max]
    };
    (0..count).map(one).collect()
}

/// Distance from a point on the floor plan to the nearest wall or box.
pub(crate) fn clearance(p: Vec2, boxes: &[[Vec3; 2]]) -> f32 {
    let walls = p.x.min(ROOM[0] - p.x).min(p.y).min(ROOM[2] - p.y);
    let to_box = |[min, max]: &[Vec3; 2]| {
        let nearest = p.clamp(Vec2::new(min.x, min.z), Vec2::new(max.x, max.z));
        nearest.distance(p)
    };
    boxes.iter().map(to_box).fold(walls, f32::min)
}

pub(crate) fn length_m(grid: &NavGrid, cells: &[NavCell]) -> f64 {
    let piece = |w: &[NavCell]| f64::from(grid.position(w[0]).distance(grid.position(w[1])));
    cells.windows(2).map(piece).sum()
}

/// Asserts that two grids agree bit for bit: places, islands, and paths from every island's first cell.
pub(crate) fn assert_same(a: &NavGrid, b: &NavGrid) {
    let places = |grid: &NavGrid| -> Vec<(NavCell, [u32; 3], Option<u32>)> {
        let place = |cell: NavCell| {
            let p = grid.position(cell).to_array().map(f32::to_bits);
            (cell, p, grid.island(cell))
        };
        grid.walkable().map(place).collect()
    };
    assert_eq!(places(a), places(b));
    assert_eq!(a.len(), b.len());
    assert_eq!(a.doors(), b.doors());
    let mut goals: Vec<NavCell> = Vec::new();
    for cell in a.walkable() {
        if goals.iter().all(|goal| a.island(*goal) != a.island(cell)) {
            goals.push(cell);
        }
    }
    let (x, y) = (a.distance_field(&goals), b.distance_field(&goals));
    for cell in a.walkable() {
        assert_eq!(x.at(cell).map(f64::to_bits), y.at(cell).map(f64::to_bits));
    }
}
