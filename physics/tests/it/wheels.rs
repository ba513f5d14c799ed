//! Wheels as joints: a cart of a file, on four wheels of cylinders, that drives and that rolls.

use crate::arms::awake;
use crate::common::{Build, Piece, Run, gravity};
use crate::laws::spec;
use dwell_houses::{open_robot, with_robot};
use dwell_scene::math;
use dwell_scene::{JointCommand, JointId, PartId, Pose};
use glam::{Quat, Vec3};
use std::path::Path;
use std::sync::Arc;

const RADIUS_M: f32 = 0.06;

/// Mass of the cart, kg, and the inertia of a wheel about its axle, kg·m², as the file has them.
const MASS_KG: f32 = 6.0;
const WHEEL_KG_M2: f32 = 9e-4;

/// A cart on a plane of oak that falls by `angle_rad` ahead of it.
fn cart(angle_rad: f32) -> Run {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/robots/cart.urdf");
    let (robot, _) = open_robot(&path).unwrap();
    let mut build = Build::room([6.0, 12.0, 40.0]);
    let middle = Vec3::new(3.0, 6.0, 20.0);
    // Ahead is -Z.
    let turned = Quat::from_rotation_x(-angle_rad);
    let plane = Piece::cuboid(Vec3::new(1.0, 0.1, 18.0), middle).of("oak");
    build.fixed("plane", plane.turned(turned));
    let base = Pose::new(middle + turned * Vec3::new(0.0, 0.1, 15.0), turned);
    let house = with_robot(&build.house(), &robot, "cart", base, false).unwrap();
    Run::over(Arc::new(house), awake())
}

fn chassis(run: &Run) -> PartId {
    run.house.objects[run.house.object_named("cart").unwrap()].first_part
}

/// `v = w r`, from the displacement in the fourth second: within 1 % of the command, straight ahead within 1 % of it.
#[test]
fn a_cart_goes_as_fast_as_its_wheels_are_told_to_turn() {
    for told_rad_s in [2.0_f32, 10.0, 30.0] {
        let mut run = cart(0.0);
        for k in 0..4 {
            run.state.joint_command[JointId(k)] = JointCommand::Velocity(told_rad_s);
        }
        let part = chassis(&run);
        run.steps(60);
        let from = run.state.part_pose[part].position;
        let turned = run.state.joint_position[JointId(0)];
        run.steps(20);
        let way = run.state.part_pose[part].position - from;
        let turned = run.state.joint_position[JointId(0)] - turned;
        let told = told_rad_s * RADIUS_M;
        println!("told {told} m/s: {way} m, wheels {} m", turned * RADIUS_M);
        assert!(
            (-way.z / told - 1.0).abs() < 0.01,
            "{told_rad_s} rad/s: {way}"
        );
        assert!((turned / told_rad_s - 1.0).abs() < 0.01, "{turned} rad");
        // Straight ahead: 3 degrees.
        assert!(way.x.abs() < 0.05 * told && way.y.abs() < 1e-3, "{way}");
    }
}

/// `a = g sin t M / (M + 4 I / r^2)`: wheels that turn freely have their share of the weight's work. Within 1 % in each of three
/// seconds, up to 3.7 m/s.
#[test]
fn a_cart_rolls_down_a_slope_as_its_wheels_inertia_says() {
    for angle_rad in [0.05_f32, 0.15] {
        let mut run = cart(angle_rad);
        let part = chassis(&run);
        let share = MASS_KG / (MASS_KG + 4.0 * WHEEL_KG_M2 / (RADIUS_M * RADIUS_M));
        let acceleration = gravity() * math::sin(angle_rad) * share;
        let mut before = 0.0;
        for second in 0..3 {
            run.steps(20);
            let speed = run.state.part_velocity[part].linear.length();
            let gain = speed - before;
            println!("{angle_rad} rad, second {second}: {gain} of {acceleration} m/s");
            assert!(
                (gain / acceleration - 1.0).abs() < 0.01,
                "{gain} {acceleration}"
            );
            before = speed;
        }
    }
}

/// Motors that hold a wheel still hold the cart on a slope.
#[test]
fn a_braked_cart_stands_on_a_slope() {
    let mut run = cart(0.15);
    for k in 0..4 {
        run.state.joint_command[JointId(k)] = JointCommand::Position(0.0);
    }
    let part = chassis(&run);
    let from = run.state.part_pose[part].position;
    run.steps(200);
    let way = run.state.part_pose[part].position - from;
    // The springs of 250 N m/rad give way by 2e-4 m along the wheels' rims.
    assert!(way.length() < 2e-3, "{way}");
}

/// While wheels roll, rapier asks the hook about their contacts whatever the materials are: no parameter may take that for a change.
#[test]
fn a_number_set_and_set_back_while_wheels_roll_leaves_no_trace() {
    let play = |touched: bool| {
        let mut run = cart(0.0);
        for k in 0..4 {
            run.state.joint_command[JointId(k)] = JointCommand::Velocity(10.0);
        }
        run.steps(20);
        if touched {
            for laws in [
                vec![spec("drag", Some("cart"), &[("c_d", 0.5)])],
                Vec::new(),
            ] {
                run.state.laws = laws;
                run.world.apply_parameters(&mut run.state).unwrap();
            }
        }
        run.steps(20);
        run.hash()
    };
    assert_eq!(play(false), play(true));
}
