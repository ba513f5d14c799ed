//! Friction impulses of events, against closed forms.

use crate::common::{Build, Piece, gravity, pair};
use dwell_physics::{ContactFriction, ContactKind, PhysicsConfig};
use dwell_scene::math::{atan2, sin_cos};
use glam::{Quat, Vec3};

/// A box that slides down a slope reports `mu m g cos(t) T` of friction over `T`, and `m g cos(t) T` of normal impulse,
/// within 0.1 %; and in any case the box's own loss to friction, which with friction by point is up to 9 % less than
/// Coulomb's.
#[test]
fn a_box_that_slides_down_tells_all_of_its_friction() {
    let (mu, _) = pair("oak", "steel");
    for (way, least) in [
        (ContactFriction::Patch, 0.999),
        (ContactFriction::Point, 0.91),
    ] {
        for steeper in [0.15_f32, 0.4] {
            let angle = atan2(mu, 1.0) + steeper;
            let (sin, cos) = sin_cos(angle);
            let mut build = Build::room([24.0, 20.0, 4.0]);
            let turned = Quat::from_rotation_z(-angle);
            let middle = Vec3::new(12.0, 10.0, 2.0);
            let slope = Piece::cuboid(Vec3::new(11.0, 0.1, 1.0), middle).of("oak");
            build.fixed("slope", slope.turned(turned));
            let half = Vec3::new(0.15, 0.05, 0.12);
            let at = middle + turned * Vec3::new(-9.0, 0.15, 0.0);
            let block = build.movable("block", Piece::cuboid(half, at).of("steel").turned(turned));
            let mut run = build.run_with(PhysicsConfig {
                sleeping: false,
                contact_friction: way,
                ..PhysicsConfig::default()
            });
            // From the time at which its sliding speed is reported.
            run.steps(4);
            run.events.clear();
            let from = run.velocity(block);
            run.steps(20);
            let weight = 500.0 * 8.0 * half.element_product() * gravity();
            let sum = |what: fn(&dwell_physics::ContactEvent) -> f32| -> f32 {
                let slides = run.events.iter().filter(|e| e.kind == ContactKind::Scrape);
                slides.map(what).sum()
            };
            let (friction, pressure) = (
                sum(|event| event.tangential_impulse_n_s),
                sum(|event| event.impulse_n_s),
            );
            let lost = weight * sin - weight / gravity() * (run.velocity(block) - from).length();
            println!(
                "  {way:?} {angle} rad: {friction} of {} N s, lost {lost}, pressed {pressure} of {}",
                mu * weight * cos,
                weight * cos
            );
            assert!((pressure / (weight * cos) - 1.0).abs() < 1e-3, "{pressure}");
            assert!((friction / lost - 1.0).abs() < 1e-3, "{friction} {lost}");
            let share = friction / (mu * weight * cos);
            assert!((least..1.001).contains(&share), "{way:?}: {share}");
        }
    }
}

/// A ball that hits the floor obliquely without spin is pushed along it until it rolls, by 2/7 of its momentum along the
/// floor, within 12 %, because rapier's lever ends in the middle of the gap that was left when the step began; or slips and
/// is pushed by `mu` times the normal impulse, within 2 %: rapier applies the rebound without friction. The reported
/// impulse is the ball's loss, within 0.1 %.
#[test]
fn a_ball_that_hits_aslant_tells_what_the_floor_took() {
    for way in [ContactFriction::Patch, ContactFriction::Point] {
        for (along, friction, within) in [(1.0_f32, 0.6_f64, 0.12), (8.0, 0.1, 0.02)] {
            let radius = 0.05_f32;
            let mut build = Build::room_of([14.0, 4.0, 4.0], "marble");
            let at = Vec3::new(2.0, radius + 0.5, 2.0);
            let ball = build.movable("ball", Piece::ball(radius, at).of("glass"));
            let mut run = build.run_with(PhysicsConfig {
                contact_friction: way,
                control_rate_hz: 120.0,
                ..PhysicsConfig::default()
            });
            for (field, value) in [("restitution", 0.5), ("friction", friction)] {
                let address = format!("pair/marble~glass/{field}").parse().unwrap();
                run.state
                    .set_parameter(&run.house, &address, value)
                    .unwrap();
            }
            run.world.apply_parameters(&mut run.state).unwrap();
            run.throw(ball, Vec3::X * along);
            run.steps(54);
            let hits = run.events.iter().filter(|e| e.kind == ContactKind::Impact);
            let hits: Vec<_> = hits.collect();
            assert_eq!(hits.len(), 1);
            let hit = hits[0];
            let mass = 500.0 * 4.0 / 3.0 * std::f32::consts::PI * radius.powi(3);
            let blow = mass * 1.5 * (2.0 * gravity() * 0.5).sqrt();
            let rolls = 2.0 / 7.0 * mass * along;
            let expected = rolls.min(friction as f32 * blow / 1.5);
            let lost = mass * (along - run.velocity(ball).x);
            println!(
                "  {way:?} {along} m/s: {} of {expected} N s, lost {lost}, blow {} of {blow}",
                hit.tangential_impulse_n_s, hit.impulse_n_s
            );
            assert!((hit.impulse_n_s / blow - 1.0).abs() < 0.02);
            let told = hit.tangential_impulse_n_s;
            assert!((told / lost - 1.0).abs() < 1e-3, "{told} {lost}");
            assert!((told / expected - 1.0).abs() < within, "{told} {expected}");
        }
    }
}
