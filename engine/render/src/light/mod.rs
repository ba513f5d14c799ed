//! The light of [`Preset::Lit`](crate::Preset): lamps, daylight through windows, and indirect light of rooms.

mod cache_key;
mod gpu_layout;
mod incoming;
mod indirect;
mod lamp_clusters;
mod lamps;
mod openings;
mod outdoor;
mod room_grid;
mod tone;

pub(crate) use cache_key::LightingInputs;
pub(crate) use incoming::{IncidentLight, LightSource};
pub(crate) use indirect::StaticLighting;
pub(crate) use lamp_clusters::LampCluster;
pub(crate) use tone::tone_map;

use cache_key::LightingCacheKey;
use glam::Vec3;
use indirect::{DEFAULT_SUN_DIRECTION, PANE_TRANSMITTANCE, RoomLight};
use lamps::{PointLamp, add_lamps};
use openings::WindowLight;
use std::f32::consts::PI;

/// Width of the border of sunlit patches, m.
const PENUMBRA_M: f32 = 0.03;
/// Points along an edge of a window at which the sun is looked for.
const SUN_POINTS: u32 = 4;
/// Distance of those points from the middle of the window, m: beyond the wall that it stands in.
const BEFORE_PANE_M: f32 = 0.25;
/// Distances from a surface at which its room is looked up, m: off the skin of the wall that it belongs to, and towards the viewer,
/// who sees it from its room.
const OFF_SURFACE_M: [f32; 2] = [0.1, 0.2];
/// Radius of a bulb in its shade, m.
const BULB_M: f32 = 0.05;
/// Pixel value of white in the open, in units of display white: the open has an exposure of its own.
const OPEN_AIR: f32 = 1.3;

/// Luminance of a plain sky on a lit picture, relative to a flat one: tone mapping darkens it again.
const LIT_SKY: f32 = 2.5;

/// All light of a house in one state.
#[derive(Debug, Default)]
pub(crate) struct Lighting {
    /// Lamps by room; those outside come first.
    lamps: Vec<PointLamp>,
    /// The first lamp of each room, those outside first, and the end of the last. Shape (room + 2,).
    lamp_starts: Vec<usize>,
    /// The shadow casters.
    casters: Vec<LampCluster>,
    /// Shape (room,).
    rooms: Vec<RoomLight>,
    flux_lm: Vec<Vec3>,
    /// The sunlit share of each window. Shape (window,), or empty.
    sunlit: Vec<f32>,
    /// The inputs of all of this.
    cache_key: LightingCacheKey,
    /// The inputs of the light of rooms, of this time and the last.
    room_inputs: [Vec<u32>; 2],
}

/// The brightness to which an eye in a room adapts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exposure {
    /// Display white per lx.
    per_lx: f32,
}

impl Lighting {
    /// Returns whether it may have been made from inputs of this hash.
    pub(crate) fn may_match(&self, hash: u64) -> bool {
        self.cache_key.may_match(hash)
    }

