//! Indirect light in rooms.

use super::openings::{LightPortal, WindowLight, openings};
use super::outdoor::OutdoorLight;
use super::room_grid::RoomGrid;
use crate::material::ShadingMaterial;
use crate::texture::Textures;
use dwell_scene::{House, Id, RoomId, State};
use glam::Vec3;
use std::f32::consts::PI;

/// Luminance of the sky of a house without a stated one, cd/m²: an overcast sky that gives about 8,000 lx in the open.
const SKY_LUMINANCE_CD_M2: f32 = 2500.0;
/// Albedo of the ground before such a house.
const GROUND: f32 = 0.2;
/// Transmittance of window panes.
pub(crate) const PANE_TRANSMITTANCE: f32 = 0.7;
/// Illuminance by the sun of a house without a stated sky, on a surface across its rays behind a pane, lx: a low sun behind
/// thin cloud.
const SUN_LX: f32 = 2500.0;
/// Direction to that sun: 36 degrees high, between the axes, so that it enters houses however they stand.
pub(super) const DEFAULT_SUN_DIRECTION: Vec3 = Vec3::new(0.485, 0.588, 0.647);
/// Illuminance that even a dark room has, lx: light through gaps and from appliances that are not modelled.
const RESIDUAL_LX: f32 = 15.0;
/// Factor by which furniture lowers the walls' reflectance.
const FURNITURE: f32 = 0.85;
/// Transmittance of a closed door: gaps and glass.
const CLOSED_DOOR: f32 = 0.1;
/// Share of the walls' tint in the light of their room: light of one colour meets things of other colours, too.
const TINT: f32 = 0.5;
/// Rounds in which rooms exchange light.
const ROUNDS: usize = 24;

/// The constant part of a house's light.
#[derive(Debug)]
pub(crate) struct StaticLighting {
    pub(crate) grid: RoomGrid,
    /// The open air, if the house knows its own.
    pub(crate) outdoor: Option<OutdoorLight>,
    /// Direction to the sun, and its illuminance behind a pane across its rays, lx.
    pub(crate) sun: (Vec3, Vec3),
    /// Windows by room.
    pub(crate) windows: Vec<WindowLight>,
    /// The first window of each room, and the end of the last room's. Shape (room + 1,).
    pub(super) window_starts: Vec<usize>,
    passages: Vec<LightPortal>,
    /// Shape (room,).
    rooms: Vec<RoomReflectance>,
}

/// The surfaces around a room.
#[derive(Clone, Copy, Debug)]
struct RoomReflectance {
    /// m².
    area_m2: f32,
    /// Mean reflectance for red, green and blue.
    reflectance: Vec3,
}

/// The light in a room.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoomLight {
    /// Illuminance by reflected light from all around, lx.
    pub(crate) indirect: Vec3,
    /// Mean illuminance of its surfaces, lx.
    pub(crate) mean: f32,
}

impl StaticLighting {
    pub(crate) fn new(house: &House, looks: &[ShadingMaterial], textures: &Textures) -> Self {
        let grid = RoomGrid::new(house);
        let air = house.sky.as_ref().map(OutdoorLight::new);
        let luminance = |outwards: Vec3| {
            let Some(air) = &air else {
                return [1.0, GROUND].map(|part| Vec3::splat(part * SKY_LUMINANCE_CD_M2));
            };
            // The two halves of a window's view, as if evenly bright.
            let mean = |lx: Vec3, share: f32| lx / (PI * share.max(0.05));
            let up = 0.5 + 0.5 * outwards.y;
            [
                mean(air.sky_illuminance(outwards), up),
                mean(air.ground_illuminance(outwards), 1.0 - up),
            ]
        };
        let (mut windows, passages) = openings(house, &grid, luminance);
        let sun = air
            .as_ref()
            .map_or((DEFAULT_SUN_DIRECTION, Vec3::splat(SUN_LX)), |air| {
                (air.to_sun, air.sun_lx * PANE_TRANSMITTANCE)
            });
        windows.sort_by_key(|window| window.room);
        let start = |room: usize| windows.partition_point(|window| window.room < room);
        let window_starts = (0..=house.rooms.len()).map(start).collect();
        let rooms = house
            .rooms
            .ids()
            .map(|id| RoomReflectance::new(house, id, looks, textures))
            .collect();
        Self {
            grid,
            outdoor: air,
            sun,
            windows,
            window_starts,
            passages,
            rooms,
        }
    }

