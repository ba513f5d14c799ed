//! The body of an agent. It is constant unless changed; every number of it can be set at run time under
//! `agent/N/body/FIELD`. It is stored in the agent's state only.

use super::numeric_field::{NumericField, number, parameters, set};
use super::person::PersonBody;
use super::{Locomotion, Parameter};
use crate::error::SceneError;

/// The body of an agent: a capsule with an eye and two ears, which may be seen as a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentBody {
    /// Radius of the capsule, m; 0.05 to 1.
    pub radius_m: f32,
    /// Height of the capsule, m; at least twice the radius, at most 3.
    pub height_m: f32,
    /// Height of eyes and ears above the feet, m; at most the height.
    pub eye_height_m: f32,
    /// The highest step that it climbs, m; 0 to 1.
    pub step_height_m: f32,
    /// The steepest slope that it walks up, rad; 0 to 1.4.
    pub max_slope_rad: f32,
    /// The heaviest object that it lifts, kg; 0 to 500. A heavier one falls from its hand in the next step.
    pub lift_kg: f32,
    /// Reach of its hand from its eye, m; 0.1 to 5.
    pub reach_m: f32,
    /// The force with which it pushes obstacles and with which its hand pushes and pulls, N; 0 to 10,000.
    pub push_force_n: f32,
    /// The strongest pull of its hand on a door or drawer, N·m or N; 0 to 10,000.
    pub hand_effort: f32,
    /// The largest edge of an object that it carries, m; 0.05 to 5.
    pub max_carry_size_m: f32,
    /// The horizontal field of view of the cameras at its eyes that state none of their own, degrees; 1 to 170, default 90.
    /// In a world it is the value of `agent/N/camera/fov_deg` until that is set: then it is that of all its cameras but those with a `projection`, whatever they state.
    pub camera_fov_deg: f32,
    /// Its locomotion; default: it walks.
    pub locomotion: Locomotion,
    /// What makes it a person for all who see it; `None`: it is seen as the capsule that it is for physics.
    pub person: Option<PersonBody>,
}

impl Default for AgentBody {
    /// A small adult: 0.2 m radius, 1.5 m tall, eyes at 1.25 m, climbs 0.2 m, lifts 10 kg, reaches 1.5 m, pushes with 100
    /// N, pulls doors with 40 N·m, carries objects of up to 1 m.
    fn default() -> Self {
        Self {
            radius_m: 0.2,
            height_m: 1.5,
            eye_height_m: 1.25,
            step_height_m: 0.2,
            max_slope_rad: 0.785,
            lift_kg: 10.0,
            reach_m: 1.5,
            push_force_n: 100.0,
            hand_effort: Self::HAND_EFFORT,
            max_carry_size_m: 1.0,
            camera_fov_deg: 90.0,
            locomotion: Locomotion::default(),
            person: None,
        }
    }
}

/// The numbers with an address `agent/N/body/FIELD`.
const BODY: &[NumericField<AgentBody>] = &[
    number!(radius_m, "m", 0.05 to 1.0),
    number!(height_m, "m", 0.1 to 3.0),
    number!(eye_height_m, "m", 0.0 to 3.0),
    number!(step_height_m, "m", 0.0 to 1.0),
    number!(max_slope_rad, "rad", 0.0 to 1.4),
    number!(lift_kg, "kg", 0.0 to 500.0),
    number!(reach_m, "m", 0.1 to 5.0),
    number!(push_force_n, "N", 0.0 to 1e4),
    number!(hand_effort, "N m or N", 0.0 to 1e4),
    number!(max_carry_size_m, "m", 0.05 to 5.0),
];

impl AgentBody {
    /// The strongest pull of an ordinary hand on a door or drawer, N·m or N; 0 to 10,000.
    pub(super) const HAND_EFFORT: f32 = 40.0;

    /// The range of the field of view of cameras at an agent's eyes, degrees.
    pub(super) const FOV_RANGE_DEG: [f64; 2] = [1.0, 170.0];

    /// A person of a height, m: as [`AgentBody::default`], with eyes where persons have them.
    #[must_use]
    pub fn person(height_m: f32) -> Self {
        Self {
            height_m,
            eye_height_m: PersonBody::EYE_HEIGHT * height_m,
            person: Some(PersonBody::default()),
            ..Self::default()
        }
    }

