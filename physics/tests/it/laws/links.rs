//! Laws of bodies on what joints move, against closed forms and fine integration by hand.

use super::spec;
use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::{JointState, PhysicsConfig};
use dwell_scene::{Collider, Joint, JointId, JointKind, LawSpec, Mobility, PartId, Pose, State};
use glam::{DVec3, Vec3};

const PIVOT: Vec3 = Vec3::new(2.0, 2.0, 2.0);
const LENGTH: f32 = 0.6;
const HALF: f32 = 0.02;
const DENSITY: f32 = 500.0;

/// Mass of the bar, kg; distance of its centre from the pivot, m; inertia about its centre across it, kg m2.
fn bar() -> (f64, f64, f64) {
    let (length, width) = (f64::from(LENGTH), 2.0 * f64::from(HALF));
    let mass = f64::from(DENSITY) * length * width * width;
    (
        mass,
        0.5 * length,
        mass * (length * length + width * width) / 12.0,
    )
}

fn start(laws: Vec<LawSpec>, build: Build, config: PhysicsConfig) -> Run {
    let house = build.house();
    let mut state = State::new(&house);
    state.laws = laws;
    Run::from_state(house, config, state)
}

fn awake() -> PhysicsConfig {
    PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    }
}

/// A bar from the pivot along `along` that turns about `axis`.
fn pivoted(along: Vec3, axis: Vec3) -> Build {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let across = (Vec3::ONE - along.abs()) * HALF;
    let end = along * LENGTH;
    let piece = Piece {
        collider: Collider::cuboid(end.min(Vec3::ZERO) - across, end.max(Vec3::ZERO) + across),
        ..Piece::cuboid(Vec3::ONE, PIVOT).density(DENSITY)
    };
    let object = build.object("bar", Mobility::Articulated, &[piece]);
    let part = build.data.objects[object].first_part;
    build.data.joints.push(Joint {
        parent_from_joint: Pose::from_position(PIVOT),
        ..Joint::new("pivot", object, part, JointKind::Hinge, axis)
    });
    build
}

fn set(run: &mut Run, position: f32, velocity: f32) {
    let state = JointState {
        joint: JointId(0),
        position,
        velocity,
    };
    run.world.set_joints(&mut run.state, &[state]).unwrap();
}

/// The furthest that the joint is from what its equation of motion says at the end of each control step, rad.
fn off(run: &mut Run, steps: usize, acceleration: impl Fn(f64, f64) -> f64) -> f64 {
    let joint = JointId(0);
    let mut x = f64::from(run.state.joint_position[joint]);
    let mut v = f64::from(run.state.joint_velocity[joint]);
    let parts = 500;
    let h = 0.05 / f64::from(parts);
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        run.steps(1);
        for _ in 0..parts {
            let k1 = (v, acceleration(x, v));
            let k2 = (
                v + 0.5 * h * k1.1,
                acceleration(x + 0.5 * h * k1.0, v + 0.5 * h * k1.1),
            );
            let k3 = (
                v + 0.5 * h * k2.1,
                acceleration(x + 0.5 * h * k2.0, v + 0.5 * h * k2.1),
            );
            let k4 = (v + h * k3.1, acceleration(x + h * k3.0, v + h * k3.1));
            x += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
            v += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        }
        worst = worst.max((f64::from(run.state.joint_position[joint]) - x).abs());
    }
    worst
}

/// `I phi'' = -(c_l m d2 + c_a I_c) phi' - m g d sin(phi)`: the link of a pendulum in linear drag.
#[test]
fn a_pendulum_in_linear_drag_decays_as_its_equation_says() {
    let (mass, down, own) = bar();
    let inertia = own + mass * down * down;
    for (linear, angular) in [(0.8, 0.0), (0.0, 5.0), (6.0, 2.0)] {
        let law = spec(
            "viscous_damping",
            Some("bar"),
            &[("linear_per_s", linear), ("angular_per_s", angular)],
        );
        let mut run = start(vec![law], pivoted(Vec3::NEG_Y, Vec3::Z), awake());
        set(&mut run, 1.0, 0.0);
        let brake = linear * mass * down * down + angular * own;
        let g = f64::from(gravity());
        let worst = off(&mut run, 60, |x, v| {
            -(brake * v + mass * g * down * x.sin()) / inertia
        });
        println!("linear {linear} angular {angular}: {worst:.2e} rad");
        // The midpoint rule's phase over three seconds of a swing of 1 rad at 120 Hz.
        assert!(worst < 1.5e-3, "{linear} {angular}: {worst}");
    }
}