    /// The windows of a room.
    #[inline]
    pub(crate) fn windows_of(&self, room: usize) -> &[WindowLight] {
        &self.windows[self.window_starts[room]..self.window_starts[room + 1]]
    }

    /// Returns the openness of each passage between rooms, 0 to 1.
    pub(super) fn passage_openness(
        &self,
        house: &House,
        state: &State,
    ) -> impl Iterator<Item = f32> {
        let passages = self.passages.iter();
        passages.map(|passage| state.openness(house, passage.door).unwrap_or(1.0))
    }

    /// The light in every room when lamps send `flux_lm` into each. `sunlit`: the sunlit share of each window.
    ///
    /// # Source
    /// The equation of the integrating sphere, E A (1 - r) = `flux`, whose indirect part is what walls throw back; e.g.
    /// J. W. T. Walsh, *Photometry* (1926). Of the light on an opening of area S all goes into the other room: E (A (1 - r) + S) =
    /// `flux` + S E of the other, so that walls take what lamps send out and no more.
    pub(crate) fn solve_room_light(
        &self,
        house: &House,
        state: &State,
        flux_lm: &mut [Vec3],
        sunlit: &[f32],
        light: &mut Vec<RoomLight>,
    ) {
        for (k, window) in self.windows.iter().enumerate() {
            let area_m2 = window.area_m2();
            let outwards = -window.normal;
            let lx = if let Some(air) = &self.outdoor {
                air.sky_illuminance(outwards) + air.ground_illuminance(outwards)
            } else {
                // A vertical window sees half the sky, a roof window all of it.
                let up = 0.5 + 0.5 * outwards.y;
                Vec3::splat(PI * SKY_LUMINANCE_CD_M2 * (up + (1.0 - up) * GROUND))
            };
            let (to_sun, behind_pane_lx) = self.sun;
            let across = outwards.dot(to_sun).max(0.0);
            // A house that says nothing of its sky stands free.
            let share = sunlit.get(k).copied().unwrap_or(1.0);
            flux_lm[window.room] +=
                (lx * PANE_TRANSMITTANCE + behind_pane_lx * (across * share)) * area_m2;
        }
        let taken = |walls: &RoomReflectance| walls.area_m2 * (Vec3::ONE - walls.reflectance);
        let areas: Vec<f32> = self
            .passages
            .iter()
            .zip(self.passage_openness(house, state))
            .map(|(passage, open)| passage.area_m2 * (CLOSED_DOOR + (1.0 - CLOSED_DOOR) * open))
            .collect();
        let all = exchange_light(
            flux_lm,
            &self.rooms.iter().map(taken).collect::<Vec<_>>(),
            &self
                .passages
                .iter()
                .map(|passage| passage.rooms)
                .zip(areas)
                .collect::<Vec<_>>(),
        );
        light.clear();
        light.extend((0..self.rooms.len()).map(|room| {
            let all = all[room] + RESIDUAL_LX;
            let indirect = all - flux_lm[room] / self.rooms[room].area_m2;
            RoomLight {
                indirect: indirect.max(Vec3::splat(RESIDUAL_LX)),
                mean: luminance(all),
            }
        }));
    }
}