    /// Returns its numbers by name, with units and their ranges given the others: it is at least twice as high as its
    /// radius, its eyes are not above it, and a person is as high as persons are. The fields of the address `agent/N/body/FIELD`.
    pub fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut all = parameters(BODY, self);
        for (name, parameter) in &mut all {
            match *name {
                "radius_m" => parameter.high = parameter.high.min(f64::from(0.5 * self.height_m)),
                "height_m" => {
                    let least = f64::from((2.0 * self.radius_m).max(self.eye_height_m));
                    parameter.low = parameter.low.max(least);
                    if self.person.is_some() {
                        let [low, high] = PersonBody::HEIGHT_RANGE_M.map(f64::from);
                        parameter.low = parameter.low.max(low);
                        parameter.high = parameter.high.min(high);
                    }
                }
                "eye_height_m" => parameter.high = parameter.high.min(f64::from(self.height_m)),
                _ => {}
            }
        }
        all
    }

    /// Sets the number called `field` without a check; [`AgentBody::check`] gives the allowed range.
    pub(super) fn set(&mut self, field: &str, value: f32) {
        set(BODY, self, |name| (name == field).then_some(value));
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`crate::SceneError::Range`] names the field.
    pub fn check(&self) -> Result<(), SceneError> {
        let refuse = |field: &'static str, found: String| {
            Err(SceneError::Range {
                at: "agent body".to_owned(),
                field,
                found,
                allowed: "a value within its range",
            })
        };
        if let (Some(_), [low, high]) = (self.person, PersonBody::HEIGHT_RANGE_M)
            && !(low..=high).contains(&self.height_m)
        {
            let found = format!("{} (range {low} to {high} m of a person)", self.height_m);
            return refuse("height_m", found);
        }
        let refused = |(_, parameter): &(_, Parameter)| !parameter.admits(parameter.value);
        let all = self.parameters();
        // A number out of its own range invalidates those of the others, so it is named first.
        let own = parameters(BODY, self).iter().position(refused);
        if let Some(k) = own.or_else(|| all.iter().position(refused)) {
            let (field, parameter) = all[k];
            if field == "height_m" && parameter.low > parameter.high {
                // No height would do: the eyes are above the tallest agent.
                let (eye_m, high) = (self.eye_height_m, parameter.high);
                let found =
                    format!("{eye_m} (range 0 to {high} m, the height of the tallest agent)");
                return refuse("eye_height_m", found);
            }
            let Parameter {
                value,
                low,
                high,
                unit,
            } = parameter;
            return refuse(field, format!("{value} (range {low} to {high} {unit})"));
        }
        let [low, high] = Self::FOV_RANGE_DEG;
        if !(low..=high).contains(&f64::from(self.camera_fov_deg)) {
            let found = format!("{} (range {low} to {high} deg)", self.camera_fov_deg);
            return refuse("camera_fov_deg", found);
        }
        self.locomotion.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_holds_together_whichever_number_is_looked_at() {
        let body = AgentBody::default();
        body.check().unwrap();
        for (field, value) in [
            ("radius_m", 0.76),
            ("height_m", 0.39),
            ("height_m", 1.2),
            ("eye_height_m", 1.51),
            ("push_force_n", f32::NAN),
            ("camera_fov_deg", 171.0),
        ] {
            let mut other = body;
            other.set(field, value);
            if field == "camera_fov_deg" {
                other.camera_fov_deg = value;
            }
            let message = other.check().unwrap_err().to_string();
            assert!(message.contains("agent body"), "{field}: {message}");
        }
        let mut tall = body;
        tall.set("height_m", 3.5);
        tall.set("eye_height_m", 3.4);
        let message = tall.check().unwrap_err().to_string();
        let told = "eye_height_m is 3.4 (range 0 to 3 m, the height of the tallest agent)";
        assert!(message.contains(told), "{message}");
        let mut flat = body;
        flat.set("height_m", 0.0);
        let message = flat.check().unwrap_err().to_string();
        assert!(message.contains("height_m"), "{message}");
    }
}