/// w(t) = w0 / (1 + k d3 w0 t / I): a bar that turns level in quadratic drag.
#[test]
fn a_turning_bar_in_quadratic_drag_slows_as_its_closed_form() {
    let (mass, out, own) = bar();
    let inertia = own + mass * out * out;
    let (c_d, area, air) = (1.0, 0.5, 1.204);
    let law = spec(
        "drag",
        Some("bar/part_0"),
        &[("c_d", c_d), ("area_m2", area)],
    );
    let mut run = start(vec![law], pivoted(Vec3::X, Vec3::Y), awake());
    set(&mut run, 0.0, 6.0);
    let gain = 0.5 * air * c_d * area * out.powi(3) / inertia;
    for k in 1..=40 {
        run.steps(1);
        let expected = 6.0 / (1.0 + gain * 6.0 * 0.05 * f64::from(k));
        let found = f64::from(run.state.joint_velocity[JointId(0)]);
        assert!(
            (found / expected - 1.0).abs() < 1e-3,
            "{k}: {found} {expected}"
        );
    }
}

/// A door in wind: the force of the wind at its centre, against its own motion, turns it into the wind's direction.
#[test]
fn a_door_in_wind_swings_into_it() {
    let (mass, out, own) = bar();
    let inertia = own + mass * out * out;
    let (speed, area) = (4.0, 0.3);
    let wind = [("x_m_s", speed), ("area_m2", area), ("c_d", 1.0)];
    let law = spec("wind", Some("bar"), &wind);
    let mut run = start(vec![law], pivoted(Vec3::X, Vec3::Y), awake());
    set(&mut run, 1.2, 0.0);
    let gain = 0.5 * 1.204 * area;
    let worst = off(&mut run, 80, |x, v| {
        let arm = DVec3::new(x.cos(), 0.0, -x.sin()) * out;
        let against = DVec3::X * speed - (DVec3::Y * v).cross(arm);
        arm.cross(against * against.length() * gain).y / inertia
    });
    println!("wind: {worst:.2e} rad");
    assert!(worst < 1e-3, "{worst}");
}

/// A gust wakes a door that sleeps, and pushes it open against its friction.
#[test]
fn a_gust_opens_a_door_that_sleeps() {
    let mut build = pivoted(Vec3::X, Vec3::Y);
    build.data.joints[JointId(0)].friction = 0.02;
    let gust = [("z_m_s", 4.0), ("area_m2", 0.3), ("period_s", 10.0)];
    let law = spec("wind", None, &gust);
    let mut run = start(vec![law], build, PhysicsConfig::default());
    run.steps(95);
    assert_eq!(run.world.awake_count(), 0);
    assert!(run.state.joint_position[JointId(0)].abs() < 1e-3);
    run.steps(40);
    let opened = run.state.joint_position[JointId(0)];
    assert!(opened < -0.3, "{opened}");
}

