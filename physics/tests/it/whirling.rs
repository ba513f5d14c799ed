//! Links that whirl about their ends, where rapier alone would brake them.

use crate::arms::awake;
use crate::common::{Build, Piece, Run};
use dwell_physics::{JointState, PhysicsConfig};
use dwell_scene::{Collider, Joint, JointId, JointKind, Mobility, PartId, Pose};
use glam::Vec3;

const LENGTH: f64 = 0.6;
const HALF: f64 = 0.3;
const WIDTH: f64 = 0.1;

/// Bars of 0.6 m, one on the other's end, that turn without friction or weight about the world's Z axis; the first about its end
/// on the wall.
fn bars(count: usize, rate_hz: f32) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let at = Vec3::new(2.0, 2.0, 2.0);
    let half = 0.5 * WIDTH as f32;
    let (from, to) = (
        Vec3::new(0.0, -half, -half),
        Vec3::new(LENGTH as f32, half, half),
    );
    let bar = |k: usize| Piece {
        collider: Collider::cuboid(from, to),
        ..Piece::cuboid(Vec3::ONE, at + Vec3::X * (LENGTH as f32 * k as f32))
    };
    let pieces: Vec<Piece> = (0..count).map(bar).collect();
    let object = build.object("chain", Mobility::Articulated, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    for (k, part) in parts.iter().enumerate() {
        let place = if k == 0 { at } else { Vec3::X * LENGTH as f32 };
        build.data.joints.push(Joint {
            parent: k.checked_sub(1).map(|before| parts[before]),
            parent_from_joint: Pose::from_position(place),
            ..Joint::new(&format!("j{k}"), object, *part, JointKind::Hinge, Vec3::Z)
        });
    }
    let mut run = build.run_with(PhysicsConfig {
        physics_rate_hz: rate_hz,
        ..awake()
    });
    let weightless = "world/gravity_m_s2".parse().unwrap();
    let house = run.house.clone();
    run.state.set_parameter(&house, &weightless, 0.0).unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
    run
}

fn spin(run: &mut Run, states: &[(f32, f32)]) {
    let set = |(k, (position, velocity)): (usize, &(f32, f32))| JointState {
        joint: JointId(k as u32),
        position: *position,
        velocity: *velocity,
    };
    let joints: Vec<JointState> = states.iter().enumerate().map(set).collect();
    run.world.set_joints(&mut run.state, &joints).unwrap();
}

/// A bar with its centre of mass 0.3 m from its axis turns on and on.
#[test]
fn a_bar_about_its_end_keeps_its_speed() {
    for rate_hz in [60.0, 120.0, 240.0] {
        for speed in [5.0_f32, -20.0, 100.0, 300.0, 1000.0] {
            let mut run = bars(1, rate_hz);
            spin(&mut run, &[(0.2, speed)]);
            run.steps(40);
            let now = run.state.joint_velocity[JointId(0)];
            let way = f64::from(run.state.joint_position[JointId(0)]) - 0.2;
            let way = way / (2.0 * f64::from(speed));
            println!("{rate_hz} Hz, {speed} rad/s: {now} after 2 s, {way} of the way");
            assert!((now / speed - 1.0).abs() < 1e-3, "{rate_hz} {speed}: {now}");
            assert!((way - 1.0).abs() < 1e-3, "{rate_hz} {speed}: {way}");
        }
    }
}

/// Energy, and angular momentum about the wall, of two bars for each kilogram of one, by hand.
fn kept(run: &Run) -> [f64; 2] {
    let own = (LENGTH * LENGTH + WIDTH * WIDTH) / 12.0;
    let at = |k: u32| f64::from(run.state.joint_position[JointId(k)]);
    let speed = |k: u32| f64::from(run.state.joint_velocity[JointId(k)]);
    let (first, second) = (speed(0), speed(0) + speed(1));
    let bend = at(1).cos();
    // The second one's centre of mass.
    let square = (LENGTH * first).powi(2)
        + (HALF * second).powi(2)
        + 2.0 * LENGTH * HALF * first * second * bend;
    let energy =
        0.5 * (own + HALF * HALF) * first * first + 0.5 * square + 0.5 * own * second * second;
    let momentum = (own + HALF * HALF) * first
        + own * second
        + LENGTH * LENGTH * first
        + HALF * HALF * second
        + LENGTH * HALF * bend * (first + second);
    [energy, momentum]
}

/// Without weight and friction two bars keep energy and angular momentum about the wall.
#[test]
fn two_bars_that_whirl_keep_energy_and_angular_momentum() {
    for rate_hz in [60.0, 120.0, 240.0] {
        for speeds in [[5.0_f32, 3.0], [20.0, 10.0], [40.0, 20.0], [80.0, -40.0]] {
            let mut run = bars(2, rate_hz);
            spin(&mut run, &[(0.0, speeds[0]), (0.7, speeds[1])]);
            let start = kept(&run);
            let mut worst = [0.0_f64; 2];
            for _ in 0..40 {
                run.steps(1);
                let now = kept(&run);
                for k in 0..2 {
                    worst[k] = worst[k].max((now[k] / start[k] - 1.0).abs());
                }
            }
            println!("{rate_hz} Hz, {speeds:?}: energy, momentum off by {worst:?}");
            assert!(
                worst[0] < 0.02 && worst[1] < 0.02,
                "{rate_hz} {speeds:?}: {worst:?}"
            );
        }
    }
}
