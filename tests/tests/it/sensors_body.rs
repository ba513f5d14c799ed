//! Sensors of an agent's body: lidar against closed form and the depth camera, contact with walls, proprioception.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{Batch, DiscreteAction, Engines, WorldConfig};
use dwell_physics::AgentControl;
use dwell_scene::{AgentBody, AgentId};
use dwell_tests::sensing::{bare_room, observed, place, sensing, world};
use glam::{Vec2, Vec3};
use serde_json::json;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::Arc;

const SIZE: [f32; 3] = [6.0, 3.0, 5.0];

/// The distance from inside a box to its surface, m.
fn way_out_m(from: Vec3, direction: Vec3) -> f32 {
    let along = |axis: usize| {
        let wall = if direction[axis] > 0.0 {
            SIZE[axis]
        } else {
            0.0
        };
        (wall - from[axis]) / direction[axis]
    };
    (0..3).map(along).fold(f32::INFINITY, |least, m| {
        if m.is_finite() { least.min(m) } else { least }
    })
}

fn step(batch: &mut Batch, action: DiscreteAction) {
    batch.step(&[Some(action)]).unwrap();
}

#[test]
fn a_lidar_measures_a_room_as_its_geometry_says() {
    let elevations_deg = [-20.0_f32, 0.0, 35.0];
    let (beams, fov_deg, yaw, own_yaw_deg) = (37, 270.0_f32, 0.7_f32, 30.0_f32);
    let own = json!({
        "name": "all", "beams": beams, "fov_deg": fov_deg, "elevations_deg": elevations_deg, "max_range_m": 50.0,
        "position_m": [0.1, 0.8, -0.2], "yaw_deg": own_yaw_deg,
    });
    let short = json!({"max_range_m": 2.0, "min_range_m": 1.0, "position_m": [0.0, 1.0, 0.0]});
    let mut batch = sensing(
        &bare_room(SIZE),
        WorldConfig::default(),
        &[("lidar", own), ("lidar", short)],
    );
    let feet = Vec3::new(2.0, 0.0, 1.5);
    place(&mut batch, 0, feet, yaw);
    let (ranges, shape) = observed(&mut batch, "all");
    assert_eq!(shape, [3, beams]);
    let (sine, cosine) = yaw.sin_cos();
    let (right, ahead) = (
        Vec3::new(cosine, 0.0, -sine),
        Vec3::new(-sine, 0.0, -cosine),
    );
    let from = feet + right * 0.1 + Vec3::Y * 0.8 + ahead * 0.2;
    for (ring, elevation_deg) in elevations_deg.iter().enumerate() {
        for beam in 0..beams {
            let left_deg = fov_deg * (beam as f32 / (beams - 1) as f32 - 0.5) + own_yaw_deg;
            let heading = yaw + left_deg.to_radians();
            let (up, level) = elevation_deg.to_radians().sin_cos();
            let way = Vec3::new(-heading.sin() * level, up, -heading.cos() * level);
            let (found, expected) = (ranges[ring * beams + beam], way_out_m(from, way));
            assert!(
                (found - expected).abs() < 1e-4 * expected,
                "{elevation_deg} degrees up, {left_deg} to the left: {found} m, not {expected}"
            );
        }
    }
    // Its own body is not in the way, although it is in its middle.
    let (ranges, shape) = observed(&mut batch, "lidar");
    assert_eq!(shape, [1, 360]);
    for (beam, found) in ranges.iter().enumerate() {
        let heading = yaw + (beam as f32 - 180.0).to_radians();
        let way = Vec3::new(-heading.sin(), 0.0, -heading.cos());
        let expected = way_out_m(feet + Vec3::Y, way).clamp(1.0, 2.0);
        assert!(
            (found - expected).abs() < 1e-4,
            "{beam}: {found} m, not {expected}"
        );
    }
    assert!(ranges.contains(&2.0));
}