    /// Reads the switches and places of lamps, in the memory of an earlier state; does nothing where all is as it was then. `hash`: of
    /// the inputs. `sun_reaches`: whether nothing stands between a point and the sun. `passes`: as for [`lamp_clusters::cluster_lamps`].
    pub(crate) fn update(
        &mut self,
        inputs: &LightingInputs<'_>,
        hash: u64,
        sun_reaches: impl Fn(Vec3) -> bool,
        passes: impl Fn(Vec3, Vec3, i32) -> bool,
    ) {
        if self.cache_key.matches_or_store(inputs, hash) {
            return;
        }
        let &LightingInputs {
            house,
            fixed,
            state,
            ..
        } = inputs;
        self.sunlit.clear();
        if fixed.outdoor.is_some() {
            let windows = fixed.windows.iter();
            self.sunlit
                .extend(windows.map(|window| sunlit_fraction(window, fixed.sun, &sun_reaches)));
        }
        self.lamps.clear();
        for light in &house.lights {
            add_lamps(house, state, &fixed.grid, light, &mut self.lamps);
        }
        let place = |lamp: &PointLamp| lamp.room.map_or(0, |room| room + 1);
        self.lamps.sort_by_key(|lamp| (place(lamp), lamp.entity));
        lamp_clusters::cluster_lamps(house, &mut self.lamps, &mut self.casters, passes);
        self.lamp_starts.clear();
        for room in 0..=house.rooms.len() + 1 {
            self.lamp_starts
                .push(self.lamps.partition_point(|lamp| place(lamp) < room));
        }
        self.flux_lm.clear();
        self.flux_lm.resize(house.rooms.len(), Vec3::ZERO);
        for lamp in &self.lamps {
            if let Some(room) = lamp.room {
                self.flux_lm[room] += lamp.flux_lm;
            }
        }
        // Agents that walk change the occlusion of lamps, and rarely the indirect light of rooms.
        let [now, last] = &mut self.room_inputs;
        now.clear();
        let flux = self.flux_lm.iter().flat_map(Vec3::to_array);
        let numbers = flux.chain(self.sunlit.iter().copied());
        let numbers = numbers.chain(fixed.passage_openness(house, state));
        now.extend(numbers.map(f32::to_bits));
        if now == last {
            return;
        }
        std::mem::swap(now, last);
        fixed.solve_room_light(
            house,
            state,
            &mut self.flux_lm,
            &self.sunlit,
            &mut self.rooms,
        );
    }

    /// Returns the exposure of a camera at `eye`: by the mean light of its room, not quite to the full, so that dim rooms look
    /// dimmer than bright ones.
    pub(crate) fn exposure(&self, fixed: &StaticLighting, eye: Vec3) -> Exposure {
        let mean = if let Some(room) = fixed.grid.room_at(eye) {
            self.rooms[room].mean
        } else {
            // From outside or from above: the middle one of all rooms.
            let mut means: Vec<f32> = self.rooms.iter().map(|room| room.mean).collect();
            means.sort_by(f32::total_cmp);
            means.get(means.len() / 2).copied().unwrap_or(200.0)
        };
        Exposure {
            per_lx: tone::exposure_per_lx(mean),
        }
    }

    /// Returns the shadow caster of a source.
    pub(crate) fn lamp_cluster(&self, position: u32) -> &LampCluster {
        &self.casters[position as usize]
    }

    /// A point of a shadow caster from which light comes to `point`: in one of its lamps, as likely as that one's flux, on the
    /// side that the point sees. `pick`: which lamp and where along it, from 0 up to 1 each; `within`: in a ball of radius 1.
    pub(crate) fn sample_point_in_cluster(
        &self,
        caster: &LampCluster,
        point: Vec3,
        pick: (f32, f32),
        within: Vec3,
    ) -> Vec3 {
        let (first, count) = caster.lamps;
        let lamps = &self.lamps[first..first + count];
        let flux = |lamp: &PointLamp| indirect::luminance(lamp.flux_lm).max(1e-6);
        let mut left = pick.0 * lamps.iter().map(flux).sum::<f32>();
        let chosen = lamps.iter().find(|lamp| {
            left -= flux(lamp);
            left < 0.0
        });
        let lamp = chosen.unwrap_or(&lamps[count - 1]);
        // A bulb below the ceiling is not seen through it.
        let seen = if within.dot(point - lamp.position) < 0.0 {
            -within
        } else {
            within
        };
        lamp.position + lamp.half_length * (2.0 * pick.1 - 1.0) + seen * BULB_M
    }

    /// Returns the light on a surface of reflectance 1, for red, green and blue: of its strongest sources apart, before shadows.
    #[inline]
    pub(crate) fn incident_light<const N: usize>(
        &self,
        fixed: &StaticLighting,
        exposure: Exposure,
        site: &ShadingPoint,
    ) -> IncidentLight<N> {
        let mut incoming = IncidentLight::NONE;
        self.for_each_source(fixed, exposure, site, |source, light| {
            incoming.add_source(source, light);
        });
        incoming
    }

