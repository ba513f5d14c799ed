//! Contacts, swinging joints and footsteps become sound here, and nowhere else: physics knows no sounds, the acoustics no physics.

use super::WorldSound;
use super::gait::{FootEvent, body_mass_kg};
use crate::air_position::nearest_open_air_point;
use dwell_acoustics::contact::{
    ContactPartner, ContactSound, CreakSound, FootstepSound, FrictionSound, FrictionSoundKind,
    ImpactSound,
};
use dwell_physics::{ContactEntity, ContactEvent, ContactKind, ContactPhase};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::material::library;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    AgentId, House, Id, Joint, JointId, JointKind, PartId, Pose, State, StructureKind,
};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// Impulse below which impacts are not heard, N·s.
const FAINTEST_N_S: f32 = 0.02;
/// Largest number of impacts that begin to sound in one step; the hardest win.
const MOST_BLOWS: usize = 16;
/// Largest number of pairs that scrape or roll in one step; the hardest win.
const MOST_RUBS: usize = 8;
/// Largest number of contact sounds at once; the oldest are dropped, which have decayed the most. A heap of a hundred things
/// that falls makes as many in half a second, and snapshots have a bound.
const MOST_RINGING: usize = 256;
/// Contact sounds nearer than this to where an impact is still heard are heard from there, as one source, m: what falls over
/// hits the floor many times in one place.
const ONE_SOURCE_M: f32 = 0.1;
/// First source ids of impacts, of rubbing pairs, of joints and of agents' feet.
const FIRST_BLOW_ID: u64 = 1 << 32;
const FIRST_RUB_ID: u64 = 2 << 32;
const FIRST_JOINT_ID: u64 = 3 << 32;
const FIRST_FOOT_ID: u64 = 4 << 32;

/// Least mass per area of a struck floor, since coverings lie on boards or a slab, kg/m². Walls are struck as they are.
const FLOOR_KG_M2: f32 = 120.0;
const WALL_KG_M2: f32 = 10.0;
/// Mass per area of a door's frame and a cupboard's body at a slam, kg/m²: estimate.
const FRAME_KG_M2: f32 = 40.0;
/// Speed below which no door slams, rad/s or m/s.
const SLAM_SPEED: f32 = 0.05;
/// Mass, height and closing speed of the tongue of a latch, kg, m and m/s: estimates.
const LATCH_KG: f32 = 0.05;
const LATCH_M: [f32; 3] = [0.06, 0.02, 0.01];
const LATCH_M_S: f32 = 0.5;

/// A contact sound that is still heard.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ActiveContactSound {
    pub(super) id: u64,
    pub(super) sound: ContactSound,
    /// The place in the air beside the contact, m; found when somebody listens.
    pub(super) air_position: Option<Vec3>,
    /// The sample, since the world's start, at which it begins.
    pub(super) start: u64,
    /// Samples.
    pub(super) length: u64,
    /// Made when somebody listens.
    #[serde(skip)]
    rendered: OnceLock<Vec<f32>>,
}

impl ActiveContactSound {
    /// Writes the block that begins at `start`.
    pub(super) fn read(&self, rate_hz: u32, start: u64, out: &mut [f32]) {
        let samples = self.rendered.get_or_init(|| self.sound.render(rate_hz));
        for (k, y) in out.iter_mut().enumerate() {
            let at = (start + k as u64).checked_sub(self.start);
            *y = at.map_or(0.0, |at| samples.get(at as usize).copied().unwrap_or(0.0));
        }
    }
}

/// The world at the end of a step, and before it.
pub(crate) struct StepContext<'a> {
    pub(crate) house: &'a House,
    pub(crate) rays: &'a RayScene,
    pub(crate) state: &'a State,
    pub(crate) events: &'a [ContactEvent],
    /// The agents' feet, m, and headings, rad, before the step. Shape (agent,).
    pub(crate) agents_before: &'a [(Vec3, f32)],
    /// The joints before the step: position and velocity. Shape (joint,).
    pub(crate) joints_before: &'a [(f32, f32)],
    /// Time since the world was made, s.
    pub(crate) start_s: f64,
    pub(crate) length_s: f64,
    pub(crate) key: RandomKey,
}

impl WorldSound {
    /// Adds the sounds of the last step's contacts, joints and footsteps to the block that ends now.
    pub(crate) fn add_contact_sounds(&mut self, step: &StepContext<'_>) {
        self.add_impacts(step);
        self.add_friction_sounds(step);
        for (joint, articulation) in step.house.joints.iter_ids() {
            if articulation.is_openable() {
                self.add_joint_sounds(step, joint, articulation);
            }
        }
        self.add_footsteps(step);
    }

