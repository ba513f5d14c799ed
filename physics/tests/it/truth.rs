//! More of textbook mechanics: slopes, rolling, bounces, stacks, collisions, tops, pendulums and doors, each against its
//! closed form or against its equations integrated here.

use crate::common::{Build, Piece, Run, gravity, pair};
use dwell_physics::{ContactKind, PhysicsConfig};
use dwell_scene::{Collider, JointKind, Mobility, ObjectId, Pose};
use glam::{DVec3, Quat, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

fn awake() -> PhysicsConfig {
    PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    }
}

/// A world whose things have no weight.
fn weightless(build: Build, physics_rate_hz: f32) -> Run {
    let mut run = build.run_with(PhysicsConfig {
        physics_rate_hz,
        ..awake()
    });
    let gravity = "world/gravity_m_s2".parse().unwrap();
    run.state.set_parameter(&run.house, &gravity, 0.0).unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
    run
}

/// A slope of oak that falls towards +X by `angle_rad`, and a thing at rest on it.
fn on_a_slope(angle_rad: f32, up_m: f32, thing: impl Fn(Vec3) -> Piece) -> (Run, ObjectId) {
    let mut build = Build::room([24.0, 20.0, 4.0]);
    let turned = Quat::from_rotation_z(-angle_rad);
    let middle = Vec3::new(12.0, 10.0, 2.0);
    let slope = Piece::cuboid(Vec3::new(11.0, 0.1, 1.0), middle).of("oak");
    build.fixed("slope", slope.turned(turned));
    let mut piece = thing(middle + turned * Vec3::new(-9.0, 0.1 + up_m, 0.0));
    piece.place.rotation = turned * piece.place.rotation;
    let thing = build.movable("thing", piece);
    (build.run_with(awake()), thing)
}

/// `s = g (sin t - mu cos t) T^2 / 2` down the slope, within 1 %.
#[test]
fn a_block_slides_down_a_slope_with_the_acceleration_that_friction_leaves() {
    let (mu, _) = pair("oak", "steel");
    for steeper in [0.1_f32, 0.3, 0.5] {
        let angle = dwell_scene::math::atan2(mu, 1.0) + steeper;
        let half = Vec3::new(0.15, 0.05, 0.15);
        let (mut run, block) = on_a_slope(angle, 0.05, |at| Piece::cuboid(half, at).of("steel"));
        let from = run.position(block);
        run.steps(20);
        let (sin, cos) = dwell_scene::math::sin_cos(angle);
        let expected = 0.5 * gravity() * (sin - mu * cos);
        let found = (run.position(block) - from).length();
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{angle} rad: {found} m, expected {expected} m"
        );
    }
}

/// Name, how it is made, share of the acceleration, and seconds for which it is watched.
type Shape<'a> = (&'a str, &'a dyn Fn(Vec3) -> Piece, f32, u32);

/// A body that rolls without slipping goes down a slope with `g sin t / (1 + k)`, `I = k m r^2`: 2/3 of `g sin t` for a
/// cylinder, 5/7 for a ball; and `v = w r` all the way. Within 1 %.
#[test]
fn balls_and_cylinders_roll_down_a_slope_as_their_inertia_says() {
    let (radius, angle) = (0.1_f32, 0.15_f32);
    let cylinder = |at| {
        let mut piece = Piece::cuboid(Vec3::splat(radius), at);
        piece.collider = Collider::Cylinder {
            part_from_cylinder: Pose::new(Vec3::ZERO, Quat::from_rotation_x(FRAC_PI_2)),
            half_height: 0.15,
            radius,
        };
        piece
    };
    let ball = |at| Piece::ball(radius, at);
    let shapes: [Shape<'_>; 2] = [
        ("cylinder", &cylinder, 2.0 / 3.0, 3),
        ("ball", &ball, 5.0 / 7.0, 3),
    ];
    for (name, shape, share, longest) in shapes {
        let (mut run, thing) = on_a_slope(angle, radius, |at| shape(at).of("rubber"));
        let from = run.position(thing);
        let acceleration = share * gravity() * dwell_scene::math::sin(angle);
        let mut before = 0.0;
        for seconds in 1..=longest {
            run.steps(20);
            let (speed, spin) = (run.velocity(thing).length(), spin(&run, thing).length());
            let gain = speed - before;
            println!(
                "  {name}: {gain} m/s in second {seconds} of {acceleration}, {} m",
                (run.position(thing) - from).length()
            );
            assert!(
                (gain / acceleration - 1.0).abs() < 0.01,
                "{name}: {gain} m/s, expected {acceleration}"
            );
            assert!(
                (speed / (spin * radius) - 1.0).abs() < 0.01,
                "{name}: {speed} {spin}"
            );
            before = speed;
        }
    }
}