    /// Passes on the light of each source on a surface of reflectance 1, in units of display white, before shadows.
    #[inline]
    pub(crate) fn for_each_source(
        &self,
        fixed: &StaticLighting,
        exposure: Exposure,
        site: &ShadingPoint,
        mut tell: impl FnMut(LightSource, Vec3),
    ) {
        let &ShadingPoint { point, normal, .. } = site;
        let room = fixed.grid.room_at(site.room_lookup_point);
        let Some(position) = room else {
            let Some(air) = &fixed.outdoor else {
                tell(LightSource::Sky, default_outdoor_radiance(normal));
                return self.lamp_illuminance(None, site, exposure.per_lx, tell);
            };
            let per_lx = air.capped_exposure(exposure.per_lx);
            let sky = air.sky_illuminance(normal) + air.ground_illuminance(normal);
            tell(LightSource::Sky, sky * per_lx);
            let across = normal.dot(air.to_sun).max(0.0);
            tell(LightSource::Sun, air.sun_lx * (across * per_lx));
            return self.lamp_illuminance(None, site, per_lx, tell);
        };
        let per_lx = exposure.per_lx;
        let indirect = self.rooms[position].indirect * orientation_factor(normal);
        tell(LightSource::RoomWalls, indirect * per_lx);
        let mut sun = 0.0_f32;
        let first = fixed.window_starts[position];
        for (k, window) in fixed.windows_of(position).iter().enumerate() {
            let (mut lx, part) = window_illuminance(window, fixed.sun.0, point, normal);
            if fixed.outdoor.is_some() {
                // Windows side by side let in one and the same sun.
                sun = sun.max(part);
            } else {
                lx += fixed.sun.1 * part;
            }
            tell(LightSource::Window((first + k) as u32), lx * per_lx);
        }
        tell(LightSource::Sun, fixed.sun.1 * (sun * per_lx));
        self.lamp_illuminance(room, site, per_lx, tell);
    }

    /// The light of a room's lamps.
    fn lamp_illuminance(
        &self,
        room: Option<usize>,
        site: &ShadingPoint,
        per_lx: f32,
        mut tell: impl FnMut(LightSource, Vec3),
    ) {
        let place = room.map_or(0, |room| room + 1);
        let mine = &self.lamps[self.lamp_starts[place]..self.lamp_starts[place + 1]];
        let (mut caster, mut sum) = (lamp_clusters::NONE, Vec3::ZERO);
        let mut all = |caster: u32, light: Vec3| {
            let source = if caster == lamp_clusters::NONE {
                LightSource::None
            } else {
                LightSource::LampCluster(caster)
            };
            tell(source, light);
        };
        for lamp in mine {
            // A shade shines by the light that passes it.
            let its = if site.entity == lamp.entity {
                lamp_clusters::NONE
            } else {
                lamp.cluster
            };
            if its != caster {
                all(caster, sum);
                (caster, sum) = (its, Vec3::ZERO);
            }
            sum += lamp.illuminance(site.point, site.normal, site.entity) * per_lx;
        }
        all(caster, sum);
    }
}

/// A point of a surface at which light is evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadingPoint {
    pub(crate) point: Vec3,
    /// Unit length, towards the viewer; interpolated between corners.
    pub(crate) normal: Vec3,
    /// The point at which its room is looked up, see [`room_lookup_point`].
    pub(crate) room_lookup_point: Vec3,
    /// The entity of the surface.
    pub(crate) entity: i32,
}

/// A point in the room from which a surface at `point` is seen. `facing`: normal of the flat triangle towards the viewer;
/// `direction`: from the viewer, unit length.
pub(crate) fn room_lookup_point(point: Vec3, facing: Vec3, direction: Vec3) -> Vec3 {
    let [off, back] = OFF_SURFACE_M;
    point + facing * off - direction * back
}

/// Returns the share of a room's indirect light that reaches a surface by its orientation, about 1: floors face bright walls and
/// ceilings, and walls that meet in a corner differ a little.
fn orientation_factor(normal: Vec3) -> f32 {
    0.95 + 0.08 * normal.y + 0.07 * normal.x + 0.03 * normal.z
}