    fn add(&mut self, id: u64, late_s: f64, sound: ContactSound) {
        let late = ((late_s.max(0.0) * f64::from(self.rate_hz)) as u64).min(self.block as u64 - 1);
        let length = (sound.duration_s() * f64::from(self.rate_hz)).ceil() as u64;
        if self.touches.len() == MOST_RINGING {
            self.touches.remove(0);
        }
        self.touches.push(ActiveContactSound {
            id,
            start: self.blocks * self.block as u64 + late,
            length,
            rendered: OnceLock::new(),
            air_position: None,
            sound,
        });
    }

    /// Finds the places in the air of the contact sounds that have none yet, and those that are one source with an earlier impact.
    pub(super) fn locate_contact_sounds(&mut self, rays: &RayScene) {
        for k in 0..self.touches.len() {
            let (earlier, rest) = self.touches.split_at_mut(k);
            let touch = &mut rest[0];
            if touch.air_position.is_some() {
                continue;
            }
            let place = nearest_open_air_point(rays, touch.sound.position());
            // Sources of rubbing pairs, joints and feet move; those of impacts do not.
            let impacts = earlier
                .iter()
                .filter(|one| (FIRST_BLOW_ID..FIRST_RUB_ID).contains(&one.id));
            let distance_m = |one: &ActiveContactSound| {
                one.air_position
                    .map_or(f32::INFINITY, |known| known.distance(place))
            };
            let nearest = impacts.min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
            match nearest.filter(|one| distance_m(one) < ONE_SOURCE_M) {
                Some(one) => (touch.id, touch.air_position) = (one.id, one.air_position),
                None => touch.air_position = Some(place),
            }
        }
    }

    fn add_impact(&mut self, late_s: f64, sound: ImpactSound) {
        let id = FIRST_BLOW_ID + self.next_blow % FIRST_BLOW_ID;
        self.next_blow += 1;
        self.add(id, late_s, ContactSound::Impact(sound));
    }

    fn add_impacts(&mut self, step: &StepContext<'_>) {
        let blows = step
            .events
            .iter()
            .filter(|event| event.kind == ContactKind::Impact && event.impulse_n_s >= FAINTEST_N_S);
        for event in largest_impulses(blows, MOST_BLOWS) {
            let sound = ImpactSound {
                position: event.position,
                impulse_n_s: event.impulse_n_s,
                speed_m_s: event.relative_normal_speed_m_s,
                partners: partners(step, event),
                key: step.key.child("blow").child(self.next_blow),
            };
            self.add_impact(event.time_s - step.start_s, sound);
        }
    }

    fn add_friction_sounds(&mut self, step: &StepContext<'_>) {
        let rubs = step.events.iter().filter(|event| {
            let rubs = matches!(event.kind, ContactKind::Scrape | ContactKind::Roll);
            rubs && event.phase != ContactPhase::End && event.duration_s > 0.0
        });
        for event in largest_impulses(rubs, MOST_RUBS) {
            let (kind, speed_m_s) = match event.kind {
                ContactKind::Roll => (FrictionSoundKind::Roll, event.rolling_speed_m_s),
                _ => (
                    FrictionSoundKind::Slide,
                    event.relative_tangential_speed_m_s,
                ),
            };
            let [a, b] = [event.a, event.b].map(contact_entity_key);
            let place = step.key.child("rub").child(a).child(b);
            // The mean over the step: what touched for half of it sounds half as loud as what touched all along.
            let sound = FrictionSound {
                position: event.position,
                kind,
                force_n: event.impulse_n_s / step.length_s as f32,
                speed_m_s,
                length_s: 2.0 * step.length_s as f32,
                partners: partners(step, event),
                key: place.child(self.blocks),
                contact_key: place,
            };
            let id = FIRST_RUB_ID + (a.rotate_left(20) ^ b) % FIRST_BLOW_ID;
            self.add(id, 0.0, ContactSound::Friction(sound));
        }
    }