fn spin(run: &Run, thing: ObjectId) -> Vec3 {
    run.state.part_velocity[run.root(thing)].angular
}

/// A ball that bounces meets the floor with `e^k sqrt(2 g h)`, within 0.1 %, at intervals of `2 e^k sqrt(2 h / g)`, within a
/// physics step for each rebound: it leaves the floor at the end of the step in which it hits.
#[test]
fn a_ball_bounces_in_a_geometric_series() {
    let (height, radius) = (1.2_f32, 0.05_f32);
    for (floor, thing) in [("marble", "glass"), ("rubber", "rubber")] {
        let (_, e) = pair(floor, thing);
        let mut build = Build::room_of([4.0, 4.0, 4.0], floor);
        let at = Vec3::new(2.0, radius + height, 2.0);
        build.movable("ball", Piece::ball(radius, at).of(thing));
        let mut run = build.run_with(awake());
        run.steps(100);
        let impacts: Vec<_> = run
            .events
            .iter()
            .filter(|e| e.kind == ContactKind::Impact)
            .collect();
        let speed = (2.0 * gravity() * height).sqrt();
        let mut told = 0;
        for (k, two) in impacts.windows(2).enumerate() {
            let after = e.powi(k as i32 + 1);
            let interval = 2.0 * after * speed / gravity();
            // Down to bounces of four physics steps.
            if interval < 4.0 / 120.0 {
                break;
            }
            let found = (two[1].time_s - two[0].time_s) as f32;
            assert!(
                (found - interval).abs() < (k + 1) as f32 / 120.0,
                "{thing} {k}: {found} s, expected {interval} s"
            );
            let hit = two[1].relative_normal_speed_m_s;
            let expected = after * speed;
            assert!(
                (hit / expected - 1.0).abs() < 1e-3,
                "{thing} {k}: {hit} m/s, expected {expected} m/s"
            );
            told += 1;
        }
        assert!(told >= 3, "{thing}: {told} bounces of {}", impacts.len());
    }
}

/// Ten boxes on each other and a pyramid of ten balls' worth of bricks stand for a minute, asleep or not, within 5 mm.
#[test]
fn stacks_stand_for_a_minute() {
    for sleeping in [true, false] {
        let mut build = Build::room([6.0, 4.0, 4.0]);
        let half = Vec3::new(0.15, 0.1, 0.15);
        let mut places = Vec::new();
        for k in 0..10 {
            places.push(Vec3::new(1.5, 0.1 + 0.2 * k as f32, 2.0));
        }
        for row in 0..4 {
            for k in 0..4 - row {
                let x = 3.0 + 0.16 * row as f32 + 0.32 * k as f32;
                places.push(Vec3::new(x, 0.1 + 0.2 * row as f32, 2.0));
            }
        }
        let mut boxes = Vec::new();
        for (k, at) in places.iter().enumerate() {
            boxes.push(build.movable(&format!("box_{k}"), Piece::cuboid(half, *at)));
        }
        let mut run = build.run_with(PhysicsConfig {
            sleeping,
            ..PhysicsConfig::default()
        });
        run.steps(1200);
        for (k, (id, at)) in boxes.iter().zip(&places).enumerate() {
            let off = run.position(*id) - *at;
            assert!(
                off.length() < 5e-3,
                "box {k} moved by {off}, sleeping {sleeping}"
            );
        }
        assert_eq!(run.world.awake_count() == 0, sleeping);
    }
}

