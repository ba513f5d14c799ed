//! What touches become sounds here, and nowhere else: physics knows no sounds, the acoustics no physics.

use super::Sound;
use dwell_acoustics::ImpactSound;
use dwell_physics::{ContactEvent, ContactKind, Toucher};
use dwell_scene::random::Key;
use dwell_scene::{House, PartId};
use serde::{Deserialize, Serialize};

/// Blows weaker than this are not heard, N·s.
const FAINTEST_N_S: f32 = 0.02;
/// The most blows that begin to sound in one step; the hardest win.
const MOST_BLOWS: usize = 16;
/// Source ids of blows begin here.
const FIRST_BLOW_ID: u64 = 1 << 32;

/// A blow that still rings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Blow {
    pub(super) id: u64,
    pub(super) sound: ImpactSound,
    /// The sample, since the world's start, at which it begins.
    pub(super) start: u64,
}

impl Sound {
    /// Lets the impacts of the last step sound in the block that ends now; the acoustics have no sound of scraping yet.
    pub(crate) fn take_events(
        &mut self,
        house: &House,
        events: &[ContactEvent],
        step_start_s: f64,
        key: Key,
    ) {
        let mut hard: Vec<&ContactEvent> = events
            .iter()
            .filter(|event| event.kind == ContactKind::Impact && event.impulse_n_s >= FAINTEST_N_S)
            .collect();
        hard.sort_by(|a, b| b.impulse_n_s.total_cmp(&a.impulse_n_s));
        let size = |toucher: Toucher| match toucher {
            Toucher::Part(part) => Some(part_size_m(house, part)),
            _ => None,
        };
        for event in hard.into_iter().take(MOST_BLOWS) {
            let late_s = (event.time_s - step_start_s).max(0.0);
            let late = ((late_s * f64::from(self.rate_hz)) as u64).min(self.block as u64 - 1);
            self.blows.push(Blow {
                id: FIRST_BLOW_ID + self.next_blow,
                sound: ImpactSound {
                    position: event.position,
                    impulse_n_s: event.impulse_n_s,
                    substances: [event.substance_a.to_owned(), event.substance_b.to_owned()],
                    size_m: [size(event.a), size(event.b)],
                    key: key.child("blow").child(self.next_blow),
                },
                start: self.blocks * self.block as u64 + late,
            });
            self.next_blow += 1;
        }
    }
}

/// The largest edge of a part's mesh, m.
fn part_size_m(house: &House, part: PartId) -> f32 {
    let part = &house.parts[part];
    house.meshes[part.mesh]
        .bounds()
        .transformed(&part.part_from_mesh)
        .size()
        .max_element()
}
