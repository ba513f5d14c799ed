//! Rebounds: how high, how often, and never with more energy than before.

use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::{ContactFriction, PhysicsConfig};
use dwell_scene::random::RandomKey;
use dwell_scene::{JointKind, ObjectId};
use glam::{Quat, Vec3};

/// Every physics step is a control step, so that each is seen.
pub(crate) fn each_step() -> PhysicsConfig {
    PhysicsConfig {
        control_rate_hz: 120.0,
        ..PhysicsConfig::default()
    }
}

pub(crate) fn set_pair(run: &mut Run, a: &str, b: &str, values: [(&str, f64); 2]) {
    for (field, value) in values {
        let address = format!("pair/{a}~{b}/{field}").parse().unwrap();
        run.state
            .set_parameter(&run.house, &address, value)
            .unwrap();
    }
    run.world.apply_parameters(&mut run.state).unwrap();
}

/// Returns the heights over `floor_m` to which an object rises between its bounces: in flight, `y + v^2 / 2 g` of its
/// middle is the same in each step.
fn tops(run: &mut Run, thing: ObjectId, floor_m: f32, count: usize) -> Vec<f32> {
    let mut tops = Vec::new();
    let mut rising = false;
    for _ in 0..3000 {
        run.steps(1);
        let speed = run.velocity(thing).y;
        if rising && speed <= 0.0 {
            let over = run.position(thing).y - floor_m;
            tops.push(over + speed * speed / (2.0 * gravity()));
            if tops.len() == count {
                break;
            }
        }
        rising = speed > 0.0;
    }
    tops
}

/// Rebound `n` of a ball dropped from `h` rises to `e^(2 n) h`, whatever the phase of the steps in which it hits: within 0.1 %.
#[test]
fn a_ball_rises_to_the_height_that_restitution_says() {
    for restitution in [0.5_f64, 0.8, 0.95] {
        for (radius, height) in [(0.05_f32, 1.0_f32), (0.11, 0.97), (0.03, 1.03)] {
            let mut build = Build::room_of([4.0, 4.0, 4.0], "marble");
            let at = Vec3::new(2.03, radius + height, 1.96);
            let ball = build.movable("ball", Piece::ball(radius, at).of("glass"));
            let mut run = build.run_with(each_step());
            set_pair(
                &mut run,
                "marble",
                "glass",
                [("restitution", restitution), ("friction", 0.3)],
            );
            let tops = tops(&mut run, ball, radius, 5);
            let mut expected = height;
            let mut off = Vec::new();
            for top in &tops {
                expected *= (restitution * restitution) as f32;
                off.push(top / expected - 1.0);
            }
            println!("  e {restitution}, {radius} m: {off:?}");
            assert_eq!(tops.len(), 5, "{restitution}");
            assert!(off.iter().all(|off| off.abs() < 1e-3), "{off:?}");
        }
    }
}

/// Kinetic and potential energy of things without friction in their joints, J.
fn energy_j(run: &Run, things: &[(ObjectId, f64)]) -> f64 {
    let height = |(thing, mass): &(ObjectId, f64)| {
        mass * f64::from(gravity()) * f64::from(run.position(*thing).y)
    };
    run.world.kinetic_energy_j() + things.iter().map(height).sum::<f64>()
}

/// Boxes that fall on corners, edges and faces, turning, with any restitution and both friction models: their energy never
/// grows by more than 0.5 % of their initial one (rapier turns a flying body by its spin at the beginning of a step: up to
/// 0.3 % in a flight).
#[test]
fn boxes_that_bounce_on_corners_gain_no_energy() {
    for (way, restitution) in [
        (ContactFriction::Patch, 0.95),
        (ContactFriction::Point, 0.95),
        (ContactFriction::Patch, 0.5),
        (ContactFriction::Point, 0.5),
    ] {
        let mut worst = 0.0_f64;
        for seed in 0..12 {
            let mut key = RandomKey::root(seed).child("corners").stream();
            let mut build = Build::room_of([6.0, 6.0, 6.0], "marble");
            let half = Vec3::new(0.05, 0.08, 0.12);
            let axis = Vec3::new(
                key.range(-1.0, 1.0),
                key.range(-1.0, 1.0),
                key.range(-1.0, 1.0),
            );
            let turned = Quat::from_scaled_axis(axis * 3.0);
            let piece = Piece::cuboid(half, Vec3::new(3.0, 1.0, 3.0)).of("glass");
            let thing = build.movable("box", piece.turned(turned));
            let mut run = build.run_with(PhysicsConfig {
                contact_friction: way,
                ..each_step()
            });
            set_pair(
                &mut run,
                "marble",
                "glass",
                [("restitution", restitution), ("friction", 0.4)],
            );
            let root = run.root(thing);
            run.state.part_velocity[root].angular = axis * 6.0;
            run.world.adopt_state(&mut run.state).unwrap();
            let mass = 500.0 * 8.0 * f64::from(half.element_product());
            let things = [(thing, mass)];
            let start = energy_j(&run, &things);
            // A step in which it is stopped at the surface ends with the lost height still missing: the lesser energy of
            // two steps counts.
            let (mut least, mut last) = (start, start);
            for _ in 0..360 {
                run.steps(1);
                let now = energy_j(&run, &things);
                worst = worst.max((now.min(last) - least) / start);
                least = least.min(now);
                last = now;
            }
        }
        println!("  {way:?} e {restitution}: {worst} of the energy");
        assert!(worst < 5e-3, "{way:?} {restitution}: {worst}");
    }
}

