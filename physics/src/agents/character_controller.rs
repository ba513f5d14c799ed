//! The character controller: sliding along obstacles, climbing steps, falling.
//!
//! Every movement is cut into pieces shorter than half the body's core, and a piece that would leave the core inside
//! something solid is not made. So an agent passes no wall, however thin, at any speed.
//!
//! # Source
//! K. Fauerby, Improved Collision Detection and Response (2003): collide and slide. A movement stops where a cast of the shape hits,
//! and what is left of it goes on along what was hit.

use super::shape_queries::{AgentQueries, SweepHit};
use dwell_scene::AgentState;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Iterations of sliding in one piece of a movement.
const SLIDE_ITERATIONS: usize = 4;
/// Height difference that counts as level ground, m.
const LEVEL_M: f32 = 1e-3;
/// Highest falling speed, m/s.
pub(crate) const FASTEST_FALL_M_S: f32 = 30.0;
/// Most pieces of one movement.
const MOST_PIECES: f32 = 256.0;
/// Largest displacement of an agent out of an overlap in one step, m.
const MAX_EXIT_M: f32 = 0.02;
/// Gap left before an obstacle, besides the skin, m.
const OBSTACLE_GAP_M: f32 = 1e-4;

/// The velocity of an agent that is not commanded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PassiveVelocity {
    /// Downwards, m/s; less than 0 while it rises.
    pub(crate) fall_m_s: f32,
    /// Horizontal velocity of a slide off a slope, m/s.
    pub(crate) slide_m_s: Vec3,
}

/// A push on a light body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CharacterPush {
    pub(crate) body: u32,
    pub(crate) point: Vec3,
    /// Unit length, horizontal.
    pub(crate) direction: Vec3,
    /// Desired speed in that direction, m/s.
    pub(crate) speed_m_s: f32,
}

/// One agent's movement in one physics step.
pub(crate) struct CharacterController<'a> {
    pub(crate) probe: AgentQueries<'a>,
    pub(crate) pushes: Vec<CharacterPush>,
    pub(crate) dt_s: f32,
    pub(crate) gravity_m_s2: f32,
}