/// On a table that turns with w, lift across spin and way pulls a slider inwards with `gain` w2 r: at `gain` = m it takes
/// away all that drives the slider out, which without it goes as r0 cosh(w t).
#[test]
fn lift_on_a_slider_balances_what_drives_it_out() {
    let build = || {
        let mut build = Build::room([4.0, 4.0, 4.0]);
        let table = Piece::cuboid(Vec3::new(0.5, 0.02, 0.5), PIVOT).density(20_000.0);
        let slider = Piece::cuboid(Vec3::splat(0.03), PIVOT + Vec3::new(0.1, 0.3, 0.0));
        let object = build.object("table", Mobility::Articulated, &[table, slider]);
        let parts: Vec<PartId> = build.data.objects[object].parts().collect();
        build.data.joints.push(Joint {
            parent_from_joint: Pose::from_position(PIVOT),
            ..Joint::new("turn", object, parts[0], JointKind::Hinge, Vec3::Y)
        });
        build.data.joints.push(Joint {
            parent: Some(parts[0]),
            parent_from_joint: Pose::from_position(Vec3::new(0.1, 0.3, 0.0)),
            ..Joint::new("slide", object, parts[1], JointKind::Slide, Vec3::X)
        });
        build
    };
    let mass = f64::from(500.0_f32 * 0.06_f32.powi(3));
    let area = 0.2_f64;
    let c_l = mass / (0.5 * 1.204 * area * (area / std::f64::consts::PI).sqrt());
    let law = spec(
        "magnus",
        Some("table/part_1"),
        &[("c_l", c_l), ("area_m2", area)],
    );
    for (laws, driven) in [(vec![law], false), (Vec::new(), true)] {
        let mut run = start(laws, build(), awake());
        set(&mut run, 0.0, 2.0);
        run.steps(20);
        let out = f64::from(run.state.joint_position[JointId(1)]);
        let expected = if driven {
            0.1 * (2.0_f64.cosh() - 1.0)
        } else {
            0.0
        };
        // The slider brakes the heavy table a little.
        assert!((out - expected).abs() < 3e-3, "{out} {expected}");
    }
}

/// Mass, centre of mass and inertia of a link under laws: `T = 2 pi sqrt((I_c + m d2) / (w d))`, w the weight.
#[test]
fn laws_of_masses_change_the_period_of_a_link() {
    let (mass, down, own) = bar();
    let g = f64::from(gravity());
    let volume = mass / f64::from(DENSITY);
    for (law, inertia, moment) in [
        (
            spec("center_of_mass_offset", Some("bar"), &[("y_m", -0.2)]),
            own + mass * (down + 0.2).powi(2),
            mass * g * (down + 0.2),
        ),
        (
            spec("inertia_error", Some("bar"), &[("scale", 1.5)]),
            2.5 * own + mass * down * down,
            mass * g * down,
        ),
        (
            spec(
                "buoyancy",
                Some("bar"),
                &[("fluid_density_kg_m3", 200.0), ("added_mass", 0.5)],
            ),
            own + (mass + 100.0 * volume) * down * down,
            (mass - 200.0 * volume) * g * down,
        ),
    ] {
        let id = law.id.clone();
        let mut run = start(vec![law], pivoted(Vec3::NEG_Y, Vec3::Z), awake());
        set(&mut run, 0.3, 0.0);
        let worst = off(&mut run, 60, |x, _| -moment * x.sin() / inertia);
        println!("{id}: {worst:.2e} rad");
        assert!(worst < 1.5e-3, "{id}: {worst}");
    }
}