/// A ball that flies fast along the floor, or spins, rises as high: within 0.1 %.
#[test]
fn spin_and_speed_along_the_floor_change_no_height() {
    for (along, spin) in [(8.0_f32, 0.0_f32), (0.0, 60.0), (-5.0, 120.0)] {
        let (radius, height) = (0.05, 1.0);
        let mut build = Build::room_of([40.0, 4.0, 4.0], "marble");
        let at = Vec3::new(20.0, radius + height, 2.0);
        let ball = build.movable("ball", Piece::ball(radius, at).of("glass"));
        let mut run = build.run_with(each_step());
        let values = [("restitution", 0.8), ("friction", 0.2)];
        set_pair(&mut run, "marble", "glass", values);
        let root = run.root(ball);
        run.state.part_velocity[root].angular = Vec3::Z * spin;
        run.throw(ball, Vec3::X * along);
        let tops = tops(&mut run, ball, radius, 5);
        let mut expected = height;
        for top in &tops {
            expected *= 0.64;
            println!("  {along} m/s, {spin} rad/s: {}", top / expected - 1.0);
        }
        for (k, top) in tops.iter().enumerate() {
            let expected = height * 0.64_f32.powi(k as i32 + 1);
            assert!(
                (top / expected - 1.0).abs() < 0.01,
                "{k}: {top} of {expected}"
            );
        }
    }
}

/// A flat landing bounces flat: a box dropped on its face rises to `e^2 h` and hardly turns.
#[test]
fn a_box_that_lands_on_its_face_bounces_without_turning() {
    let mut build = Build::room_of([4.0, 4.0, 4.0], "marble");
    let half = Vec3::new(0.1, 0.06, 0.08);
    let height = 0.5;
    let at = Vec3::new(2.0, half.y + height, 2.0);
    let thing = build.movable("box", Piece::cuboid(half, at).of("glass"));
    let mut run = build.run_with(each_step());
    set_pair(
        &mut run,
        "marble",
        "glass",
        [("restitution", 0.6), ("friction", 0.3)],
    );
    let tops = tops(&mut run, thing, half.y, 1);
    let root = run.root(thing);
    let spin = run.state.part_velocity[root].angular.length();
    println!("  {tops:?} of {}, {spin} rad/s", 0.36 * height);
    assert!((tops[0] / (0.36 * height) - 1.0).abs() < 1e-3, "{tops:?}");
    assert!(spin < 0.02, "{spin} rad/s");
}

/// Two balls that meet in the air part with `e` times their approach speed, and keep their momentum except for gravity:
/// within 1 %.
#[test]
fn a_ball_that_hits_a_loose_ball_keeps_momentum() {
    let mut build = Build::room_of([4.0, 4.0, 4.0], "marble");
    let high = build.movable(
        "high",
        Piece::ball(0.05, Vec3::new(2.0, 2.0, 2.0)).of("glass"),
    );
    let low = build.movable(
        "low",
        Piece::ball(0.08, Vec3::new(2.0, 1.2, 2.0)).of("glass"),
    );
    let mut run = build.run_with(each_step());
    set_pair(
        &mut run,
        "glass",
        "glass",
        [("restitution", 0.7), ("friction", 0.0)],
    );
    let (light, heavy) = (0.05_f32.powi(3), 0.08_f32.powi(3));
    // Both fall; the lower one flies up at first, so that they meet in the air.
    run.throw(low, Vec3::Y * 3.0);
    let momentum = |run: &Run| run.velocity(high).y * light + run.velocity(low).y * heavy;
    let (start, mut steps) = (momentum(&run), 0);
    let before = run.velocity(low).y - run.velocity(high).y;
    loop {
        run.steps(1);
        steps += 1;
        if run.velocity(high).y > run.velocity(low).y || steps > 100 {
            break;
        }
    }
    run.steps(2);
    let fell = gravity() * (steps + 2) as f32 / 120.0 * (light + heavy);
    let found = momentum(&run) + fell;
    assert!(steps < 100);
    // The step of the impact loses up to half a substep of gravity.
    assert!(
        (found - start).abs() < 0.01 * start.abs(),
        "{found} of {start}"
    );
    let parting = run.velocity(high).y - run.velocity(low).y;
    assert!(
        (parting / before - 0.7).abs() < 0.01,
        "{parting} of {before}"
    );
}

