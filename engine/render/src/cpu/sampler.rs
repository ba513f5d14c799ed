//! Sample points, directions and facets of even distribution, by pixel and sample; the same each time.

use dwell_scene::math;
use glam::Vec3;
use std::f32::consts::TAU;

/// Steps of the sequence of M. Roberts, *The unreasonable effectiveness of quasirandom sequences* (2018): 1 / g and 1 / g² of g³ = g + 1.
const STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];
/// Samples whose order is mixed.
const MIXED: u32 = 15;

/// Numbers of one sample of one pixel.
pub(super) struct PixelSampler {
    pixel: u32,
    sample: u32,
    draw: u32,
}

impl PixelSampler {
    pub(super) fn new((column, row): (usize, usize), sample: usize) -> Self {
        Self {
            pixel: pcg_hash(column as u32 ^ pcg_hash(row as u32)),
            sample: sample as u32,
            draw: 0,
        }
    }

    /// Two numbers from 0 up to 1: over all samples of a pixel evenly spread, each pixel's shifted by its own.
    #[inline]
    pub(super) fn uniform_pair(&mut self) -> (f32, f32) {
        self.draw += 1;
        let shift = pcg_hash(self.pixel ^ pcg_hash(self.draw));
        // Draws of one sample would be correlated if all took the samples in one order.
        let place = (self.sample ^ (pcg_hash(self.draw) & MIXED)) as f32;
        let part = |bits: u32, step: f32| {
            let number = f32::from(bits as u16) * (1.0 / 65536.0) + place * step;
            number - number.floor()
        };
        (part(shift, STEPS[0]), part(shift >> 16, STEPS[1]))
    }

    /// A direction on the side of a normal, as likely as its cosine.
    pub(super) fn cosine_hemisphere(&mut self, normal: Vec3) -> Vec3 {
        let (u, v) = self.uniform_pair();
        let (across, along) = normal.any_orthonormal_pair();
        let (radius, turn) = (u.sqrt(), v * TAU);
        let up = (1.0 - u).max(0.0).sqrt();
        across * (radius * math::cos(turn)) + along * (radius * math::sin(turn)) + normal * up
    }

    /// A direction in the cone around another, evenly over the disc that it shows. `radius`: the tangent of half its angle.
    pub(super) fn uniform_cone(&mut self, direction: Vec3, radius: f32) -> Vec3 {
        let (u, v) = self.uniform_pair();
        let (across, along) = direction.any_orthonormal_pair();
        let (aside, turn) = (radius * u.sqrt(), v * TAU);
        let off = across * math::cos(turn) + along * math::sin(turn);
        (direction + off * aside).normalize_or(direction)
    }

    /// A point in a ball of radius 1.
    pub(super) fn uniform_ball(&mut self) -> Vec3 {
        let ((u, v), (w, _)) = (self.uniform_pair(), self.uniform_pair());
        let up = 2.0 * u - 1.0;
        let (level, turn) = ((1.0 - up * up).max(0.0).sqrt(), v * TAU);
        let direction = Vec3::new(level * math::cos(turn), up, level * math::sin(turn));
        direction * math::pow(w, 1.0 / 3.0)
    }

    /// The normal of a facet of a rough surface: tan² of its slope is a² u / (1 - u), with a the square of the roughness.
    pub(super) fn sample_microfacet_normal(&mut self, normal: Vec3, roughness: f32) -> Vec3 {
        let (u, v) = self.uniform_pair();
        let slope = roughness * roughness * (u / (1.0 - u).max(1e-6)).sqrt();
        let (across, along) = normal.any_orthonormal_pair();
        let turn = v * TAU;
        let aside = across * math::cos(turn) + along * math::sin(turn);
        (normal + aside * slope).normalize_or(normal)
    }
}

/// Bits without a pattern. Source: M. Jarzynski and M. Olano, JCGT 9 (2020), 3: the permutation of PCG.
fn pcg_hash(bits: u32) -> u32 {
    let state = bits.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(draw: impl Fn(&mut PixelSampler) -> Vec3) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for pixel in 0..4096 {
            for sample in 0..16 {
                sum += draw(&mut PixelSampler::new((pixel % 64, pixel / 64), sample));
            }
        }
        sum / 65536.0
    }

    /// Means of 65,536 draws against their integrals; errors of plain chance would be 0.003.
    #[test]
    fn throws_are_even() {
        let normal = Vec3::new(0.48, 0.6, -0.64);
        let pair = all(|sampler| {
            let (u, v) = sampler.uniform_pair();
            Vec3::new(u, v, u * v)
        });
        assert!(
            (pair - Vec3::new(0.5, 0.5, 0.25)).abs().max_element() < 0.005,
            "{pair}"
        );
        // The mean cosine of directions as likely as their cosine is 2/3.
        let cosine = all(|sampler| sampler.cosine_hemisphere(normal));
        assert!((cosine - normal * (2.0 / 3.0)).length() < 0.005, "{cosine}");
        // The mean square of the tangent over a disc is half of that at its rim.
        let tangent = all(|sampler| {
            let cosine = sampler.uniform_cone(normal, 0.2).dot(normal);
            Vec3::splat(1.0 / (cosine * cosine) - 1.0)
        });
        assert!((tangent.x - 0.02).abs() < 2e-4, "{tangent}");
        let ball = all(PixelSampler::uniform_ball);
        assert!(ball.length() < 0.006, "{ball}");
        // The mean square distance from the middle of a ball is 3/5.
        let square = all(|sampler| Vec3::splat(sampler.uniform_ball().length_squared()));
        assert!((square.x - 0.6).abs() < 0.005, "{square}");
        // Half of all facets are steeper than a.
        let steep = all(|sampler| {
            let facet = sampler.sample_microfacet_normal(normal, 0.5);
            let cosine = facet.dot(normal);
            let tangent = (1.0 / (cosine * cosine) - 1.0).max(0.0).sqrt();
            Vec3::splat(f32::from(u8::from(tangent > 0.25)))
        });
        assert!((steep.x - 0.5).abs() < 0.01, "{steep}");
    }
}