#[test]
fn errors_of_a_lidar_have_their_spread_and_come_from_the_seed() {
    let noisy = json!({"beams": 2000, "max_range_m": 50.0, "noise_m": 0.02});
    let far = json!({"name": "far", "beams": 50, "max_range_m": 0.5, "noise_m": 0.02});
    let exact = json!({"name": "exact", "beams": 2000, "max_range_m": 50.0});
    let sensors = [("lidar", noisy), ("lidar", exact), ("lidar", far)];
    let mut batch = sensing(&bare_room(SIZE), WorldConfig::default(), &sensors);
    let errors = |batch: &mut Batch| {
        let (found, exact) = (observed(batch, "lidar").0, observed(batch, "exact").0);
        let errors = found.iter().zip(&exact).map(|(a, b)| f64::from(a - b));
        errors.collect::<Vec<f64>>()
    };
    let first = errors(&mut batch);
    assert_eq!(errors(&mut batch), first);
    let count = first.len() as f64;
    let mean = first.iter().sum::<f64>() / count;
    let spread = (first.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
    // Five standard errors.
    assert!(mean.abs() < 5.0 * 0.02 / count.sqrt(), "{mean}");
    assert!(
        (spread / 0.02 - 1.0).abs() < 5.0 / (2.0 * count).sqrt(),
        "{spread}"
    );
    place(&mut batch, 0, Vec3::new(3.0, 0.0, 2.5), 0.0);
    assert!(
        observed(&mut batch, "far")
            .0
            .iter()
            .all(|range| *range == 0.5)
    );
    step(&mut batch, DiscreteAction::Wait);
    assert_ne!(errors(&mut batch), first);
    let mut again = sensing(&bare_room(SIZE), WorldConfig::default(), &sensors);
    assert_eq!(errors(&mut again), first);
}

#[test]
fn a_lidar_at_the_eyes_agrees_with_the_depth_camera() {
    let (house, _) = dwell_houses::open("seed:7").unwrap();
    let (width, beams, fov_deg) = (4001, 81, 80.0_f32);
    let eye_m = AgentBody::default().eye_height_m;
    let camera =
        json!({"width": width, "height": 3, "fov_deg": 90.0, "far_m": 20.0, "near_m": 0.01});
    let lidar = json!({"beams": beams, "fov_deg": fov_deg, "max_range_m": 20.0, "position_m": [0.0, eye_m, 0.0]});
    let mut batch = sensing(
        &Engines::new(Arc::new(house)),
        WorldConfig::default(),
        &[("depth", camera), ("lidar", lidar)],
    );
    let (mut agree, mut all) = (0, 0);
    for _ in 0..8 {
        let (depth, ranges) = (
            observed(&mut batch, "depth").0,
            observed(&mut batch, "lidar").0,
        );
        for (beam, range) in ranges.iter().enumerate() {
            let left = fov_deg.to_radians() * (beam as f32 / (beams - 1) as f32 - 0.5);
            let column = ((0.5 - 0.5 * left.tan()) * width as f32) as usize;
            let seen = depth[width + column] / left.cos();
            all += 1;
            agree += usize::from((seen - range).abs() < 0.01 * range + 0.005);
        }
        for _ in 0..5 {
            step(&mut batch, DiscreteAction::TurnLeft);
        }
    }
    // Beams that graze an edge may pass it on the other side than the nearest pixel.
    assert!(agree * 100 >= 98 * all, "{agree} of {all}");
}

#[test]
fn a_lidar_sees_other_agents_where_they_stand() {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); 2],
        ..WorldConfig::default()
    };
    let lidar = json!({"beams": 1, "position_m": [0.0, 1.0, 0.0]});
    let mut batch = sensing(&bare_room(SIZE), config, &[("lidar", lidar)]);
    place(&mut batch, 0, Vec3::new(3.0, 0.0, 4.0), 0.0);
    for distance_m in [1.0_f32, 2.0] {
        place(&mut batch, 1, Vec3::new(3.0, 0.0, 4.0 - distance_m), 0.0);
        let range = observed(&mut batch, "lidar").0[0];
        let gap_m = distance_m - range;
        assert!((0.05..=0.21).contains(&gap_m), "{gap_m}");
    }
}

/// The sectors of eight in which the body touches something.
fn touched(batch: &mut Batch) -> Vec<usize> {
    let (rows, shape) = observed(batch, "contact");
    assert_eq!(shape, [9, 2]);
    let touches = rows.chunks_exact(2).enumerate();
    touches
        .filter(|(_, row)| row[0] == 1.0)
        .map(|(sector, _)| sector)
        .collect()
}

#[test]
fn contact_says_on_which_side_walls_are() {
    let mut batch = sensing(
        &bare_room(SIZE),
        WorldConfig::default(),
        &[("contact", json!({}))],
    );
    // Ahead: north (-Z), west (-X), south, east.
    for yaw in [0.0, FRAC_PI_2, PI, -FRAC_PI_2] {
        place(&mut batch, 0, Vec3::new(3.0, 0.0, 2.5), yaw);
        assert!(touched(&mut batch).is_empty());
        for _ in 0..40 {
            step(&mut batch, DiscreteAction::MoveForward);
        }
        assert!(world(&mut batch).state().agents[AgentId(0)].collided);
        assert_eq!(touched(&mut batch), [0], "{yaw}");
        // A quarter turn to the left in ten steps: the wall is to its right.
        for _ in 0..10 {
            step(&mut batch, DiscreteAction::TurnLeft);
        }
        assert_eq!(touched(&mut batch), [6], "{yaw}");
        // Into the corner.
        for _ in 0..40 {
            step(&mut batch, DiscreteAction::MoveForward);
        }
        assert_eq!(touched(&mut batch), [0, 6], "{yaw}");
        let (rows, _) = observed(&mut batch, "contact");
        assert!(
            rows.iter()
                .skip(1)
                .step_by(2)
                .all(|force_n| *force_n == 0.0)
        );
    }
    // Half a metre before a wall nothing is touched.
    place(&mut batch, 0, Vec3::new(3.0, 0.0, 0.7), 0.0);
    assert!(touched(&mut batch).is_empty());
}

