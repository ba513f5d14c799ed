//! Instructions that are drawn from what a house offers.

use super::active_instruction::geodesic_between_m;
use super::planned_step::PlannedStep;
use super::settings::InstructionFollowingV1Settings;
use super::step_candidates::{GroupCandidate, StepCandidates};
use dwell_scene::navigation::NavGrid;
use dwell_scene::random::RandomStream;
use dwell_semantics::SemanticScene;
use dwell_semantics::Term;
use dwell_semantics::Truth;
use dwell_semantics::form::RequestStep;
use dwell_semantics::instruct::{InstructionStep, StepCondition, StepKind, conditional};
use dwell_semantics::predicates;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The form of an instruction.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub(super) enum InstructionForm {
    /// One step.
    Single,
    /// Steps one after the other.
    Sequence,
    /// A step if something is so at the start, and another if it is not.
    Condition,
    /// A step, and something that is not to be done meanwhile.
    Negation,
    /// A step with several things of a kind: a number of them, or all.
    Quantity,
    /// A way through the house, by rooms, doors, turns and landmarks.
    Route,
}

impl InstructionForm {
    /// All forms.
    pub(super) const ALL: [Self; 6] = [
        Self::Single,
        Self::Sequence,
        Self::Condition,
        Self::Negation,
        Self::Quantity,
        Self::Route,
    ];
    /// The forms of episodes of which none is asked for: those that there were before routes, so that these episodes stay what they are.
    pub(super) const BY_DEFAULT: [Self; 5] = [
        Self::Single,
        Self::Sequence,
        Self::Condition,
        Self::Negation,
        Self::Quantity,
    ];

    /// The name, in letters.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Sequence => "sequence",
            Self::Condition => "condition",
            Self::Negation => "negation",
            Self::Quantity => "quantity",
            Self::Route => "route",
        }
    }
}

/// An instruction before it has words.
pub(super) struct DrawnInstruction {
    pub(super) requests: Vec<RequestStep>,
    /// What is to be done.
    pub(super) steps: Vec<PlannedStep>,
    /// What must never be so.
    pub(super) forbidden: Vec<StepCondition>,
}

/// A source of drawn instructions.
pub(super) struct InstructionSampler<'a> {
    pub(super) pool: &'a StepCandidates,
    pub(super) scene: &'a SemanticScene<'a>,
    pub(super) grid: &'a NavGrid,
    /// Kinds of steps that can be asked.
    pub(super) kinds: &'a [StepKind],
    pub(super) settings: &'a InstructionFollowingV1Settings,
}

