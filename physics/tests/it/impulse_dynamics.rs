//! Impacts on jointed bodies, which take their share of the impulse.

use crate::bounces::{each_step, set_pair};
use crate::common::{Build, Piece, Run};
use dwell_physics::{JointState, PhysicsConfig};
use dwell_scene::{Joint, JointId, JointKind, Mobility, ObjectId, PartId, Pose};
use glam::{DVec3, Vec3};

const DENSITY: f32 = 500.0;
const RADIUS: f32 = 0.1;
const HALF: Vec3 = Vec3::new(0.4, 0.8, 0.02);
const AXIS: Vec3 = Vec3::new(2.0, 0.0, 2.0);

fn ball_kg() -> f64 {
    f64::from(DENSITY) * 4.0 / 3.0 * std::f64::consts::PI * f64::from(RADIUS).powi(3)
}

/// An impact between a ball and a leaf.
#[derive(Clone, Copy, Debug)]
struct Blow {
    kind: JointKind,
    /// The leaf's mass over the ball's.
    times: f32,
    restitution: f64,
    friction: f64,
    /// Initial velocity of the ball, and its position.
    throw: Vec3,
    from: Vec3,
    /// Velocity of the leaf along its joint.
    leaf: f32,
    sleeping: bool,
}

/// Ball and leaf before or after an impact.
struct Seen {
    /// The ball's velocity, m/s, and the position of its middle relative to a point of the hinge, m.
    velocity: DVec3,
    at: DVec3,
    /// Position of the joint, rad or m, and its velocity, per second.
    position: f64,
    speed: f64,
    energy: f64,
    /// Along the slide, or about the hinge: the ball's spin and the leaf.
    turning: f64,
}

/// The impact point of ball and leaf.
struct Meeting {
    /// Position of the ball's middle relative to the hinge, m.
    at: DVec3,
    /// Of the leaf.
    normal: DVec3,
    /// Speed of the leaf at the point for each unit of the joint's speed.
    lever: f64,
}

impl Meeting {
    /// Returns the separation speed of ball and leaf, m/s.
    fn parts(&self, seen: &Seen) -> f64 {
        seen.velocity.dot(self.normal) + seen.speed * self.lever
    }
}

impl Blow {
    fn build(&self) -> (Run, ObjectId, JointId) {
        self.build_within([-1.5, 1.5])
    }

    /// With a joint between these stops.
    fn build_within(&self, limits: [f32; 2]) -> (Run, ObjectId, JointId) {
        let mut build = Build::room([6.0, 4.0, 6.0]);
        let density = self.times * ball_kg() as f32 / (8.0 * HALF.element_product());
        let leaf = Piece::cuboid(HALF, Vec3::new(2.4, 1.0, 2.0)).density(density);
        let gate = build.object("gate", Mobility::Articulated, &[leaf]);
        let axis = match self.kind {
            JointKind::Hinge => Vec3::Y,
            JointKind::Slide => Vec3::Z,
        };
        let hinge = build.joint(gate, self.kind, axis, AXIS, limits);
        let joint = &mut build.data.joints[hinge];
        (joint.friction, joint.damping, joint.armature) = (0.0, 0.0, 0.0);
        let ball = Piece::ball(RADIUS, self.from).density(DENSITY);
        let ball = build.movable("ball", ball);
        let mut run = build.run_with(PhysicsConfig {
            latches: false,
            sleeping: self.sleeping,
            ..each_step()
        });
        let weightless = "world/gravity_m_s2".parse().unwrap();
        let house = run.house.clone();
        run.state.set_parameter(&house, &weightless, 0.0).unwrap();
        let values = [
            ("restitution", self.restitution),
            ("friction", self.friction),
        ];
        set_pair(&mut run, "wood", "wood", values);
        if self.sleeping {
            run.steps(400);
        } else {
            let set = JointState {
                joint: hinge,
                position: 0.0,
                velocity: self.leaf,
            };
            run.world.set_joints(&mut run.state, &[set]).unwrap();
        }
        run.throw(ball, self.throw);
        (run, ball, hinge)
    }

