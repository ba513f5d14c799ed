//! Visibility of image sources: the path back through the mirrors, in double precision and against the BVH.

use crate::echogram::PropagationPath;
use crate::propagation_scene::PropagationScene;
use crate::ray_margin::ray_offset_m;
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::{DVec3, Vec3};

/// Largest distance between a reflection point and the surface that a ray finds, m.
const TOLERANCE_M: f32 = 2e-3;

pub(super) struct ImageValidator<'a> {
    data: &'a PropagationScene,
    rays: &'a RayScene,
    source: DVec3,
    receiver: DVec3,
}

impl<'a> ImageValidator<'a> {
    pub(super) fn new(
        data: &'a PropagationScene,
        rays: &'a RayScene,
        source: Vec3,
        receiver: Vec3,
    ) -> Self {
        Self {
            data,
            rays,
            source: source.as_dvec3(),
            receiver: receiver.as_dvec3(),
        }
    }

    /// Returns the path from the source over `planes` to the receiver, if it exists. `images`: the source's image behind each.
    ///
    /// # Source
    /// J. B. Allen, D. A. Berkley, JASA 65, 943 (1979) for the amplitudes; visibility after L. Savioja, U. P. Svensson,
    /// JASA 138, 708 (2015), section III.A.
    pub(super) fn path(&self, planes: &[u32], images: &[DVec3]) -> Option<PropagationPath> {
        let mut points = [DVec3::ZERO; 8];
        let order = planes.len();
        if order > points.len() {
            return None;
        }
        // Geometry first: it rejects nearly all candidates without a ray.
        let mut target = self.receiver;
        for k in (0..order).rev() {
            let plane = self.data.planes().get(planes[k] as usize)?;
            let (here, there) = (plane.distance_m(target), plane.distance_m(images[k]));
            if here * there >= 0.0 {
                return None;
            }
            let point = target + (images[k] - target) * (here / (here - there));
            if !plane.bounds.grown(0.01).contains(point.as_vec3()) {
                return None;
            }
            points[k] = point;
            target = point;
        }
        let length_m = images.last()?.distance(self.receiver);
        let mut energy = self.data.air_energy_loss(length_m);
        let mut from = self.receiver;
        let mut leaves_surface = false;
        for k in (0..order).rev() {
            let hit = self.leg(from, points[k], leaves_surface)?;
            if self
                .data
                .plane_table()
                .plane_of_hit(self.data.house(), &hit)
                != planes[k]
            {
                return None;
            }
            let surface = self.rays.surface(&hit);
            let material = self.data.surface(surface.material);
            let incoming = (from - points[k]).normalize_or_zero().as_vec3();
            let cosine = incoming.dot(surface.normal).abs();
            // The distance from the source, unfolded.
            let straight_m = images[k].distance(points[k]);
            let scattering = self.data.scattering(material, &hit, cosine, straight_m);
            // Allen and Berkley's product over mirrors, of energy: (1 - alpha)(1 - s).
            let factors = material.absorption.iter().zip(scattering);
            for (e, (absorption, scattering)) in energy.iter_mut().zip(factors) {
                *e *= f64::from(1.0 - absorption) * (1.0 - f64::from(scattering));
            }
            from = points[k];
            leaves_surface = true;
        }
        let last = Self::segment(from, self.source, leaves_surface, true);
        if self.rays.occluded(&last, RayMask::EAR) || energy.iter().all(|e| *e == 0.0) {
            return None;
        }
        let towards = |from: DVec3, to: DVec3| (to - from).normalize_or_zero().as_vec3();
        Some(PropagationPath {
            planes: planes.to_vec(),
            diffraction_points: Vec::new(),
            length_m,
            energy: energy.map(|e| e as f32),
            arrival: towards(self.receiver, points[order - 1]),
            departure: towards(self.source, points[0]),
            walls: 0,
            inverted: false,
        })
    }

    /// Returns the surface at `to`, if it is the first that a ray from `from` hits.
    fn leg(&self, from: DVec3, to: DVec3, leaves_surface: bool) -> Option<Hit> {
        let ray = Self::segment(from, to, leaves_surface, false);
        let hit = self.rays.closest(&ray, RayMask::EAR)?;
        let length = from.distance(to) as f32;
        let tolerance = TOLERANCE_M.max(1e-5 * length);
        ((hit.distance_m - length).abs() <= tolerance).then_some(hit)
    }

    fn segment(from: DVec3, to: DVec3, leaves_surface: bool, ends_free: bool) -> Ray {
        let (start, length) = (from.as_vec3(), from.distance(to) as f32);
        let near = if leaves_surface {
            ray_offset_m(start)
        } else {
            0.0
        };
        let far = if ends_free {
            (length - 1e-4).max(near)
        } else {
            length + TOLERANCE_M.max(1e-5 * length)
        };
        Ray::new(start, (to - from).as_vec3()).with_range(near, far)
    }
}