impl InstructionSampler<'_> {
    /// An instruction of a form; `None` where what was drawn cannot be done, or the house has none of the form, and for routes, which are
    /// drawn with their starts.
    pub(super) fn draw(
        &self,
        form: InstructionForm,
        stream: &mut RandomStream,
    ) -> Option<DrawnInstruction> {
        match form {
            InstructionForm::Single => Some(DrawnInstruction::of(vec![self.single(stream)?])),
            InstructionForm::Sequence => self.sequence(stream),
            InstructionForm::Condition => self.condition(stream),
            InstructionForm::Negation => self.negation(stream),
            InstructionForm::Quantity => self.quantity(stream),
            InstructionForm::Route => None,
        }
    }

    /// A step with one thing or room.
    fn single(&self, stream: &mut RandomStream) -> Option<PlannedStep> {
        let kind = *stream.choose(self.kinds)?;
        let step = self.step(kind, stream)?;
        self.plan(step, &[0])
    }

    /// How a step is played; `None` where something would be carried too far.
    fn plan(&self, step: InstructionStep, planned: &[usize]) -> Option<PlannedStep> {
        let planned = self.pool.plan(step, planned)?;
        let is_short = |most: f64| planned.transport_m(self.grid) <= most;
        let fits = self.settings.max_transport_m.is_none_or(is_short);
        fits.then_some(planned)
    }

    fn step(&self, kind: StepKind, stream: &mut RandomStream) -> Option<InstructionStep> {
        let pool = self.pool;
        if kind == StepKind::GoToRoom {
            return pool.go_to_step(*stream.choose(&pool.rooms())?);
        }
        let object = *stream.choose(pool.by_kind.get(&kind)?)?;
        let to = match kind {
            StepKind::Bring => Term::Room(*stream.choose(&pool.rooms())?),
            StepKind::PutOn | StepKind::PutIn => {
                Term::Object(*stream.choose(&pool.destinations(kind, object))?)
            }
            _ => return pool.object_step(kind, object),
        };
        // What is there already need not be taken there: a sequence would ask for nothing.
        let step = pool.transport_step(kind, object, to)?;
        (!step.conditions[0].holds_of_things(self.scene)).then_some(step)
    }

    /// Steps that one hand can do one after the other: none but going between picking something up and the end.
    fn sequence(&self, stream: &mut RandomStream) -> Option<DrawnInstruction> {
        let count = 2 + stream.below(self.settings.max_sequence_steps as usize - 1);
        let steps: Option<Vec<PlannedStep>> = (0..count).map(|_| self.single(stream)).collect();
        let steps = steps?;
        let fits = steps.iter().enumerate().all(|(number, step)| {
            let later = &steps[number + 1..];
            let walks = |step: &PlannedStep| step.step.kind == StepKind::GoToRoom;
            let apart = later.iter().all(|other| !shares_a_thing(step, other));
            apart && (!step.leaves_object_held() || later.iter().all(walks))
        });
        fits.then(|| DrawnInstruction::of(steps))
    }

    fn condition(&self, stream: &mut RandomStream) -> Option<DrawnInstruction> {
        let (object, states) = *stream.choose(&self.pool.state_things)?;
        let state = *stream.choose(&states)?;
        let (then, otherwise) = (self.single(stream)?, self.single(stream)?);
        let apart = !shares_a_thing(&then, &otherwise)
            && !then.is_about(object)
            && !otherwise.is_about(object);
        if !apart {
            return None;
        }
        let predicate = predicates::find(state).ok()?;
        let chosen = match predicate.holds(self.scene, &[Term::Object(object)], None) {
            Truth::True => &then,
            Truth::False => &otherwise,
            Truth::Undecided(_) => return None,
        };
        let requests = [&then, &otherwise].map(|own| own.step.request.clone());
        let [first, second] = requests;
        Some(DrawnInstruction {
            requests: vec![conditional(
                (self.pool.description(object)?, state),
                first,
                second,
            )],
            steps: vec![chosen.clone()],
            forbidden: Vec::new(),
        })
    }

    fn negation(&self, stream: &mut RandomStream) -> Option<DrawnInstruction> {
        let asked = self.single(stream)?;
        let lasting = [
            StepKind::PickUp,
            StepKind::Open,
            StepKind::Close,
            StepKind::SwitchOn,
            StepKind::SwitchOff,
        ];
        let can = |kind: &StepKind| self.kinds.contains(kind);
        let kinds: Vec<StepKind> = lasting.into_iter().filter(can).collect();
        let other = self.step(*stream.choose(&kinds)?, stream)?;
        let condition = other.conditions[0];
        if condition
            .object()
            .is_none_or(|object| asked.is_about(object))
        {
            return None;
        }
        Some(DrawnInstruction {
            requests: vec![asked.step.request.clone(), other.prohibition()?],
            steps: vec![asked],
            forbidden: vec![condition],
        })
    }

    fn quantity(&self, stream: &mut RandomStream) -> Option<DrawnInstruction> {
        let groups = self.pool.groups.iter();
        let groups = groups.filter(|group| group.count() <= self.settings.max_things);
        let offer = *stream.choose(&groups.collect::<Vec<&GroupCandidate>>())?;
        let step = self.pool.group_step(offer)?;
        let group = &offer.group;
        let number = |object| group.objects.iter().position(|own| own == object);
        let mut left: Vec<usize> = group.undone.iter().filter_map(number).collect();
        // Of a number of things, which is drawn; of all, those that are left.
        while group.is_exact && left.len() > group.needed {
            left.swap_remove(stream.below(left.len()));
        }
        left.sort_unstable();
        let planned = self.plan(step, &left)?;
        Some(DrawnInstruction::of(vec![self.in_best_order(planned)]))
    }

    /// The same step with its targets in the order with the shortest way from one to the next.
    fn in_best_order(&self, planned: PlannedStep) -> PlannedStep {
        let targets = &planned.targets;
        let count = targets.len();
        let between = |from: usize, to: usize| {
            let (Some(last), Some(first)) = (targets[from].legs.last(), targets[to].legs.first())
            else {
                return 0.0;
            };
            if from == to {
                return 0.0;
            }
            geodesic_between_m(&last.goal, &first.goal, self.grid)
        };
        let ways_m: Vec<Vec<f64>> = (0..count)
            .map(|from| (0..count).map(|to| between(from, to)).collect())
            .collect();
        let way_m = |order: &Vec<usize>| -> f64 {
            order.windows(2).map(|pair| ways_m[pair[0]][pair[1]]).sum()
        };
        let best = orders(count)
            .into_iter()
            .min_by(|a, b| way_m(a).total_cmp(&way_m(b)));
        let order = best.unwrap_or_default();
        PlannedStep {
            targets: order
                .iter()
                .map(|number| targets[*number].clone())
                .collect(),
            step: planned.step,
        }
    }
}

impl DrawnInstruction {
    fn of(steps: Vec<PlannedStep>) -> Self {
        Self {
            requests: steps.iter().map(|own| own.step.request.clone()).collect(),
            steps,
            forbidden: Vec::new(),
        }
    }
}

/// Returns whether two steps are about the same thing or room.
fn shares_a_thing(one: &PlannedStep, other: &PlannedStep) -> bool {
    let of_other = &other.step.conditions;
    one.step.conditions.iter().any(|own| {
        let objects = own.objects();
        of_other.contains(own)
            || of_other.iter().any(|other| {
                let others = other.objects();
                objects.iter().any(|object| others.contains(object))
            })
    })
}

/// All orders of some numbers, rising.
fn orders(count: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..count {
        let longer = all.iter().flat_map(|order| {
            let unused = (0..count).filter(|number| !order.contains(number));
            unused.map(|number| order.iter().copied().chain([number]).collect())
        });
        all = longer.collect();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_all_permutations() {
        assert_eq!(orders(0), [Vec::<usize>::new()]);
        let mut four = orders(4);
        assert_eq!(four.len(), 24);
        four.dedup();
        assert_eq!(four.len(), 24);
        assert_eq!(
            (&four[0][..], &four[23][..]),
            (&[0, 1, 2, 3][..], &[3, 2, 1, 0][..])
        );
    }
}
