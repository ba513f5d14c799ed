//! Sounds come from the air around a thing, not from within it.
//!
//! What touches does so on surfaces, and a point on a surface, or a hundredth of a millimetre behind it, would send half of its sound
//! or all of it into the ground.

use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::sin_cos;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use std::f32::consts::TAU;

/// How far a sound is moved at most: in turn as little as will do, m.
const STEPS_M: [f32; 3] = [0.03, 0.08, 0.16];
/// Where to: upwards first, since most things lie on something.
const WAYS: [Vec3; 6] = [
    Vec3::Y,
    Vec3::X,
    Vec3::NEG_X,
    Vec3::Z,
    Vec3::NEG_Z,
    Vec3::NEG_Y,
];
/// Rays that look around from a place, and how many of them must be free: less than half, since sounds may stand before a wall.
const LOOKS: usize = 16;
const FREE_LOOKS: usize = 6;
/// A way is free that leads so far, m.
const FREE_M: f32 = 0.1;
const TURNS_A_LOOK: f32 = 0.618_034;

/// How many of the ways from `place` are free.
fn free_looks(rays: &RayScene, place: Vec3) -> usize {
    let is_free = |k: &usize| {
        let y = 1.0 - (2 * k + 1) as f32 / LOOKS as f32;
        let (s, c) = sin_cos(TAU * TURNS_A_LOOK * *k as f32);
        let r = (1.0 - y * y).sqrt();
        let direction = Vec3::new(r * c, y, r * s);
        match rays.closest(&Ray::new(place, direction), RayMask::EAR) {
            Some(hit) => hit.distance_m > FREE_M,
            // The sky is free; what is below all floors is the ground.
            None => y > 0.0,
        }
    };
    (0..LOOKS).filter(is_free).count()
}

/// The place in the air at or beside `place` from which a sound there is heard; `place` itself where none is found.
pub(crate) fn clear_of_surfaces(rays: &RayScene, place: Vec3) -> Vec3 {
    if free_looks(rays, place) >= FREE_LOOKS {
        return place;
    }
    let beside = STEPS_M
        .iter()
        .flat_map(|step_m| WAYS.map(|way| place + way * *step_m));
    beside
        .into_iter()
        .find(|place| free_looks(rays, *place) >= FREE_LOOKS)
        .unwrap_or(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{House, ShoeboxMaterials};
    use std::sync::Arc;

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
            let clear = clear_of_surfaces(&rays, place);
            assert!(inside(clear), "{place}: {clear}");
            assert!(clear.distance(place) < 0.1, "{place}: {clear}");
        }
    }

    /// What the catalogue's things sound with is not within them.
    #[test]
    fn emitters_stand_in_the_air() {
        let mut within = Vec::new();
        for name in [
            "builtin:apartment",
            "builtin:studio",
            "seed:3",
            "seed:7",
            "seed:12",
        ] {
            let house = Arc::new(dwell_houses::open(name).unwrap().0);
            let rays = RayScene::new(house.clone());
            for emitter in &house.emitters {
                let pose = house.parts[emitter.part].world_from_part;
                let place = pose.transform_point(emitter.position);
                let free = free_looks(&rays, place);
                if free < FREE_LOOKS {
                    let object = &house.objects[emitter.object].name;
                    within.push(format!(
                        "{name} {object} {} {place}: {free}",
                        emitter.signal
                    ));
                }
            }
        }
        assert!(within.is_empty(), "{within:#?}");
    }

    #[test]
    fn what_stands_in_the_air_stays() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let rays = RayScene::new(Arc::new(house));
        for place in [Vec3::new(2.0, 1.0, 2.0), Vec3::new(2.0, 1e-3, 2.0)] {
            assert_eq!(clear_of_surfaces(&rays, place), place);
        }
    }
}
