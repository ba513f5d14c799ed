//! Keyed random streams: equal paths give equal numbers, and no stream affects another.
//!
//! A [`RandomKey`] is derived like a path, `RandomKey::root(seed).child("microphone").child(step)`. Two different paths give
//! independent streams; adding a sensor or a thread changes no other stream.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_128_with_seed;

/// The name of a random stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RandomKey(u128);

/// One element of a key's path: a word or a number.
#[derive(Clone, Copy, Debug)]
pub enum KeyElement<'a> {
    /// A purpose.
    Text(&'a str),
    /// A count: world, episode, step, index.
    Number(u64),
}

impl<'a> From<&'a str> for KeyElement<'a> {
    fn from(word: &'a str) -> Self {
        Self::Text(word)
    }
}

impl From<u64> for KeyElement<'_> {
    fn from(number: u64) -> Self {
        Self::Number(number)
    }
}

impl RandomKey {
    /// The key of a seed.
    pub fn root(seed: u64) -> Self {
        Self(xxh3_128_with_seed(&seed.to_le_bytes(), 0))
    }

    /// Returns the key of a child of this one.
    #[must_use]
    pub fn child<'a>(self, label: impl Into<KeyElement<'a>>) -> Self {
        // The hash's seed tells a word from a number, so that `child("a")` never equals `child(97)`.
        let parent = self.0.to_le_bytes();
        match label.into() {
            KeyElement::Text(word) => {
                let mut bytes = Vec::with_capacity(16 + word.len());
                bytes.extend_from_slice(&parent);
                bytes.extend_from_slice(word.as_bytes());
                Self(xxh3_128_with_seed(&bytes, 1))
            }
            KeyElement::Number(number) => {
                let mut bytes = [0; 24];
                bytes[..16].copy_from_slice(&parent);
                bytes[16..].copy_from_slice(&number.to_le_bytes());
                Self(xxh3_128_with_seed(&bytes, 2))
            }
        }
    }

    /// A generator at the start of this key's stream (`ChaCha8`).
    pub fn stream(self) -> RandomStream {
        let mut seed = [0; 32];
        seed[..16].copy_from_slice(&self.0.to_le_bytes());
        seed[16..].copy_from_slice(&xxh3_128_with_seed(&self.0.to_le_bytes(), 3).to_le_bytes());
        RandomStream(ChaCha8Rng::from_seed(seed))
    }
}

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct RandomStream(ChaCha8Rng);

impl RandomStream {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1), f64.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform in [0, 1), f32.
    pub fn uniform_f32(&mut self) -> f32 {
        (self.bits() >> 40) as f32 * (1.0 / (1_u32 << 24) as f32)
    }

    /// Uniform in [`low`, `high`).
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.uniform_f32()
    }

    /// Uniform in 0..`count`; 0 when `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// One of `items`; `None` when there is none.
    pub fn choose<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        items.get(self.below(items.len()))
    }

    /// Shuffles `items` (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (1..items.len()).rev() {
            items.swap(end, self.below(end + 1));
        }
    }

    /// Normal with mean 0 and variance 1.
    ///
    /// # Source
    /// G. E. P. Box, M. E. Muller, Ann. Math. Stat. 29, 610 (1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// A direction, uniform on the unit sphere.
    pub fn direction(&mut self) -> glam::Vec3 {
        let z = 2.0 * self.uniform_f32() - 1.0;
        let (s, c) = crate::math::sin_cos(std::f32::consts::TAU * self.uniform_f32());
        let r = (1.0 - z * z).max(0.0).sqrt();
        glam::Vec3::new(r * c, z, r * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_paths_give_equal_numbers_and_others_do_not() {
        let a = RandomKey::root(7).child("microphone").child(3);
        assert_eq!(a, RandomKey::root(7).child("microphone").child(3));
        assert_ne!(a, RandomKey::root(7).child("microphone").child(4));
        assert_ne!(a, RandomKey::root(8).child("microphone").child(3));
        assert_ne!(RandomKey::root(0).child("a"), RandomKey::root(0).child(97));
        assert_eq!(a.stream().bits(), a.stream().bits());
    }

    /// Mean and variance of n draws stay within 5 standard errors (two-sided p below 1e-6) for five fixed seeds.
    #[test]
    fn uniform_and_normal_have_their_moments() {
        let n = 100_000;
        for seed in 0..5 {
            let mut stream = RandomKey::root(seed).stream();
            let (mut u1, mut n1, mut n2) = (0.0, 0.0, 0.0);
            for _ in 0..n {
                u1 += stream.uniform();
                let x = stream.normal();
                n1 += x;
                n2 += x * x;
            }
            let count = f64::from(n);
            assert!((u1 / count - 0.5).abs() < 5.0 * (1.0 / 12.0_f64 / count).sqrt());
            assert!((n1 / count).abs() < 5.0 / count.sqrt());
            assert!((n2 / count - 1.0).abs() < 5.0 * (2.0 / count).sqrt());
        }
    }
}