impl CharacterController<'_> {
    /// Moves the agent by `motion` (horizontal, m) and lets it stand, slide or fall.
    pub(crate) fn step(
        &mut self,
        agent: &mut AgentState,
        loose: &mut PassiveVelocity,
        motion: Vec3,
    ) {
        let mut feet = agent.position;
        let slid = loose.slide_m_s * self.dt_s;
        let motion = motion + slid;
        if motion.length_squared() > 1e-14 {
            if self.probe.is_core_blocked(feet) {
                if let Some(out) = self.probe.exit_displacement(feet, MAX_EXIT_M) {
                    feet += out;
                }
            } else {
                let longest = 0.5 * self.probe.core_radius_m();
                let pieces = (motion.length() / longest).ceil().clamp(1.0, MOST_PIECES);
                for _ in 0..pieces as u32 {
                    feet = self.move_substep(feet, motion / pieces, agent.grounded);
                }
            }
        }
        if slid != Vec3::ZERO {
            loose.slide_m_s = self.velocity_after_obstacles(loose.slide_m_s, feet - agent.position);
        }
        self.stand_or_fall(&mut feet, agent, &mut loose.fall_m_s);
        if agent.grounded && loose.fall_m_s == 0.0 {
            loose.slide_m_s = self.velocity_on_slope(feet, loose.slide_m_s);
        }
        agent.position = feet;
    }

    /// Makes one short piece of a movement.
    fn move_substep(&mut self, feet: Vec3, motion: Vec3, grounded: bool) -> Vec3 {
        let mut target = self.slide(feet, motion);
        if target == feet || self.probe.is_core_blocked(target) {
            return feet;
        }
        let step = self.probe.body.step_height_m;
        if !grounded {
            let leaves =
                self.probe.ground(target, step).is_none() && self.walks_off_floor(feet, target);
            return if leaves { feet } else { target };
        }
        if let Some(ground) = self.probe.ground(target, step) {
            let rise = ground - feet.y;
            if rise > step + 1e-3 {
                return feet;
            }
            if rise > LEVEL_M {
                let raised = Vec3::new(target.x, ground, target.z);
                if self.is_too_steep(target, ground)
                    || !self.probe.can_rise(target, rise)
                    || self.probe.is_core_blocked(raised)
                {
                    return feet;
                }
            }
            target.y = ground;
        } else if self.walks_off_floor(feet, target) {
            return feet;
        }
        target
    }

    /// Returns whether a movement leads from above some surface to above none: out of the house.
    fn walks_off_floor(&self, feet: Vec3, target: Vec3) -> bool {
        !self.probe.has_surface_below(target) && self.probe.has_surface_below(feet)
    }

    /// Moves as far as possible, sliding along obstacles.
    fn slide(&mut self, feet: Vec3, motion: Vec3) -> Vec3 {
        let mut at = feet;
        let mut left = motion;
        let mut walls: [Vec3; SLIDE_ITERATIONS] = [Vec3::ZERO; SLIDE_ITERATIONS];
        for turn in 0..SLIDE_ITERATIONS {
            let length = left.length();
            if length < 1e-6 {
                break;
            }
            let Some(hit) = self.probe.cast(at, left) else {
                return at + left;
            };
            let go = (hit.fraction * length - OBSTACLE_GAP_M).max(0.0);
            at += left * (go / length);
            left *= 1.0 - go / length;
            let wall = Vec3::new(hit.normal.x, 0.0, hit.normal.z);
            // A slope or an edge from below or above is a wall as seen from above.
            let wall = if wall.length() > 0.05 {
                wall.normalize_or_zero()
            } else {
                -left.normalize_or_zero()
            };
            self.note_push(&hit, wall, left);
            walls[turn] = wall;
            // d - n (n . d): what points into the wall is taken off.
            left -= wall * left.dot(wall).min(0.0);
            // Between two walls the movement ends.
            if walls[..turn].iter().any(|wall| left.dot(*wall) < -1e-6) {
                break;
            }
        }
        at
    }

    fn note_push(&mut self, hit: &SweepHit, wall: Vec3, left: Vec3) {
        let Some(body) = hit.pushable_body else {
            return;
        };
        let speed = -left.dot(wall) / self.dt_s;
        if speed > 0.0 && !self.pushes.iter().any(|push| push.body == body) {
            self.pushes.push(CharacterPush {
                body,
                point: hit.point,
                direction: -wall,
                speed_m_s: speed,
            });
        }
    }

    fn stand_or_fall(&self, feet: &mut Vec3, agent: &mut AgentState, fall_m_s: &mut f32) {
        let snap = if agent.grounded {
            self.probe.body.step_height_m
        } else {
            LEVEL_M
        };
        if *fall_m_s == 0.0
            && let Some(ground) = self.probe.ground(*feet, snap)
            && ground - feet.y <= self.probe.body.step_height_m
        {
            if ground <= feet.y + LEVEL_M || self.probe.can_rise(*feet, ground - feet.y) {
                feet.y = ground;
            }
            agent.grounded = true;
            return;
        }
        // Symplectic Euler: v' = v + g h, then y' = y - v' h.
        *fall_m_s = (*fall_m_s + self.gravity_m_s2 * self.dt_s).min(FASTEST_FALL_M_S);
        if *fall_m_s < 0.0 {
            let up = -*fall_m_s * self.dt_s;
            let part = self.probe.rise_fraction(*feet, up);
            feet.y += up * part;
            if part < 1.0 {
                *fall_m_s = 0.0;
            }
            agent.grounded = false;
            return;
        }
        let down = *fall_m_s * self.dt_s;
        if let Some(ground) = self.probe.ground(*feet, down) {
            let highest = feet.y + self.probe.body.step_height_m;
            feet.y = ground.max(feet.y - down).min(highest);
            agent.grounded = true;
        } else {
            let part = self.probe.drop_fraction(*feet, down);
            agent.grounded = part < 1.0;
            // The surface on which the cylinder comes to rest must not stop it from moving on.
            let rest = if agent.grounded { LEVEL_M } else { 0.0 };
            feet.y -= (down * part - rest).max(0.0);
        }
        if agent.grounded {
            *fall_m_s = 0.0;
        }
    }
}