/// The mean illuminance of rooms that exchange light, lx. `flux_lm`: the flux into each; `taken_m2`: the flux that walls absorb at unit
/// illuminance; `openings`: the two rooms of each, and its area, m².
fn exchange_light(
    flux_lm: &[Vec3],
    taken_m2: &[Vec3],
    openings: &[([usize; 2], f32)],
) -> Vec<Vec3> {
    let mut given = taken_m2.to_vec();
    for ([a, b], area) in openings {
        given[*a] += *area;
        given[*b] += *area;
    }
    let mut mean: Vec<Vec3> = flux_lm.iter().zip(taken_m2).map(|(f, t)| *f / *t).collect();
    for _ in 0..ROUNDS {
        let mut sum = flux_lm.to_vec();
        for ([a, b], area) in openings {
            sum[*a] += mean[*b] * *area;
            sum[*b] += mean[*a] * *area;
        }
        for ((mean, sum), given) in mean.iter_mut().zip(sum).zip(&given) {
            *mean = sum / *given;
        }
    }
    mean
}

/// Photometric weight of linear sRGB (IEC 61966-2-1: the Y row of its matrix).
pub(crate) fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

impl RoomReflectance {
    fn new(house: &House, id: RoomId, looks: &[ShadingMaterial], textures: &Textures) -> Self {
        let room = &house.rooms[id];
        let floor = room.area_m2().max(0.5);
        let height = (room.ceiling_y - room.floor_y).clamp(1.0, 20.0);
        // The rim of a rectangle of sides 1 to 1.5.
        let area_m2 = 2.0 * floor + 4.1 * floor.sqrt() * height;
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for piece in house
            .structure
            .iter()
            .filter(|piece| piece.room == Some(id))
        {
            let mesh = &house.meshes[piece.mesh];
            for k in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(k);
                let area = (b - a).cross(c - a).length() * 0.5;
                let material = piece.materials[usize::from(mesh.slot(k))];
                let mean = mean_color(&looks[material.index()], textures);
                sum += mean * area;
                weight += area;
            }
        }
        let reflectance = if weight > 0.0 {
            sum / weight
        } else {
            Vec3::splat(0.5)
        };
        let reflectance = Vec3::splat(luminance(reflectance)).lerp(reflectance, TINT);
        Self {
            area_m2,
            reflectance: (reflectance * FURNITURE).clamp(Vec3::splat(0.02), Vec3::splat(0.8)),
        }
    }
}

/// The mean colour of a material, in linear light.
fn mean_color(look: &ShadingMaterial, textures: &Textures) -> Vec3 {
    let base = Vec3::from_array(look.base);
    look.texture().map_or(base, |texture| {
        let whole = textures.sample(texture, glam::Vec2::ZERO, 1e12);
        base * whole.truncate()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walls take what lamps send out and no more, however wide the openings; two rooms without a wall between them are one.
    #[test]
    fn rooms_exchange_light_without_gain_or_loss() {
        let flux = [Vec3::splat(3000.0), Vec3::ZERO, Vec3::new(0.0, 500.0, 0.0)];
        let taken = [
            Vec3::splat(12.0),
            Vec3::splat(12.0),
            Vec3::new(5.0, 8.0, 9.0),
        ];
        for area in [0.2, 1.8, 10.0] {
            let mean = exchange_light(&flux, &taken, &[([0, 1], area), ([1, 2], area)]);
            let all = mean.iter().zip(&taken).map(|(e, a)| *e * *a).sum::<Vec3>();
            let sent: Vec3 = flux.iter().sum();
            assert!(
                ((all - sent) / sent).abs().max_element() < 0.02,
                "{area}: {all}"
            );
            assert!(mean[0].x > mean[1].x && mean[1].x > mean[2].x, "{mean:?}");
        }
        // The exact solution for two rooms: E2 / E1 = S / (A (1 - r) + S).
        let mean = exchange_light(&flux[..2], &taken[..2], &[([0, 1], 1.8)]);
        assert!(
            (mean[1].x / mean[0].x - 1.8 / 13.8).abs() < 1e-4,
            "{mean:?}"
        );
    }
}