#[test]
fn contact_with_another_agent_has_its_direction() {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); 2],
        ..WorldConfig::default()
    };
    let one_each = json!({"sectors": 4});
    let mut batch = sensing(&bare_room(SIZE), config, &[("contact", one_each)]);
    let middle = Vec3::new(3.0, 0.0, 2.5);
    place(&mut batch, 0, middle, FRAC_PI_4);
    let (sine, cosine) = FRAC_PI_4.sin_cos();
    let left = Vec3::new(-cosine, 0.0, sine);
    place(&mut batch, 1, middle + left * 0.41, 0.0);
    let (rows, shape) = observed(&mut batch, "contact");
    assert_eq!(shape, [5, 2]);
    assert_eq!(rows, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn proprioception_tells_the_velocities_that_were_commanded() {
    let mut batch = sensing(
        &bare_room(SIZE),
        WorldConfig::default(),
        &[("proprioception", json!({}))],
    );
    place(&mut batch, 0, Vec3::new(3.0, 0.0, 2.5), 0.8);
    let felt = |batch: &mut Batch, control: AgentControl| {
        world(batch).step(&[control]).unwrap();
        observed(batch, "proprioception").0
    };
    let near = |found: &[f32], expected: &[f32]| {
        let pairs = found.iter().zip(expected);
        let fits = pairs.clone().all(|(a, b)| (a - b).abs() < 2e-3);
        assert!(fits, "{found:?} is not {expected:?}");
    };
    let walk = AgentControl {
        forward_m_s: 1.0,
        right_m_s: 0.5,
        ..AgentControl::default()
    };
    let eye_m = AgentBody::default().eye_height_m;
    let rest = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let found = felt(&mut batch, walk);
    assert_eq!(found.len(), 13);
    near(
        &found,
        &[[1.0, -0.5, 0.0, 0.0, 0.0, eye_m, 0.0].as_slice(), &rest].concat(),
    );
    let turn = AgentControl {
        yaw_rate_rad_s: 1.5,
        pitch_rate_rad_s: -2.0,
        ..AgentControl::default()
    };
    let found = felt(&mut batch, turn);
    near(
        &found,
        &[[0.0, 0.0, 0.0, 1.5, -0.1, eye_m, 0.0].as_slice(), &rest].concat(),
    );
    let crouch = AgentControl {
        crouch: true,
        ..AgentControl::default()
    };
    let found = felt(&mut batch, crouch);
    near(&found[5..7], &[eye_m - 0.6, 0.6]);
    // Against a wall it is stopped.
    let into = AgentControl {
        forward_m_s: 2.0,
        ..AgentControl::default()
    };
    for _ in 0..60 {
        felt(&mut batch, into);
    }
    let found = felt(&mut batch, into);
    assert!(
        found[8] == 1.0 && Vec2::new(found[0], found[1]).length() < 2.0,
        "{found:?}"
    );
}

#[test]
fn proprioception_weighs_what_the_hand_holds() {
    let mut batch = sensing(
        &dwell_tests::apartment(),
        WorldConfig::default(),
        &[("proprioception", json!({})), ("contact", json!({}))],
    );
    assert_eq!(observed(&mut batch, "proprioception").0[9..11], [0.0, 0.0]);
    let world = world(&mut batch);
    let house = world.house().clone();
    let light = house
        .objects
        .iter_ids()
        .filter(|(_, object)| object.pickable);
    let mut held = None;
    for (id, _) in light {
        let at = house.object_bounds(world.state(), id).center();
        world
            .place_agent(AgentId(0), Vec3::new(at.x, at.y.min(0.0), at.z + 0.5), 0.0)
            .unwrap();
        let outcome = world.act(AgentId(0), &dwell_physics::actions::Pick::new(id));
        if outcome.success {
            held = Some(id);
            break;
        }
    }
    let held = held.expect("something in the apartment can be picked up");
    let expected = world.state().mass_of_parts_kg(&house, held);
    let found = observed(&mut batch, "proprioception").0;
    assert!(found[9] == 1.0 && found[10] > 0.0, "{found:?}");
    assert!(
        (found[10] - expected).abs() < 0.01 * expected,
        "{found:?}, {expected} kg"
    );
    let (rows, _) = observed(&mut batch, "contact");
    assert!([0.0, 1.0].contains(&rows[16]));
}
