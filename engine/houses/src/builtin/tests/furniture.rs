//! Nothing interpenetrates, nothing floats, everything opens.

use super::support::{apartment, building_boxes};
use dwell_furniture::testing::overlap::{
    ConvexPiece, max_depth, object_pieces, part_pieces, penetration_depth,
};
use dwell_scene::{Aabb, House, Mobility, ObjectId};
use glam::Vec3;

/// Largest penetration that is no fault, m.
const TOLERANCE_M: f32 = 0.002;

fn shell(house: &House) -> Vec<ConvexPiece> {
    building_boxes(house)
        .iter()
        .map(ConvexPiece::cuboid)
        .collect()
}

fn around(pieces: &[ConvexPiece]) -> Aabb {
    pieces
        .iter()
        .fold(Aabb::EMPTY, |bounds, piece| bounds.union(&piece.bounds))
}

fn all(house: &House) -> Vec<(ObjectId, Vec<ConvexPiece>)> {
    house
        .objects
        .ids()
        .map(|id| (id, object_pieces(house, id)))
        .collect()
}

#[test]
fn nothing_reaches_into_anything_else() {
    let house = apartment();
    let (objects, shell) = (all(house), shell(house));
    let mut faults = Vec::new();
    for (k, (id, pieces)) in objects.iter().enumerate() {
        let name = &house.objects[*id].name;
        let into = max_depth(pieces, &shell, TOLERANCE_M);
        if into > TOLERANCE_M {
            faults.push(format!(
                "{name} reaches {:.1} mm into the building",
                into * 1e3
            ));
        }
        let near = around(pieces);
        for (other, others) in &objects[k + 1..] {
            if !near.intersects(&around(others)) {
                continue;
            }
            let into = max_depth(pieces, others, TOLERANCE_M);
            if into > TOLERANCE_M {
                faults.push(format!(
                    "{name} reaches {:.1} mm into {}",
                    into * 1e3,
                    house.objects[*other].name
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Each object that does not stand firm touches something within 1.5 mm below, with its centre of mass above its support, or leans.
#[test]
fn nothing_floats() {
    const DROP_M: f32 = 0.0015;
    let house = apartment();
    let (objects, shell) = (all(house), shell(house));
    let mut faults = Vec::new();
    for (id, pieces) in &objects {
        let object = &house.objects[*id];
        let fixed = object.mobility != Mobility::Movable;
        // Things on walls may keep 5 mm off.
        let reach = if fixed { 0.005 } else { DROP_M };
        let lowered: Vec<ConvexPiece> = pieces
            .iter()
            .map(|piece| piece.moved(Vec3::NEG_Y * DROP_M))
            .collect();
        let seekers = if fixed { pieces } else { &lowered };
        let threshold = if fixed { -reach } else { 0.0 };
        let near = around(pieces).grown(0.01);
        let mut stand = Aabb::EMPTY;
        let mut leans = false;
        let others = objects
            .iter()
            .filter(|(other, _)| other != id)
            .map(|(_, pieces)| pieces.as_slice());
        for others in others.chain([shell.as_slice()]) {
            for other in others.iter().filter(|piece| near.intersects(&piece.bounds)) {
                for (piece, still) in seekers.iter().zip(pieces) {
                    if penetration_depth(piece, other, threshold) <= threshold {
                        continue;
                    }
                    // The piece below holds it; a piece beside it is leant against.
                    if other.bounds.max.y > still.bounds.min.y + 0.03
                        && other.bounds.min.y > still.bounds.min.y
                    {
                        leans = true;
                        continue;
                    }
                    let (a, b) = (
                        still.bounds.grown(if fixed { reach } else { 0.0 }),
                        other.bounds,
                    );
                    stand = stand.union(&Aabb {
                        min: a.min.max(b.min).with_y(0.0),
                        max: a.max.min(b.max).with_y(0.0),
                    });
                }
            }
        }
        if stand.is_empty() && !(fixed && leans) {
            faults.push(format!(
                "{} at {} floats",
                object.name,
                around(pieces).center()
            ));
            continue;
        }
        let (mut mass, mut moment) = (0.0, Vec3::ZERO);
        for piece in pieces {
            mass += piece.bounds.volume();
            moment += piece.bounds.center() * piece.bounds.volume();
        }
        let center = (moment / mass).with_y(0.0);
        let wall_hung = fixed;
        if !wall_hung && !leans && !stand.grown(0.002).contains(center) {
            faults.push(format!(
                "{} would tip over: {center} beyond {stand:?}",
                object.name
            ));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Every door, drawer and lid goes from closed to open without reaching into anything but its own object and what lies in it.
#[test]
fn everything_opens() {
    const STEPS: usize = 8;
    let house = apartment();
    let (objects, shell) = (all(house), shell(house));
    let mut faults = Vec::new();
    for joint in &house.joints {
        let parent = joint.parent.expect("built-in joints hang on a part");
        let world = house.parts[parent].world_from_part;
        // What lies in a drawer goes with it.
        let mut spaces = Vec::new();
        for space in house
            .receptacles
            .iter()
            .filter(|space| space.part == joint.child)
        {
            let place = house.parts[space.part].world_from_part.to_affine();
            spaces.push(space.space_in_part.transformed(&place).grown(0.01));
        }
        let rides = |pieces: &[ConvexPiece]| {
            let middle = around(pieces).center();
            spaces.iter().any(|space| space.contains(middle))
        };
        for step in 0..=STEPS {
            let open = step as f32 / STEPS as f32;
            let pose = joint.world_from_child(&world, joint.position_at(open));
            let pieces = part_pieces(house, joint.child, &pose);
            let near = around(&pieces);
            let others = objects
                .iter()
                .filter(|(id, others)| *id != joint.object && near.intersects(&around(others)))
                .filter(|(_, others)| !rides(others));
            let building = ("the building".to_owned(), &shell);
            for (name, others) in others
                .map(|(id, o)| (house.objects[*id].name.clone(), o))
                .chain([building])
            {
                let into = max_depth(&pieces, others, TOLERANCE_M);
                if into > TOLERANCE_M {
                    let owner = &house.objects[joint.object].name;
                    faults.push(format!(
                        "{owner} {} at {open:.2} reaches {:.1} mm into {name}",
                        joint.name,
                        into * 1e3
                    ));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