/// Illuminance by a window, lx: the sky as a disc of the same area seen through it; and the share of the sun that the surface
/// has, where its ray passes the window.
fn window_illuminance(
    window: &WindowLight,
    to_sun: Vec3,
    point: Vec3,
    normal: Vec3,
) -> (Vec3, f32) {
    let way = window.center - point;
    let height = -window.normal.dot(way);
    if height <= 0.0 {
        return (Vec3::ZERO, 0.0);
    }
    let distance_squared = way.length_squared();
    let direction = way / distance_squared.sqrt();
    let area = window.area_m2();
    let cosines = normal.dot(direction).max(0.0) * (height / distance_squared.sqrt());
    let [up, down] = window.luminance_cd_m2;
    let luminance = down.lerp(up, (0.5 + 1.5 * direction.y).clamp(0.0, 1.0));
    let sky = luminance * PANE_TRANSMITTANCE * area * cosines / (distance_squared + area / PI);
    // Against the sun's ray: from the point back to the plane of the window.
    let against = -window.normal.dot(to_sun);
    let on_surface = normal.dot(to_sun);
    if against <= 0.01 || on_surface <= 0.0 {
        return (sky, 0.0);
    }
    let on_window = point + to_sun * (height / against) - window.center;
    let inside = window.half_edges.map(|half| {
        let length = half.length().max(1e-6);
        ((length - on_window.dot(half / length).abs()) / PENUMBRA_M).clamp(0.0, 1.0)
    });
    (sky, on_surface * inside[0] * inside[1])
}

/// Returns the sunlit share of a window, by points on it.
fn sunlit_fraction(
    window: &WindowLight,
    (to_sun, lx): (Vec3, Vec3),
    sun_reaches: impl Fn(Vec3) -> bool,
) -> f32 {
    if window.normal.dot(to_sun) >= -0.01 || lx == Vec3::ZERO {
        return 0.0;
    }
    let [across, along] = window.half_edges;
    let lit = |k: u32| {
        let place = |k: u32| (k as f32 + 0.5) * (2.0 / SUN_POINTS as f32) - 1.0;
        let (a, b) = (place(k % SUN_POINTS), place(k / SUN_POINTS));
        sun_reaches(window.center + across * a + along * b - window.normal * BEFORE_PANE_M)
    };
    let count = (0..SUN_POINTS * SUN_POINTS).filter(|k| lit(*k)).count();
    count as f32 / (SUN_POINTS * SUN_POINTS) as f32
}

/// Returns the radiance of white in the open air of a house without a sky, in units of display white.
fn default_outdoor_radiance(normal: Vec3) -> Vec3 {
    let sky = 0.35 + 0.25 * normal.y;
    let sun = 0.5 * normal.dot(DEFAULT_SUN_DIRECTION).max(0.0);
    Vec3::splat((sky + sun) * OPEN_AIR)
}

/// Returns the radiance of the background, in units of display white, along a unit direction. `light`: `None` on a flat picture.
pub(crate) fn exposed_background_luminance(
    direction: Vec3,
    light: Option<(&StaticLighting, Exposure)>,
) -> Vec3 {
    match light {
        None => plain_sky(direction),
        Some((fixed, exposure)) => match &fixed.outdoor {
            None => plain_sky(direction) * LIT_SKY,
            Some(air) => air.background_luminance(direction) * air.capped_exposure(exposure.per_lx),
        },
    }
}

/// A blue sky over grey ground.
fn plain_sky(direction: Vec3) -> Vec3 {
    let (zenith, horizon, ground) = (
        Vec3::new(0.35, 0.55, 0.9),
        Vec3::new(0.85, 0.92, 1.0),
        Vec3::new(0.42, 0.42, 0.38),
    );
    if direction.y >= 0.0 {
        horizon.lerp(zenith, direction.y.sqrt().min(1.0))
    } else {
        ground
    }
}
