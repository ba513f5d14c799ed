//! Incident light on a point, by shadow caster.

use super::indirect::luminance;
use glam::Vec3;

/// A source of light that a shadow ray may find occluded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightSource {
    /// No source.
    None,
    /// Light reflected by the walls of a room.
    RoomWalls,
    /// The whole open sky.
    Sky,
    /// The sky in a window: a position in [`super::HouseLight::windows`].
    Window(u32),
    /// The sun.
    Sun,
    /// A position in [`super::Lighting::casters`].
    LampCluster(u32),
}

/// Light of one source.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SourceContribution {
    pub(crate) source: LightSource,
    /// In units of display white.
    pub(crate) light: Vec3,
}

impl SourceContribution {
    const NONE: Self = Self {
        source: LightSource::None,
        light: Vec3::ZERO,
    };
}

/// Incident light on a point: that of its `N` strongest sources apart, each with a shadow ray; the rest arrives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IncidentLight<const N: usize> {
    /// The light that arrives, in units of display white.
    pub(crate) light: Vec3,
    pub(crate) rays: [SourceContribution; N],
}

impl<const N: usize> IncidentLight<N> {
    pub(crate) const NONE: Self = Self {
        light: Vec3::ZERO,
        rays: [SourceContribution::NONE; N],
    };

    /// Only light that arrives.
    pub(crate) fn unshadowed(light: Vec3) -> Self {
        Self {
            light,
            ..Self::NONE
        }
    }

    /// Adds a source; the weakest of more than `N` counts as arriving.
    pub(super) fn add_source(&mut self, source: LightSource, light: Vec3) {
        if !matches!(source, LightSource::Sun | LightSource::LampCluster(_)) {
            self.light += light;
            return;
        }
        let strength = luminance(light);
        if strength <= 0.0 {
            return;
        }
        let (mut weakest, mut least) = (0, f32::INFINITY);
        for (k, ray) in self.rays.iter().enumerate() {
            let found = luminance(ray.light);
            if found < least {
                (weakest, least) = (k, found);
            }
        }
        if strength > least {
            let ray = std::mem::replace(
                &mut self.rays[weakest],
                SourceContribution { source, light },
            );
            self.light += ray.light;
        } else {
            self.light += light;
        }
    }

    /// The light that a surface of that reflectance reflects.
    pub(crate) fn reflected_by(mut self, color: Vec3) -> Self {
        self.light *= color;
        for ray in &mut self.rays {
            ray.light *= color;
        }
        self
    }

    /// All light that arrives.
    pub(crate) fn total_arriving(&self, mut arrives: impl FnMut(LightSource) -> bool) -> Vec3 {
        self.rays.iter().fold(self.light, |sum, ray| {
            if ray.source != LightSource::None && arrives(ray.source) {
                sum + ray.light
            } else {
                sum
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strongest_sources_are_asked_and_the_rest_arrives() {
        let mut incoming = IncidentLight::<2>::unshadowed(Vec3::ONE);
        let lights = [3.0, 1.0, 5.0, 2.0, 4.0];
        for (k, light) in lights.into_iter().enumerate() {
            incoming.add_source(LightSource::LampCluster(k as u32), Vec3::splat(light));
        }
        incoming.add_source(LightSource::Sun, Vec3::ZERO);
        let mut asked = Vec::new();
        let none = incoming.total_arriving(|source| {
            asked.push(source);
            false
        });
        asked.sort_by_key(|source| format!("{source:?}"));
        assert_eq!(
            asked,
            [LightSource::LampCluster(2), LightSource::LampCluster(4)]
        );
        assert_eq!(none, Vec3::splat(1.0 + 3.0 + 1.0 + 2.0));
        let all = incoming
            .reflected_by(Vec3::splat(0.5))
            .total_arriving(|_| true);
        assert_eq!(all, Vec3::splat(8.0));
    }
}
