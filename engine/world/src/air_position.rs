//! Sounds come from the air around a thing, not from within it.
//!
//! Contacts lie on surfaces, and a point on a surface, or a hundredth of a millimetre behind it, would send half of its sound
//! or all of it into the ground.

use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::sin_cos;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, SoundEmitter};
use glam::Vec3;
use std::f32::consts::TAU;
use std::sync::Arc;

/// Distances by which a sound may be moved, of which the least that suffices is taken, m.
const STEPS_M: [f32; 4] = [0.03, 0.08, 0.16, 0.32];
/// Directions in which it may be moved: upwards first, since most things lie on something.
const SEARCH_DIRECTIONS: [Vec3; 6] = [
    Vec3::Y,
    Vec3::X,
    Vec3::NEG_X,
    Vec3::Z,
    Vec3::NEG_Z,
    Vec3::NEG_Y,
];
/// Rays from a place that measure its openness.
const PROBE_RAYS: usize = 16;
/// Weights of rays that reach something and that reach the sky: over a roof nothing is heard of what is below.
const OPEN: usize = 2;
const SKY: usize = 1;
/// Sufficient openness: less than half of all rays, since sounds may stand before a wall; more than just over a roof.
const ENOUGH: usize = 14;
/// Length from which on a ray counts as free, m.
const OPEN_M: f32 = 0.1;
const TURNS_A_LOOK: f32 = 0.618_034;
/// Distance of the neighbours whose least free-path score is that of a place, m: on a surface rounding decides on which side a point is.
const GRAZE_M: f32 = 1e-3;

/// Returns the least free-path score at `place` and around it.
fn min_free_path_score_around(rays: &RayScene, place: Vec3) -> usize {
    let open = free_path_score_at(rays, place);
    if open < ENOUGH {
        return open;
    }
    let beside = SEARCH_DIRECTIONS.map(|way| free_path_score_at(rays, place + way * GRAZE_M));
    beside.into_iter().fold(open, usize::min)
}

fn free_path_score_at(rays: &RayScene, place: Vec3) -> usize {
    let look = |k: usize| {
        let y = 1.0 - (2 * k + 1) as f32 / PROBE_RAYS as f32;
        let (s, c) = sin_cos(TAU * TURNS_A_LOOK * k as f32);
        let r = (1.0 - y * y).sqrt();
        let direction = Vec3::new(r * c, y, r * s);
        let ray = Ray::new(place, direction);
        let near = Ray {
            far_m: OPEN_M,
            ..ray
        };
        if rays.occluded(&near, RayMask::EAR) {
            return 0;
        }
        match rays.occluded(&ray, RayMask::EAR) {
            true => OPEN,
            // What is below all floors is the ground.
            false if y > 0.0 => SKY,
            false => 0,
        }
    };
    (0..PROBE_RAYS).map(look).sum()
}

/// The place in the air at or beside `place` from which a sound there is heard: the first that is open enough, else the most open.
pub(crate) fn nearest_open_air_point(rays: &RayScene, place: Vec3) -> Vec3 {
    let mut best = (min_free_path_score_around(rays, place), place);
    for beside in STEPS_M.map(|step_m| SEARCH_DIRECTIONS.map(|way| place + way * step_m)) {
        for place in beside {
            if best.0 >= ENOUGH {
                return best.1;
            }
            let open = min_free_path_score_around(rays, place);
            if open > best.0 {
                best = (open, place);
            }
        }
    }
    best.1
}

/// The points from which the house's own sounds are heard, in the frames of their parts, m: things' meshes are closed around many of
/// them. Shape (emitter,).
pub(crate) fn emission_points(house: &Arc<House>) -> Vec<Vec3> {
    let rays = RayScene::new(house.clone());
    let place = |emitter: &SoundEmitter| {
        let pose = house.parts[emitter.part].world_from_part;
        let clear = nearest_open_air_point(&rays, pose.transform_point(emitter.position));
        pose.inverse().transform_point(clear)
    };
    house.emitters.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;

    #[test]
    fn what_lies_on_a_surface_is_heard_from_before_it() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let rays = RayScene::new(Arc::new(house));
        let inside = |place: Vec3| {
            let size = Vec3::new(4.0, 3.0, 5.0);
            place.cmpgt(Vec3::ZERO).all() && place.cmplt(size).all()
        };
        for place in [
            Vec3::new(2.0, 0.0, 2.0),
            Vec3::new(2.0, -1e-5, 2.0),
            Vec3::new(2.0, -2e-2, 2.0),
            Vec3::new(2.0, 3.0, 2.0),
            Vec3::new(0.0, 1.0, 2.0),
            Vec3::new(4.0, 1.0, 2.0),
            Vec3::new(4.02, 1.0, 2.0),
            Vec3::new(1.0, 1.0, 0.0),
        ] {
            let clear = nearest_open_air_point(&rays, place);
            assert!(inside(clear), "{place}: {clear}");
            assert!(clear.distance(place) < 0.1, "{place}: {clear}");
        }
    }

    /// Clocks and kettles sound from their middles, which are within them.
    #[test]
    fn things_are_heard_from_beside_them() {
        let mut within = 0;
        for name in ["builtin:apartment", "builtin:studio", "seed:7", "seed:12"] {
            let house = Arc::new(dwell_houses::open(name).unwrap().0);
            let rays = RayScene::new(house.clone());
            for (emitter, place) in house.emitters.iter().zip(emission_points(&house)) {
                let pose = house.parts[emitter.part].world_from_part;
                let told = pose.transform_point(emitter.position);
                within += usize::from(min_free_path_score_around(&rays, told) < ENOUGH);
                let place = pose.transform_point(place);
                let object = &house.objects[emitter.object].name;
                assert!(
                    min_free_path_score_around(&rays, place) >= ENOUGH,
                    "{name}: {object}"
                );
                assert!(place.distance(told) < 0.2, "{name}: {object}");
            }
        }
        assert!(within > 3, "{within}");
    }

    #[test]
    fn what_stands_in_the_air_stays() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let rays = RayScene::new(Arc::new(house));
        for place in [Vec3::new(2.0, 1.0, 2.0), Vec3::new(2.0, 5e-3, 2.0)] {
            assert_eq!(nearest_open_air_point(&rays, place), place);
        }
    }
}