    fn look(&self, run: &Run, ball: ObjectId, joint: JointId) -> Seen {
        let mass = ball_kg();
        let root = run.root(ball);
        let velocity = run.state.part_velocity[root];
        let (v, spin) = (velocity.linear.as_dvec3(), velocity.angular.as_dvec3());
        let at = run.position(ball).as_dvec3() - AXIS.as_dvec3();
        let q = f64::from(run.state.joint_position[joint]);
        let speed = f64::from(run.state.joint_velocity[joint]);
        let own = 0.4 * mass * f64::from(RADIUS).powi(2);
        let kinetic = 0.5 * mass * v.length_squared() + 0.5 * own * spin.length_squared();
        let leaf = f64::from(self.times) * mass;
        let inertia = match self.kind {
            JointKind::Slide => leaf,
            JointKind::Hinge => leaf * ((0.8 * 0.8 + 0.04 * 0.04) / 12.0 + 0.16),
        };
        let spin = match self.kind {
            JointKind::Slide => 0.0,
            JointKind::Hinge => own * spin.y,
        };
        Seen {
            velocity: v,
            at,
            position: q,
            speed,
            energy: kinetic + 0.5 * inertia * speed * speed,
            turning: spin + inertia * speed,
        }
    }

    /// Momentum along the slide, or angular momentum about the hinge, with the ball's middle at a place.
    fn momentum(&self, seen: &Seen, at: DVec3) -> f64 {
        let ball = match self.kind {
            JointKind::Slide => seen.velocity.z,
            JointKind::Hinge => at.cross(seen.velocity).y,
        };
        ball_kg() * ball + seen.turning
    }

