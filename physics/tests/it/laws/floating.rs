//! Laws of air on robots that stand free: root and links are pushed at once.
//!
//! The root was once pushed beside the course of its joints, and the links within it: joints of a robot in even wind moved by half
//! a millimetre, and at a stop by centimetres.

use super::spec;
use crate::common::{Build, Piece, Run};
use dwell_physics::{JointState, PhysicsConfig};
use dwell_scene::{Collider, Joint, JointId, JointKind, LawSpec, Mobility, PartId, Pose, State};
use glam::{DVec3, Vec3};

const AT: Vec3 = Vec3::new(3.0, 3.0, 3.0);
const AIR: f64 = 1.204;

/// A body that floats without weight, with a bar on a hinge and, on that, a cube on a slide. Every origin but the bar's is its
/// middle.
fn robot(laws: Vec<LawSpec>, limits: Option<[f32; 2]>, rate_hz: f32) -> Run {
    let mut build = Build::room([40.0, 6.0, 6.0]);
    let bar = Piece {
        collider: Collider::cuboid(Vec3::new(0.0, -0.03, -0.03), Vec3::new(0.5, 0.03, 0.03)),
        ..Piece::cuboid(Vec3::ONE, AT + Vec3::X * 0.2)
    };
    let pieces = [
        Piece::cuboid(Vec3::splat(0.1), AT),
        bar,
        Piece::cuboid(Vec3::splat(0.05), AT + Vec3::new(0.5, 0.2, 0.0)),
    ];
    let object = build.object("robot", Mobility::Movable, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    build.data.joints.push(Joint {
        parent: Some(parts[0]),
        parent_from_joint: Pose::from_position(Vec3::X * 0.2),
        limits,
        ..Joint::new("hinge", object, parts[1], JointKind::Hinge, Vec3::Z)
    });
    build.data.joints.push(Joint {
        parent: Some(parts[1]),
        parent_from_joint: Pose::from_position(Vec3::new(0.3, 0.2, 0.0)),
        limits,
        ..Joint::new("slide", object, parts[2], JointKind::Slide, Vec3::X)
    });
    let house = build.house();
    let mut state = State::new(&house);
    let weightless = "world/gravity_m_s2".parse().unwrap();
    state.set_parameter(&house, &weightless, 0.0).unwrap();
    state.laws = laws;
    let config = PhysicsConfig {
        sleeping: false,
        control_rate_hz: rate_hz,
        ..PhysicsConfig::default()
    };
    Run::from_state(house, config, state)
}

const MASSES: [f64; 3] = [500.0 * 0.008, 500.0 * 0.5 * 0.0036, 500.0 * 0.001];

/// Velocities of the three centres of mass, m/s.
fn velocities(run: &Run) -> [DVec3; 3] {
    let object = run.house.object_named("robot").unwrap();
    let mut parts = run.house.objects[object].parts();
    [Vec3::ZERO, Vec3::X * 0.25, Vec3::ZERO].map(|middle| {
        let part = parts.next().unwrap();
        let velocity = run.state.part_velocity[part];
        let arm = run.state.part_pose[part].transform_vector(middle);
        (velocity.linear + velocity.angular.cross(arm)).as_dvec3()
    })
}

fn momentum(run: &Run) -> DVec3 {
    let all = velocities(run).into_iter().zip(MASSES);
    all.map(|(velocity, mass)| velocity * mass).sum()
}

/// One law for each of the three, with a cross-section in proportion to its mass.
fn in_proportion(id: &str, numbers: &[(&str, f64)]) -> Vec<LawSpec> {
    let law = |(k, mass): (usize, &f64)| {
        let mut numbers = numbers.to_vec();
        numbers.push(("area_m2", 0.05 * mass));
        spec(id, Some(&format!("robot/part_{k}")), &numbers)
    };
    MASSES.iter().enumerate().map(law).collect()
}

/// Air that gives every body the same acceleration moves no joint, in mid-range and at stops, from any side; the robot goes as one
/// body would: `dv/dt = 1/2 rho A / m |u - v| (u - v)`.
#[test]
fn joints_stay_still_in_air_that_pushes_all_bodies_alike() {
    let wind = [
        ("x_m_s", 6.0),
        ("y_m_s", 0.5),
        ("z_m_s", -1.0),
        ("c_d", 1.0),
    ];
    let against = [
        ("x_m_s", -6.0),
        ("y_m_s", 0.5),
        ("z_m_s", -1.0),
        ("c_d", 1.0),
    ];
    let at_stops = Some([0.0, 0.3]);
    for limits in [None, at_stops] {
        for (id, numbers, start) in [
            ("wind", &wind[..], Vec3::ZERO),
            ("wind", &against[..], Vec3::ZERO),
            ("drag", &[("c_d", 1.0)][..], Vec3::new(1.4, 0.2, 0.3)),
        ] {
            let mut run = robot(in_proportion(id, numbers), limits, 20.0);
            let root = run.root(run.house.object_named("robot").unwrap());
            run.state.part_pose[root].position.x = if start.x > 0.0 { 0.5 } else { 20.0 };
            run.state.part_velocity[root].linear = start;
            run.world.adopt_state(&mut run.state).unwrap();
            let before = velocities(&run);
            assert!(
                before
                    .iter()
                    .all(|v| (*v - start.as_dvec3()).length() < 1e-5)
            );
            let from = [0, 1].map(|k| run.state.joint_position[JointId(k)]);
            let mut worst = [0.0_f32; 2];
            for _ in 0..40 {
                run.steps(1);
                for k in 0..2 {
                    let q = run.state.joint_position[JointId(k as u32)];
                    worst[k] = worst[k].max((q - from[k]).abs());
                }
            }
            let air = |name: &str| {
                numbers
                    .iter()
                    .find(|(n, _)| *n == name)
                    .map_or(0.0, |n| n.1)
            };
            let air = DVec3::new(air("x_m_s"), air("y_m_s"), air("z_m_s"));
            let off = start.as_dvec3() - air;
            let expected = air + off / (1.0 + 0.5 * AIR * 0.05 * off.length() * 2.0);
            let found = velocities(&run)[0];
            println!("{id} {limits:?}: joints {worst:?}, {found} of {expected}");
            assert!(
                (found - expected).length() < 1e-3 * off.length(),
                "{found} {expected}"
            );
            assert!(
                worst.iter().all(|worst| *worst < 1e-6),
                "{id} {limits:?}: {worst:?}"
            );
        }
    }
}

/// Air on some of the bodies only, while the joints move: the momentum of all changes by the impulse of the sum of forces.
#[test]
fn momentum_changes_by_the_impulse_of_the_forces() {
    let numbers = [
        ("x_m_s", 5.0),
        ("z_m_s", 2.0),
        ("c_d", 1.0),
        ("area_m2", 0.3),
    ];
    for blown in [0, 1, 2] {
        let target = format!("robot/part_{blown}");
        let laws = vec![spec("wind", Some(&target), &numbers)];
        let mut run = robot(laws, None, 120.0);
        let set = |joint, velocity| JointState {
            joint: JointId(joint),
            position: 0.0,
            velocity,
        };
        run.world
            .set_joints(&mut run.state, &[set(0, 2.0), set(1, -0.3)])
            .unwrap();
        let from = momentum(&run);
        let mut impulse = DVec3::ZERO;
        for _ in 0..120 {
            let before = velocities(&run)[blown];
            run.steps(1);
            let against = DVec3::new(5.0, 0.0, 2.0) - 0.5 * (before + velocities(&run)[blown]);
            impulse += 0.5 * AIR * 0.3 * against.length() * against / 120.0;
        }
        let found = momentum(&run) - from;
        println!("{target}: {found} of {impulse} N s");
        // Forces are those at the beginning of a step: a hundredth of what they change in a second.
        assert!(
            (found - impulse).length() < 1e-2 * impulse.length(),
            "{found} {impulse}"
        );
    }
}