    /// A hinge that creaks, a drawer that rubs, a door that slams.
    fn add_joint_sounds(&mut self, step: &StepContext<'_>, joint: JointId, of: &Joint) {
        let (house, state) = (step.house, step.state);
        let Some((before, speed_before)) = step.joints_before.get(joint.index()).copied() else {
            return;
        };
        let now = state.joint_position[joint];
        let speed = ((now - before) / step.length_s as f32).abs();
        if now == before || !speed.is_finite() {
            return;
        }
        let leaf = part(house, state, of.child);
        let frame = match of.parent {
            Some(parent) => part(house, state, parent),
            None => ContactPartner::panel("wood", FRAME_KG_M2),
        };
        let parent = of
            .parent
            .map_or(Pose::IDENTITY, |parent| state.part_pose[parent]);
        let anchor = (parent * of.parent_from_joint).position;
        let middle = middle(house, state, of.child);
        let place = step.key.child("joint").child(u64::from(joint.0));
        let friction = state.joint_parameters(house, joint).friction;
        let partners = [leaf.clone(), frame];
        let sound = match of.kind {
            JointKind::Hinge => ContactSound::Creak(CreakSound {
                position: anchor,
                angle_rad: [before, now],
                length_s: step.length_s as f32,
                friction_n_m: friction,
                partners: partners.clone(),
                hinge_key: place,
            }),
            JointKind::Slide => ContactSound::Friction(FrictionSound {
                position: middle,
                kind: FrictionSoundKind::Slide,
                force_n: friction / library().pair_contact("wood", "wood").friction.max(0.1),
                speed_m_s: speed,
                length_s: 2.0 * step.length_s as f32,
                partners: partners.clone(),
                key: place.child(self.blocks),
                contact_key: place,
            }),
        };
        if friction > 0.0 {
            self.add(FIRST_JOINT_ID + u64::from(joint.0), 0.0, sound);
        }
        let shut = |position: f32| (position - of.closed).abs() <= closed_within(of.kind);
        let hits = speed.max(speed_before.abs());
        if !shut(now) || shut(before) || hits < SLAM_SPEED {
            return;
        }
        let mass_kg = part_mass_kg(house, state, of.child);
        // A leaf that turns about its edge meets the frame with m w / 3 of its speed there.
        let (impulse_n_s, speed_m_s, position) = match of.kind {
            JointKind::Hinge => {
                let axis = parent.transform_vector(of.parent_from_joint.transform_vector(of.axis));
                let out = middle - anchor;
                let across = out - axis * out.dot(axis);
                let speed = 2.0 * across.length() * hits;
                (mass_kg * speed / 3.0, speed, middle + across)
            }
            JointKind::Slide => (mass_kg * hits, hits, middle),
        };
        let slam = |impulse_n_s, speed_m_s, partners, label: &str| ImpactSound {
            position,
            impulse_n_s,
            speed_m_s,
            partners,
            key: place.child(label).child(self.blocks),
        };
        let blow = slam(impulse_n_s, speed_m_s, partners, "slam");
        let tongue = ContactPartner::body("steel", LATCH_KG, LATCH_M);
        let latch = slam(LATCH_KG * LATCH_M_S, LATCH_M_S, [tongue, leaf], "latch");
        self.add_impact(0.0, blow);
        if of.kind == JointKind::Hinge && of.parent.is_none() {
            self.add_impact(0.01, latch);
        }
    }

    fn add_footsteps(&mut self, step: &StepContext<'_>) {
        self.gaits
            .resize_with(step.state.agents.len(), Default::default);
        for (id, agent) in step.state.agents.iter_ids() {
            let Some((feet, yaw_rad)) = step.agents_before.get(id.index()).copied() else {
                continue;
            };
            let gait = &mut self.gaits[id.index()];
            let Some(stride) = gait.advance(agent, feet, yaw_rad, step.length_s) else {
                continue;
            };
            let foot = match stride {
                FootEvent::Step { side_m, .. } => {
                    let left = Pose::from_position_yaw(agent.position, agent.yaw_rad);
                    left.transform_point(Vec3::new(-side_m, 0.0, 0.0))
                }
                FootEvent::Wheels { .. } => agent.position,
            };
            let Some(floor) = floor_at(step, foot) else {
                continue;
            };
            let key = step.key.child("foot").child(u64::from(id.0));
            let (late_s, sound) = match stride {
                FootEvent::Step {
                    late_s,
                    speed_m_s,
                    period_s,
                    ..
                } => (
                    late_s,
                    ContactSound::Footstep(FootstepSound {
                        position: foot,
                        mass_kg: body_mass_kg(agent.body.height_m),
                        speed_m_s,
                        period_s,
                        floor,
                        key: key.child(self.blocks),
                    }),
                ),
                FootEvent::Wheels { speed_m_s } => (
                    0.0,
                    ContactSound::Friction(FrictionSound {
                        position: foot,
                        kind: FrictionSoundKind::Roll,
                        force_n: body_mass_kg(agent.body.height_m) * 9.8,
                        speed_m_s,
                        length_s: 2.0 * step.length_s as f32,
                        partners: [agent_partner(agent.body.height_m, "plastic"), floor],
                        key: key.child(self.blocks),
                        contact_key: key,
                    }),
                ),
            };
            self.add(FIRST_FOOT_ID + u64::from(id.0), late_s, sound);
        }
    }
}