/// Mass of a piece of the test's default density, kg.
fn mass_kg(run: &Run, thing: ObjectId) -> f64 {
    run.state.overridden_mass_kg(&run.house, thing).map_or_else(
        || {
            let part = &run.house.parts[run.root(thing)];
            let volume = part.colliders[0].volume_m3().unwrap();
            f64::from(volume * part.density_kg_m3)
        },
        f64::from,
    )
}

/// Eight balls that fly and collide without weight for 10 s, far from walls: momentum and angular momentum stay to a
/// thousandth of what moves, and energy never grows; where restitution is 1 it stays to a hundredth.
#[test]
fn collisions_keep_momentum_and_make_no_energy() {
    for restitution in [1.0_f64, 0.5] {
        let mut build = Build::room([60.0, 60.0, 60.0]);
        let mut key = dwell_scene::random::RandomKey::root(7).stream();
        let mut balls = Vec::new();
        for k in 0..8_u8 {
            let corner = Vec3::new(f32::from(k & 1), f32::from(k >> 1 & 1), f32::from(k >> 2));
            let jitter = Vec3::new(
                key.range(-0.1, 0.1),
                key.range(-0.1, 0.1),
                key.range(-0.1, 0.1),
            );
            let at = Vec3::splat(30.0) + (corner - Vec3::splat(0.5)) * 2.0 + jitter;
            let radius = 0.2 + 0.02 * f32::from(k);
            balls.push(build.movable(&format!("ball_{k}"), Piece::ball(radius, at).of("steel")));
        }
        let mut run = weightless(build, 480.0);
        for (field, value) in [("restitution", restitution), ("friction", 0.0)] {
            let address = format!("pair/steel~steel/{field}").parse().unwrap();
            run.state
                .set_parameter(&run.house, &address, value)
                .unwrap();
        }
        run.world.apply_parameters(&mut run.state).unwrap();
        for ball in &balls {
            let root = run.root(*ball);
            // Towards the middle, and a little past it.
            let inwards = Vec3::splat(30.0) - run.position(*ball);
            let aside = Vec3::new(
                key.range(-0.2, 0.2),
                key.range(-0.2, 0.2),
                key.range(-0.2, 0.2),
            );
            run.state.part_velocity[root].linear = inwards * 0.8 + aside;
        }
        run.world.adopt_state(&mut run.state).unwrap();
        let sums = |run: &Run| {
            let (mut p, mut l, mut e, mut size) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
            for ball in &balls {
                let (m, v) = (mass_kg(run, *ball), run.velocity(*ball).as_dvec3());
                let arm = run.position(*ball).as_dvec3() - DVec3::splat(30.0);
                p += v * m;
                l += arm.cross(v * m);
                e += 0.5 * m * v.length_squared();
                size += m * v.length();
            }
            (p, l, e, size)
        };
        let (p, l, start, size) = sums(&run);
        let mut before = start;
        for _ in 0..200 {
            run.steps(1);
            let (_, _, energy, _) = sums(&run);
            assert!(
                energy < before * (1.0 + 1e-3),
                "{energy} J after {before} J"
            );
            before = energy;
        }
        let (p2, l2, end, _) = sums(&run);
        assert!(run.events.len() > 6, "{} collisions", run.events.len());
        println!(
            "  e {restitution}: {end} of {start} J, momentum off by {}, angular by {}, of {size}",
            (p2 - p).length(),
            (l2 - l).length()
        );
        assert!((p2 - p).length() < 1e-3 * size, "{p} {p2}");
        assert!((l2 - l).length() < 0.02 * size, "{l} {l2}");
        if restitution == 1.0 {
            assert!((end / start - 1.0).abs() < 0.01, "{end} of {start} J");
        } else {
            assert!(end < 0.9 * start, "{end} of {start} J");
        }
    }
}

