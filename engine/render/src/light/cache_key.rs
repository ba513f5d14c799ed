//! The inputs of a world's light, so that it is computed anew only when some of them have changed.

use super::indirect::StaticLighting;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, State};

/// The changing inputs of a world's light.
#[derive(Clone, Copy)]
pub(crate) struct LightingInputs<'a> {
    pub(crate) house: &'a House,
    pub(crate) fixed: &'a StaticLighting,
    /// The geometry that blocks light.
    pub(crate) scene: &'a RayScene,
    /// Switches, places of lamps, and how far doors are open.
    pub(crate) state: &'a State,
}

impl LightingInputs<'_> {
    /// Passes the bits of all of it to `tell`.
    fn each(&self, mut tell: impl FnMut(u32)) {
        let places = (0..).map_while(|instance| self.scene.world_from_mesh(instance));
        for place in places {
            place
                .to_cols_array()
                .into_iter()
                .for_each(|number| tell(number.to_bits()));
        }
        for light in &self.house.lights {
            tell(u32::from(self.state.is_on(self.house, light.object)));
            let pose = &self.state.part_pose[light.part];
            let numbers = pose.position.to_array().into_iter();
            let numbers = numbers.chain(pose.rotation.to_array());
            numbers.for_each(|number| tell(number.to_bits()));
        }
        let doors = self.fixed.passage_openness(self.house, self.state);
        doors.for_each(|open| tell(open.to_bits()));
    }

    /// A hash of the inputs (Fowler, Noll and Vo's mixing, by words of 32 bits).
    pub(crate) fn hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        self.each(|word| {
            hash = (hash ^ u64::from(word))
                .wrapping_mul(0x0000_0100_0000_01b3)
                .rotate_left(23);
        });
        hash
    }
}

/// The inputs of the latest light.
#[derive(Debug, Default)]
pub(crate) struct LightingCacheKey {
    hash: Option<u64>,
    words: Vec<u32>,
}

impl LightingCacheKey {
    /// Returns whether inputs of this hash may be these.
    pub(crate) fn may_match(&self, hash: u64) -> bool {
        self.hash == Some(hash)
    }

    /// Returns whether the inputs are these, to the bit; stores them otherwise. `hash`: theirs.
    pub(crate) fn matches_or_store(&mut self, inputs: &LightingInputs<'_>, hash: u64) -> bool {
        if self.may_match(hash) {
            let (mut is_same, mut known) = (true, self.words.iter());
            inputs.each(|word| is_same &= known.next() == Some(&word));
            if is_same && known.next().is_none() {
                return true;
            }
        }
        self.words.clear();
        inputs.each(|word| self.words.push(word));
        self.hash = Some(hash);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::CpuRenderer;
    use crate::light::Lighting;
    use dwell_scene::AgentState;
    use std::cell::Cell;
    use std::sync::Arc;

    /// Returns the number of rays that the light of a world takes; 0 when it is kept.
    fn rays(lighting: &mut Lighting, cpu: &CpuRenderer, scene: &RayScene, state: &State) -> usize {
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            true
        };
        let inputs = LightingInputs {
            house: cpu.house(),
            fixed: cpu.static_lighting(),
            scene,
            state,
        };
        lighting.update(&inputs, inputs.hash(), |_| ask(), |_, _, _| ask());
        asked.get()
    }

    #[test]
    fn light_is_made_anew_when_something_that_it_depends_on_changes_and_only_then() {
        let house = Arc::new(dwell_houses::open("seed:4").unwrap().0);
        let cpu = CpuRenderer::new(&house);
        let (mut scene, mut state) = (RayScene::new(house.clone()), State::new(&house));
        let mut lighting = Lighting::default();
        assert!(rays(&mut lighting, &cpu, &scene, &state) > 20);
        assert_eq!(rays(&mut lighting, &cpu, &scene, &state), 0);
        // Of no concern to light: time, and where heads turn.
        state.time_s += 1.0;
        state.step += 1;
        assert_eq!(rays(&mut lighting, &cpu, &scene, &state), 0);

        let lamp = house
            .lights
            .iter()
            .find(|light| house.objects[light.object].switch.is_some() && light.power_w > 0.0);
        let lamp = lamp.unwrap().object;
        let open = house
            .objects
            .ids()
            .find(|id| state.openness(&house, *id).is_some());
        let joint = house.joints_of(open.unwrap()).next().unwrap();
        let part = house.geometry().movable[0];
        let changes: [&dyn Fn(&mut State); 4] = [
            &|state| state.switched_on[lamp] = !state.switched_on[lamp],
            &|state| state.part_pose[part].position.x += 1e-6,
            &|state| state.joint_position[joint] += 0.1,
            &|state| {
                let feet = house.geometry().static_bvh.bounds().center();
                let body = dwell_scene::AgentBody::default();
                state.agents.push(AgentState::new(body, feet, 0.0));
            },
        ];
        for (k, change) in changes.into_iter().enumerate() {
            change(&mut state);
            scene.update(&state);
            // Of joints only those of doors between rooms matter.
            let is_anew = rays(&mut lighting, &cpu, &scene, &state) > 0;
            assert!(is_anew || k == 2, "change {k}");
            assert_eq!(rays(&mut lighting, &cpu, &scene, &state), 0, "change {k}");
        }
    }
}