/// The `most` events with the largest impulse; equal ones in their order.
fn largest_impulses<'a>(
    events: impl Iterator<Item = &'a ContactEvent>,
    most: usize,
) -> impl Iterator<Item = &'a ContactEvent> {
    let mut events: Vec<&ContactEvent> = events.collect();
    events.sort_by(|a, b| b.impulse_n_s.total_cmp(&a.impulse_n_s));
    events.into_iter().take(most)
}

/// Returns the distance from its closed position within which a door is closed, rad or m; as physics has it.
fn closed_within(kind: JointKind) -> f32 {
    match kind {
        JointKind::Hinge => 0.02,
        JointKind::Slide => 0.005,
    }
}

/// A number that identifies a contact's body.
fn contact_entity_key(toucher: ContactEntity) -> u64 {
    match toucher {
        ContactEntity::Structure(id) => id.index() as u64,
        ContactEntity::Part(id) => (1 << 40) + id.index() as u64,
        ContactEntity::Agent(id) => (2 << 40) + id.index() as u64,
    }
}

fn partners(step: &StepContext<'_>, event: &ContactEvent) -> [ContactPartner; 2] {
    let partner = |toucher, substance: &str| match toucher {
        ContactEntity::Structure(id) => {
            let floor = matches!(
                step.house.structure[id].kind,
                StructureKind::Floor | StructureKind::Ground
            );
            panel_partner(substance, floor)
        }
        ContactEntity::Part(id) => {
            let size = part_size_m(step.house, id);
            ContactPartner::body(substance, part_mass_kg(step.house, step.state, id), size)
        }
        ContactEntity::Agent(id) => partner_of_agent(step.state, id, substance),
    };
    [
        partner(event.a, event.substance_a),
        partner(event.b, event.substance_b),
    ]
}

fn panel_partner(substance: &str, floor: bool) -> ContactPartner {
    let own = library().get_or_default(substance).surface_density_kg_m2;
    let least = if floor { FLOOR_KG_M2 } else { WALL_KG_M2 };
    ContactPartner::panel(substance, own.max(least))
}

fn partner_of_agent(state: &State, id: AgentId, substance: &str) -> ContactPartner {
    let height_m = state
        .agents
        .get(id)
        .map_or(1.7, |agent| agent.body.height_m);
    agent_partner(height_m, substance)
}

fn agent_partner(height_m: f32, substance: &str) -> ContactPartner {
    ContactPartner::body(substance, body_mass_kg(height_m), [0.4, 0.25, height_m])
}

/// A part with the substance of its first material.
fn part(house: &House, state: &State, id: PartId) -> ContactPartner {
    let material = house.parts[id].materials.first();
    let substance = material.map_or("wood", |id| house.materials[*id].substance.as_str());
    ContactPartner::body(
        substance,
        part_mass_kg(house, state, id),
        part_size_m(house, id),
    )
}

/// Mass of a part, kg; without a stated one as if it filled half of its box.
fn part_mass_kg(house: &House, state: &State, id: PartId) -> f32 {
    let part = &house.parts[id];
    let nominal = part.mass_kg.unwrap_or_else(|| {
        let size = part_size_m(house, id);
        0.5 * part.density_kg_m3 * size[0] * size[1] * size[2]
    });
    nominal * state.part_mass_factor(house, id)
}

/// The edges of the box around a part's mesh, m.
fn part_size_m(house: &House, id: PartId) -> [f32; 3] {
    let part = &house.parts[id];
    let bounds = house.meshes[part.mesh].bounds();
    bounds.transformed(&part.part_from_mesh).size().to_array()
}

/// The middle of a part's box, m.
fn middle(house: &House, state: &State, id: PartId) -> Vec3 {
    let part = &house.parts[id];
    let bounds = house.meshes[part.mesh].bounds();
    let middle = bounds.transformed(&part.part_from_mesh).center();
    state.part_pose[id].transform_point(middle)
}

/// Returns the floor under a foot.
fn floor_at(step: &StepContext<'_>, foot: Vec3) -> Option<ContactPartner> {
    let ray = Ray::new(foot + Vec3::Y * 0.25, Vec3::NEG_Y).with_range(0.0, 0.6);
    let hit = step.rays.closest(&ray, RayMask::EAR)?;
    let material = step.rays.surface(&hit).material;
    Some(panel_partner(
        &step.house.materials[material].substance,
        true,
    ))
}