/// Euler's equations of a free body, integrated by Runge and Kutta's fourth order: the spin in the body after `t_s`.
fn euler(moments: DVec3, start: DVec3, t_s: f64) -> DVec3 {
    let rate = |w: DVec3| {
        DVec3::new(
            (moments.y - moments.z) / moments.x * w.y * w.z,
            (moments.z - moments.x) / moments.y * w.z * w.x,
            (moments.x - moments.y) / moments.z * w.x * w.y,
        )
    };
    let steps = (t_s / 1e-4).round() as usize;
    let h = t_s / steps.max(1) as f64;
    (0..steps).fold(start, |w, _| {
        let a = rate(w);
        let b = rate(w + a * (0.5 * h));
        let c = rate(w + b * (0.5 * h));
        let d = rate(w + c * h);
        w + (a + b * 2.0 + c * 2.0 + d) * (h / 6.0)
    })
}

/// A box that spins about its middle axis turns over again and again (Dzhanibekov): the time between turns is that of
/// Euler's equations within 5 %, and angular momentum and energy stay within 2 % for 10 s.
#[test]
fn a_box_that_spins_about_its_middle_axis_turns_over_in_time() {
    let mut build = Build::room([6.0, 6.0, 6.0]);
    let half = Vec3::new(0.05, 0.1, 0.2);
    let body = build.movable("box", Piece::cuboid(half, Vec3::splat(3.0)));
    let mut run = weightless(build, 120.0);
    let m = mass_kg(&run, body);
    let h = half.as_dvec3();
    let moments = DVec3::new(
        h.y * h.y + h.z * h.z,
        h.x * h.x + h.z * h.z,
        h.x * h.x + h.y * h.y,
    ) * (m / 3.0);
    let start = DVec3::new(0.1, 12.0, 0.04);
    let root = run.root(body);
    run.state.part_velocity[root].angular = start.as_vec3();
    run.world.adopt_state(&mut run.state).unwrap();
    let measure = |run: &Run| {
        let turn = run.rotation(body).as_dquat();
        let own = turn.inverse() * spin(run, body).as_dvec3();
        (own, turn * (moments * own), 0.5 * own.dot(moments * own))
    };
    let (_, momentum, energy) = measure(&run);
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    let (mut last, mut last_exact) = (start.y, start);
    for step in 1..=200 {
        run.steps(1);
        let t = f64::from(step) / 20.0;
        let (own, l, e) = measure(&run);
        if own.y * last < 0.0 {
            found.push(t);
        }
        last = own.y;
        let exact = euler(moments, last_exact, 0.05);
        if exact.y * last_exact.y < 0.0 {
            expected.push(t);
        }
        last_exact = exact;
        assert!(
            (l - momentum).length() < 0.02 * momentum.length(),
            "{t} s: {l} was {momentum}"
        );
        assert!(
            (e / energy - 1.0).abs() < 0.02,
            "{t} s: {e} J was {energy} J"
        );
    }
    assert!(expected.len() >= 4, "{expected:?}");
    let period = |times: &[f64]| (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let (a, b) = (period(&found), period(&expected));
    assert!(
        (a / b - 1.0).abs() < 0.05,
        "turns over every {a} s, expected {b} s: {found:?} {expected:?}"
    );
}

/// A gyroscope in light gimbals whose axle is loaded on one side goes round with `m g d / (I w)`, within 5 %; without
/// spin it falls.
#[test]
fn a_loaded_gyroscope_goes_round_at_its_rate() {
    let drift = |spin_rad_s: f32| {
        let mut build = Build::room([6.0, 6.0, 6.0]);
        let at = Vec3::new(3.0, 3.0, 3.0);
        let small = |density: f32| Piece::cuboid(Vec3::splat(0.02), at).density(density);
        let out = 0.05;
        let (radius, half_height, density) = (0.1_f32, 0.02_f32, 2000.0_f32);
        let mut wheel = Piece::cuboid(Vec3::splat(radius), at + Vec3::X * out).density(density);
        wheel.collider = Collider::Cylinder {
            part_from_cylinder: Pose::new(Vec3::ZERO, Quat::from_rotation_z(-FRAC_PI_2)),
            half_height,
            radius,
        };
        let gyro = build.object(
            "gyro",
            Mobility::Movable,
            &[small(200.0), small(200.0), wheel],
        );
        let parts: Vec<_> = build.data.objects[gyro].parts().collect();
        let mut hang = |parent: Option<usize>, child: usize, axis: Vec3| {
            let name = format!("axis_{child}");
            let world = |part: usize| build.data.parts[parts[part]].world_from_part;
            let here = Pose::from_position(at);
            let joint = dwell_scene::Joint {
                parent: parent.map(|part| parts[part]),
                parent_from_joint: parent.map_or(here, |part| world(part).inverse() * here),
                child_from_joint: world(child).inverse() * here,
                ..dwell_scene::Joint::new(&name, gyro, parts[child], JointKind::Hinge, axis)
            };
            build.data.joints.push(joint)
        };
        let around = hang(None, 0, Vec3::Y);
        let down = hang(Some(0), 1, Vec3::Z);
        let axle = hang(Some(1), 2, Vec3::X);
        let mut run = build.run_with(PhysicsConfig {
            physics_rate_hz: 480.0,
            ..awake()
        });
        let mass = density * 2.0 * half_height * PI * radius * radius;
        let inertia = 0.5 * mass * radius * radius;
        let rate = mass * gravity() * out / (inertia * spin_rad_s.abs().max(1.0));
        run.state.joint_velocity[axle] = spin_rad_s;
        if spin_rad_s != 0.0 {
            // Released in steady precession, so that it does not nod.
            run.state.joint_velocity[around] = rate;
        }
        run.world.adopt_state(&mut run.state).unwrap();
        run.steps(20);
        let state = &run.state;
        (
            state.joint_position[around],
            state.joint_position[down],
            rate,
        )
    };
    let (round, nod, rate) = drift(60.0);
    println!("  round {round} rad in 1 s, {rate} expected, nodded {nod}");
    assert!(
        (round / rate - 1.0).abs() < 0.05,
        "{round} rad in 1 s, expected {rate}"
    );
    assert!(nod.abs() < 0.1, "{nod}");
    let (_, fallen, _) = drift(0.0);
    assert!(fallen.abs() > 0.8, "{fallen}");
}

/// A bar on a hinge, m long from its end, and its moment of inertia about it, kg·m².
fn bar(damping: f32, friction: f32, level: bool) -> (Run, dwell_scene::JointId, f32, f32) {
    let mut build = Build::room([6.0, 6.0, 6.0]);
    let (half, density) = (Vec3::new(0.02, 0.4, 0.02), 600.0);
    let hinge = Vec3::new(3.0, 4.0, 3.0);
    let (axis, place) = if level {
        (
            Vec3::Y,
            Piece::cuboid(Vec3::new(0.4, 0.02, 0.02), hinge + Vec3::X * 0.4),
        )
    } else {
        (Vec3::Z, Piece::cuboid(half, hinge - Vec3::Y * 0.4))
    };
    let object = build.object("bar", Mobility::Movable, &[place.density(density)]);
    let joint = build.joint(object, JointKind::Hinge, axis, hinge, [-3.0, 3.0]);
    let articulation = &mut build.data.joints[joint];
    (articulation.damping, articulation.friction) = (damping, friction);
    articulation.open = articulation.closed;
    if level {
        articulation.limits = None;
    }
    let mass = density * 8.0 * half.element_product();
    let inertia = mass * (0.8 * 0.8 + 0.04 * 0.04) / 12.0 + mass * 0.16;
    (build.run_with(awake()), joint, mass, inertia)
}

/// `T = 2 pi sqrt(I / (m g d)) (1 + a^2 / 16 + 11 a^4 / 3072)` for swings of 0.2 to 1.4 rad, within 0.5 %, with the mean `a` of
/// the swings that are timed, which fall by less than 1 %.
#[test]
fn wide_swings_of_a_pendulum_take_longer() {
    for amplitude in [0.2_f32, 0.8, 1.4] {
        let (mut run, joint, mass, inertia) = bar(0.0, 0.0, false);
        run.state.joint_position[joint] = amplitude;
        run.world.adopt_state(&mut run.state).unwrap();
        let (mut crossings, mut top, mut tops) = (Vec::new(), 0.0_f32, Vec::new());
        let mut last = amplitude;
        while crossings.len() < 5 {
            run.steps(1);
            let now = run.state.joint_position[joint];
            top = top.max(now.abs());
            if now * last < 0.0 {
                let time_s = run.world.time_s() as f32;
                crossings.push(time_s - 0.05 * now / (now - last));
                tops.push(std::mem::take(&mut top));
            }
            last = now;
        }
        let found = 0.5 * (crossings[4] - crossings[0]);
        let mean = 0.25 * tops[1..].iter().sum::<f32>();
        let small = 2.0 * PI * (inertia / (mass * gravity() * 0.4)).sqrt();
        let a2 = mean * mean;
        let expected = small * (1.0 + a2 / 16.0 + 11.0 * a2 * a2 / 3072.0);
        println!("  {amplitude} rad, {tops:?}: {found} s, expected {expected} s");
        assert!(
            (found / expected - 1.0).abs() < 0.005,
            "{amplitude} rad: {found} s, expected {expected} s"
        );
        assert!(tops[4] > 0.99 * amplitude, "{tops:?}");
    }
}

/// With viscous damping the swings fall as `exp(-c t / (2 I))`, within 0.6 % over 8 s, as far as three samples of a top tell.
#[test]
fn a_damped_pendulum_loses_the_same_share_in_each_second() {
    let (mut run, joint, _, inertia) = bar(0.05, 0.0, false);
    run.state.joint_position[joint] = 0.2;
    run.world.adopt_state(&mut run.state).unwrap();
    let mut tops = Vec::new();
    let mut trail = vec![0.2_f32];
    for step in 1..=160 {
        run.steps(1);
        trail.push(run.state.joint_position[joint].abs());
        if let [.., a, b, c] = trail[..]
            && b > a
            && b > c
        {
            // The parabola through three samples has its top here.
            let bend = a - 2.0 * b + c;
            tops.push((
                step as f32 / 20.0 - 0.05,
                b - (a - c) * (a - c) / (8.0 * bend),
            ));
        }
    }
    assert!(tops.len() > 6);
    for (t, top) in tops {
        let expected = 0.2 * (-0.05 * t / (2.0 * inertia)).exp();
        println!("  {t} s: {}", top / expected - 1.0);
        assert!(
            (top / expected - 1.0).abs() < 0.006,
            "{t} s: {top}, expected {expected}"
        );
    }
}

/// A door that was pushed coasts down under friction `F` and damping `c` as `I w' = -F - c w`: it goes
/// `(I / c) (w_0 - (F / c) ln(1 + c w_0 / F))` and stops after `(I / c) ln(1 + c w_0 / F)`, within 2 % and a control step.
#[test]
fn a_pushed_door_coasts_to_a_stop_as_its_hinge_says() {
    for (damping, friction) in [(0.1_f32, 0.05_f32), (0.02, 0.2), (0.3, 0.02)] {
        let (mut run, joint, _, inertia) = bar(damping, friction, true);
        let speed = 3.0;
        run.state.joint_velocity[joint] = speed;
        run.world.adopt_state(&mut run.state).unwrap();
        let mut stopped = 0;
        for step in 1..=400 {
            run.steps(1);
            if run.state.joint_velocity[joint].abs() < 1e-4 {
                stopped = step;
                break;
            }
        }
        let (scale, log) = (inertia / damping, (1.0 + damping * speed / friction).ln());
        let (time, way) = (scale * log, scale * (speed - friction / damping * log));
        let found = run.state.joint_position[joint];
        println!(
            "  c {damping} F {friction}: {found} rad of {way}, {} s of {time}",
            stopped as f32 / 20.0
        );
        assert!(
            (found / way - 1.0).abs() < 0.02,
            "{found} rad, expected {way}"
        );
        assert!(
            (stopped as f32 / 20.0 - time).abs() < 0.05 + 0.02 * time,
            "{stopped} steps, expected {time} s"
        );
    }
}