    /// Returns the impact point of ball and leaf in uniform motion.
    fn meeting(&self, seen: &Seen) -> Meeting {
        if self.kind == JointKind::Slide {
            return Meeting {
                at: seen.at,
                normal: DVec3::Z,
                lever: -1.0,
            };
        }
        // The leaf lies along (cos q, 0, -sin q), and faces (sin q, 0, cos q).
        let at = |time_s: f64| {
            let (sin, cos) = (seen.position + seen.speed * time_s).sin_cos();
            let normal = DVec3::new(sin, 0.0, cos);
            let ball = seen.at + seen.velocity * time_s;
            let gap = ball.dot(normal) - f64::from(RADIUS + HALF.z);
            let lever = ball.dot(DVec3::new(cos, 0.0, -sin));
            let meeting = Meeting {
                at: ball,
                normal,
                lever,
            };
            (meeting, gap)
        };
        let (mut low, mut high) = (0.0, 1.0 / 120.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if at(middle).1 > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(low).0
    }

    /// Returns restitution, the ratio of energies, and the lost momentum as a share of the ball's, of the one impact.
    fn made(&self) -> [f64; 3] {
        let (mut run, ball, joint) = self.build();
        let mut before = self.look(&run, ball, joint);
        let mut steps = 0;
        let after = loop {
            run.steps(1);
            let after = self.look(&run, ball, joint);
            if (after.velocity - before.velocity).length() > 1e-3 {
                break after;
            }
            before = after;
            steps += 1;
            assert!(steps < 400, "{self:?}: no blow");
        };
        let meeting = self.meeting(&before);
        let brought = ball_kg() * before.velocity.length() * meeting.lever.abs();
        // And it was the only one.
        run.steps(1);
        let later = self.look(&run, ball, joint);
        assert!(
            (later.velocity - after.velocity).length() < 1e-3,
            "{self:?}"
        );
        [
            -meeting.parts(&after) / meeting.parts(&before),
            after.energy / before.energy,
            (self.momentum(&after, meeting.at) - self.momentum(&before, meeting.at)) / brought,
        ]
    }
}

const SLIDE: Blow = Blow {
    kind: JointKind::Slide,
    times: 1.0,
    restitution: 1.0,
    friction: 0.0,
    throw: Vec3::new(0.0, 0.0, -3.0),
    from: Vec3::new(2.4, 1.0, 2.6),
    leaf: 0.0,
    sleeping: false,
};

/// A ball against a slide that is lighter, as heavy, or heavier, at rest, asleep, receding and approaching, in its middle
/// and beside it: they part with `e` times their approach speed, and momentum along the slide is kept.
#[test]
fn a_slide_parts_with_restitution_and_keeps_momentum() {
    for restitution in [1.0, 0.5] {
        for times in [0.2_f32, 1.0, 20.0] {
            for (leaf, sleeping) in [(0.0, false), (0.0, true), (-0.7, false), (0.4, false)] {
                for (aside, friction) in [(0.0, 0.0), (0.15, 0.0), (0.15, 0.3)] {
                    let blow = Blow {
                        restitution,
                        times,
                        leaf,
                        sleeping,
                        friction,
                        from: SLIDE.from + Vec3::new(aside, aside, 0.0),
                        ..SLIDE
                    };
                    let [parts, energy, momentum] = blow.made();
                    println!(
                        "{restitution} {times} {leaf} {sleeping} {aside} {friction}: {parts:.5} {energy:.5} {momentum:.5}"
                    );
                    assert!(
                        (parts - restitution).abs() < 0.01 * restitution,
                        "{blow:?}: {parts}"
                    );
                    assert!(momentum.abs() < 1e-3, "{blow:?}: {momentum}");
                    assert!(energy < 1.001, "{blow:?}: {energy}");
                }
            }
        }
    }
}

/// A ball against a free leaf, at several distances from its hinge, straight and oblique: restitution within 1 %, angular
/// momentum about the hinge within 0.1 %, and no gain of energy.
#[test]
fn a_leaf_parts_with_restitution_and_keeps_angular_momentum() {
    for restitution in [1.0, 0.5] {
        for times in [0.2_f32, 1.0, 20.0] {
            for (leaf, sleeping) in [(0.0, false), (0.0, true), (0.8, false), (-0.3, false)] {
                for (x, askew, friction) in [
                    (2.6, 0.0, 0.0),
                    (2.3, 0.0, 0.3),
                    (2.6, 1.0, 0.0),
                    (2.5, -1.0, 0.3),
                ] {
                    let blow = Blow {
                        kind: JointKind::Hinge,
                        restitution,
                        times,
                        leaf,
                        sleeping,
                        friction,
                        from: Vec3::new(x - 0.16 * askew, 1.0, 2.6),
                        throw: Vec3::new(askew, 0.0, -3.0),
                    };
                    let [parts, energy, momentum] = blow.made();
                    println!(
                        "{restitution} {times} {leaf} {sleeping} {x} {askew} {friction}: {parts:.5} {energy:.5} {momentum:.5}"
                    );
                    assert!(
                        (parts - restitution).abs() < 0.01 * restitution,
                        "{blow:?}: {parts}"
                    );
                    // Where the leaf turns in the step of the impact, friction acts a little beside it.
                    let within = if friction > 0.0 { 3e-3 } else { 1e-3 };
                    assert!(momentum.abs() < within, "{blow:?}: {momentum}");
                    assert!(energy < 1.001, "{blow:?}: {energy}");
                }
            }
        }
    }
}

/// A leaf at its stop, or latched, is a wall to an impact towards the stop, and a leaf to one that opens it.
#[test]
fn a_leaf_at_its_stop_is_struck_as_a_wall_from_the_other_side_as_a_leaf() {
    for (limits, gives) in [([0.0, 1.5], true), ([-1.5, 0.0], false)] {
        let blow = Blow {
            kind: JointKind::Hinge,
            restitution: 0.5,
            from: Vec3::new(2.6, 1.0, 2.6),
            ..SLIDE
        };
        let (mut run, ball, joint) = blow.build_within(limits);
        run.steps(40);
        let (v, leaf) = (run.velocity(ball).z, run.state.joint_velocity[joint]);
        // About +Y a push along -Z beside the hinge turns the leaf forwards.
        let lever = 0.6_f32;
        let inertia = (0.8 * 0.8 + 0.04 * 0.04) / 12.0 + 0.16;
        let share = if gives {
            1.0 / (1.0 + lever * lever / inertia)
        } else {
            1.0
        };
        let expected = -3.0 + 1.5 * 3.0 * share;
        println!("{limits:?}: {v} of {expected} m/s, leaf {leaf} rad/s");
        assert!(
            (v - expected).abs() < 0.01 * 3.0,
            "{limits:?}: {v} {expected}"
        );
        assert_eq!(leaf.abs() > 0.1, gives, "{limits:?}: {leaf}");
    }
}

/// A body that floats, with a leaf on a hinge or a box on a slide, is struck on either of its parts: momentum is kept, and energy
/// with a restitution of 1.
#[test]
fn what_floats_on_joints_keeps_momentum_when_it_is_struck() {
    for kind in [JointKind::Hinge, JointKind::Slide] {
        for (on_root, restitution) in [(false, 1.0), (false, 0.5), (true, 1.0), (true, 0.5)] {
            let mut build = Build::room([6.0, 4.0, 6.0]);
            let half = Vec3::new(0.2, 0.2, 0.05);
            let (root_at, child_at) = (Vec3::new(2.0, 2.0, 3.0), Vec3::new(2.45, 2.0, 3.0));
            let pieces = [
                Piece::cuboid(half, root_at).density(DENSITY),
                Piece::cuboid(half, child_at).density(DENSITY),
            ];
            let rig = build.object("rig", Mobility::Movable, &pieces);
            let parts: Vec<PartId> = build.data.objects[rig].parts().collect();
            let place = Vec3::new(0.22, 0.0, 0.0);
            let axis = match kind {
                JointKind::Hinge => Vec3::Y,
                JointKind::Slide => Vec3::Z,
            };
            build.data.joints.push(Joint {
                parent: Some(parts[0]),
                parent_from_joint: Pose::from_position(place),
                child_from_joint: Pose::from_position(place - Vec3::X * 0.45),
                limits: Some([-1.5, 1.5]),
                ..Joint::new("link", rig, parts[1], kind, axis)
            });
            let aim = if on_root { root_at } else { child_at };
            let from = aim + Vec3::new(0.05, 0.03, 0.6);
            let ball = build.movable("ball", Piece::ball(RADIUS, from).density(DENSITY));
            let mut run = build.run_with(PhysicsConfig {
                sleeping: false,
                ..each_step()
            });
            let weightless = "world/gravity_m_s2".parse().unwrap();
            let house = run.house.clone();
            run.state.set_parameter(&house, &weightless, 0.0).unwrap();
            let values = [("restitution", restitution), ("friction", 0.0)];
            set_pair(&mut run, "wood", "wood", values);
            run.throw(ball, Vec3::Z * -3.0);
            let box_kg = f64::from(DENSITY * 8.0 * half.element_product());
            let inertia =
                |k: usize| box_kg / 3.0 * f64::from(half.length_squared() - half[k] * half[k]);
            // By parts: their origins are their middles.
            let look = |run: &Run| {
                let (mut momentum, mut energy) = (DVec3::ZERO, 0.0);
                for part in &parts {
                    let velocity = run.state.part_velocity[*part];
                    let v = velocity.linear.as_dvec3();
                    let turn = run.state.part_pose[*part].rotation.as_dquat().inverse();
                    let spin = turn * velocity.angular.as_dvec3();
                    momentum += v * box_kg;
                    energy += 0.5 * box_kg * v.length_squared();
                    energy += (0..3)
                        .map(|k| 0.5 * inertia(k) * spin[k] * spin[k])
                        .sum::<f64>();
                }
                let v = run.velocity(ball).as_dvec3();
                (
                    momentum + v * ball_kg(),
                    energy + 0.5 * ball_kg() * v.length_squared(),
                )
            };
            let before = look(&run);
            let mut steps = 0;
            while (run.velocity(ball).z + 3.0).abs() < 1e-3 && steps < 100 {
                run.steps(1);
                steps += 1;
            }
            let after = look(&run);
            let off = (after.0 - before.0).length() / before.0.length();
            let share = after.1 / before.1;
            println!(
                "{kind:?} root {on_root} e {restitution}: momentum off by {off:.1e}, energy {share:.4}"
            );
            assert!(steps < 100 && off < 2e-3, "{kind:?} {on_root}: {off}");
            if restitution == 1.0 {
                assert!((share - 1.0).abs() < 0.01, "{kind:?} {on_root}: {share}");
            } else {
                assert!(share < 0.99, "{kind:?} {on_root}: {share}");
            }
        }
    }
}