/// A leaf at rest, of 0.8 m and as heavy as the ball or 20 times so, takes the angular momentum about its hinge that the
/// ball loses in the step of the impact: within 3 %.
#[test]
fn a_leaf_at_rest_takes_the_momentum_of_what_strikes_it() {
    let (ball_density, volume) = (500.0_f32, 4.0 / 3.0 * std::f32::consts::PI * 1e-3);
    let ball_kg = ball_density * volume;
    for times in [1.0_f32, 20.0] {
        let mut build = Build::room([6.0, 4.0, 4.0]);
        let half = Vec3::new(0.4, 0.8, 0.02);
        let density = times * ball_kg / (8.0 * half.element_product());
        let leaf = Piece::cuboid(half, Vec3::new(2.4, 1.0, 2.0)).density(density);
        let gate = build.object("gate", dwell_scene::Mobility::Articulated, &[leaf]);
        let axis = Vec3::new(2.0, 0.0, 2.0);
        let hinge = build.joint(gate, JointKind::Hinge, Vec3::Y, axis, [-1.5, 1.5]);
        let joint = &mut build.data.joints[hinge];
        (joint.friction, joint.damping, joint.armature) = (0.0, 0.0, 0.0);
        let ball = Piece::ball(0.1, Vec3::new(2.6, 1.0, 2.6)).density(ball_density);
        let ball = build.movable("ball", ball);
        let mut run = build.run_with(PhysicsConfig {
            latches: false,
            sleeping: false,
            ..each_step()
        });
        let weightless = "world/gravity_m_s2".parse().unwrap();
        let house = run.house.clone();
        run.state.set_parameter(&house, &weightless, 0.0).unwrap();
        run.world.apply_parameters(&mut run.state).unwrap();
        run.throw(ball, Vec3::Z * -3.0);
        while (run.velocity(ball).z + 3.0).abs() < 1e-3 {
            run.steps(1);
        }
        run.steps(3);
        let mass = times * ball_kg;
        let own = (0.8 * 0.8 + 0.04 * 0.04) / 12.0 + 0.16;
        // About +Y a push along -Z beside the hinge turns the leaf forwards.
        let given = 0.6 * ball_kg * (3.0 + run.velocity(ball).z);
        let taken = mass * own * run.state.joint_velocity[hinge];
        println!("{times}: {given} given, {taken} taken");
        assert!(
            (taken - given).abs() < 0.03 * given,
            "{times}: {given} {taken}"
        );
    }
}

/// A ball that hits a door's leaf bounces off it and pushes it open.
#[test]
fn a_ball_bounces_off_a_leaf_that_gives_way() {
    let mut build = Build::room([6.0, 4.0, 4.0]);
    let leaf = Piece::cuboid(Vec3::new(0.4, 0.8, 0.02), Vec3::new(2.4, 1.0, 2.0)).density(200.0);
    let door = build.object("gate", dwell_scene::Mobility::Articulated, &[leaf]);
    let hinge = build.joint(
        door,
        JointKind::Hinge,
        Vec3::Y,
        Vec3::new(2.0, 0.0, 2.0),
        [-1.5, 1.5],
    );
    let ball = build.movable("ball", Piece::ball(0.1, Vec3::new(2.6, 1.0, 3.0)));
    let mut run = build.run_with(PhysicsConfig {
        latches: false,
        ..each_step()
    });
    run.throw(ball, Vec3::Z * -4.0);
    let start = run.world.kinetic_energy_j();
    run.steps(60);
    assert!(run.state.joint_position[hinge].abs() > 0.05);
    // The velocity gained by falling for half a second is added.
    let fell = 500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-3 * 9.81 * 1.2;
    assert!(run.world.kinetic_energy_j() < start + fell);
}