/// A robot that floats without weight: linear drag on all of its bodies takes the same share of its momentum in each second,
/// whatever its joints do meanwhile.
#[test]
fn drag_on_all_of_a_floating_robot_takes_its_share_of_momentum() {
    let mut build = Build::room([40.0, 40.0, 40.0]);
    let at = Vec3::splat(20.0);
    let base = Piece::cuboid(Vec3::splat(0.1), at);
    let link = Piece {
        collider: Collider::cuboid(Vec3::new(0.0, -0.03, -0.03), Vec3::new(0.5, 0.03, 0.03)),
        ..Piece::cuboid(Vec3::ONE, at + Vec3::X * 0.15)
    };
    let object = build.object("robot", Mobility::Movable, &[base, link]);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    build.data.joints.push(Joint {
        parent: Some(parts[0]),
        parent_from_joint: Pose::from_position(Vec3::X * 0.15),
        ..Joint::new("elbow", object, parts[1], JointKind::Hinge, Vec3::Z)
    });
    let house = build.house();
    let mut state = State::new(&house);
    let weightless = "world/gravity_m_s2".parse().unwrap();
    state.set_parameter(&house, &weightless, 0.0).unwrap();
    state.laws = vec![spec("viscous_damping", None, &[("linear_per_s", 0.7)])];
    let mut run = Run::from_state(house, awake(), state);
    run.state.part_velocity[parts[0]].linear = Vec3::new(1.0, 0.5, -0.3);
    run.state.joint_velocity[JointId(0)] = 3.0;
    run.world.adopt_state(&mut run.state).unwrap();
    let masses = [500.0 * 0.008, 500.0 * 0.5 * 0.0036];
    let momentum = |run: &Run| -> DVec3 {
        let middles = [Vec3::ZERO, Vec3::X * 0.25];
        let of = |k: usize| {
            let velocity = run.state.part_velocity[parts[k]];
            let arm = run.state.part_pose[parts[k]].transform_vector(middles[k]);
            (velocity.linear + velocity.angular.cross(arm)).as_dvec3() * masses[k]
        };
        of(0) + of(1)
    };
    let before = momentum(&run);
    for k in 1..=40 {
        run.steps(1);
        let expected = before * (-0.7 * 0.05 * f64::from(k)).exp();
        let off = (momentum(&run) - expected).length() / expected.length();
        assert!(off < 2e-3, "{k}: {off}");
    }
}

#[test]
fn what_a_law_of_bodies_cannot_reach_is_refused_with_the_reason() {
    let mut build = pivoted(Vec3::X, Vec3::Y);
    build.fixed(
        "shelf",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 0.5, 3.0)),
    );
    let house = build.house();
    for (target, parts) in [
        ("shelf", ["shelf", "no part of it moves"]),
        ("bar/wing", ["OBJECT/PART", "bar/wing"]),
        ("nothing", ["nothing", "\"bar\""]),
    ] {
        for (id, name) in [("drag", "c_d"), ("center_of_mass_offset", "x_m")] {
            let mut state = State::new(&house);
            state.laws = vec![spec(id, Some(target), &[(name, 0.1)])];
            let config = PhysicsConfig::default();
            let refused = dwell_physics::PhysicsWorld::new(house.clone(), config, &mut state);
            let message = refused.unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
    }
}

/// I phi'' = F, dF = -k dphi between the bounds: a bar that is pushed rings about where the spring has slipped to, and what a
/// law remembers of its springs goes with the snapshot.
#[test]
fn a_joint_with_hysteresis_springs_back_and_slips_as_the_model() {
    let (mass, out, own) = bar();
    let inertia = own + mass * out * out;
    let (stiffness, bound) = (4.0, 0.3);
    let law = spec(
        "joint_hysteresis",
        Some("pivot"),
        &[("stiffness", stiffness), ("max_effort", bound)],
    );
    let mut run = start(vec![law], pivoted(Vec3::X, Vec3::Y), awake());
    set(&mut run, 0.0, 2.0);
    let (mut x, mut v, mut effort) = (0.0_f64, 2.0_f64, 0.0_f64);
    let parts = 50_000;
    let h = 0.05 / f64::from(parts);
    let mut worst = 0.0_f64;
    let mut half_way = None;
    for step in 0..40 {
        if step == 20 {
            half_way = Some((run.state.clone(), run.world.snapshot()));
        }
        run.steps(1);
        for _ in 0..parts {
            v += h * effort / inertia;
            x += h * v;
            effort = (effort - stiffness * h * v).clamp(-bound, bound);
        }
        worst = worst.max((f64::from(run.state.joint_position[JointId(0)]) - x).abs());
    }
    println!("hysteresis: {worst:.2e} rad, rests about {x:.3}");
    assert!(x > 0.1 && worst < 2e-3, "{worst} at {x}");
    let end = run.hash();
    let (state, physics) = half_way.unwrap();
    run.state = state;
    run.world.restore(&mut run.state, &physics).unwrap();
    run.steps(20);
    assert!(run.hash() == end);
}
