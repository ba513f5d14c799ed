"""Learns a task from its scripted expert, without pictures: a baseline that learns.

``OPENBLAS_NUM_THREADS=1 python examples/imitation.py PointNav --demonstrations 25,100,400``
(several threads make such small matrices slower).

Behaviour cloning: a network of two hidden layers learns by cross entropy and Adam [1] which action
the expert takes, from numbers alone: the goal's own sensor, odometry, a lidar, and energies of
bands and the correlation of the ears where the task has sound. With ``--dagger`` [2] episodes after
the first count are played by what was learnt so far (all but one in three), and the expert says
what it would do in each step. Evaluated on houses of the split ``val`` by ``dwell.evaluation``, so
that numbers compare with those of ``dwell evaluate``.

[1] D. P. Kingma and J. Ba, "Adam: A Method for Stochastic Optimization", ICLR 2015.
[2] S. Ross, G. Gordon and D. Bagnell, "A Reduction of Imitation Learning and Structured Prediction
to No-Regret Online Learning", AISTATS 2011.
"""

import argparse
import itertools
import json
from pathlib import Path

import numpy as np
from gymnasium import spaces

import dwell
from dwell.envs import DwellEnv
from dwell.evaluation import evaluate

BODY = {"gps": {}, "compass": {}, "proprioception": {}, "lidar": {"beams": 36}}
SOUND = {"audio": {}}
#: What the learner observes beside its body. Of a picture it gets the mean colours of 16 fields, of
#: a picture of classes how much of each of 24 fields shows the goal's.
GOAL_SENSORS = {
    "PointNav": {"pointgoal_with_gps_compass": {}},
    "RoomNav": {"roomgoal": {}},
    "ObjectNav": {"objectgoal": {}, "semantic": {"width": 32, "height": 24}},
    "ImageNav": {"imagegoal": {"width": 32, "height": 32}},
    "AudioNav": SOUND,
    "SemanticAudioNav": SOUND,
    "SoundLocalization": SOUND,
    "InstructionFollowing": {"instruction_tokens": {}},
    "InstructionFollowing-v1": {"instruction_tokens": {}},
    "EmbodiedQA": {"question_tokens": {}},
    "Rearrange": {"rearrangegoal": {}},
    "Tidy": {},
}
#: Settings of tasks whose episodes are made short; all others have their doors open, so that the
#: lidar shows all ways.
TASK_SETTINGS = {
    "SoundLocalization": {},
    "InstructionFollowing-v1": {"forms": ["single"]},
    "Rearrange": {"max_things": 1, "max_openables": 1},
    "Tidy": {"max_things": 1},
}
#: Metrics that the curve has where the task has them.
METRICS = (
    "success",
    "spl",
    "answer_correct",
    "angular_error_deg",
    "class_correct",
    "goal_condition_success",
    "prop_fixed",
    "energy_prop",
    "tidied",
)
#: Steps before this one whose observations are told, too.
HISTORY = (2, 6, 14)
HIDDEN, WORD_SIZE, BATCH, RATE = 128, 24, 256, 1e-3
#: Share of the loss that steps with the action ``stop`` have at least.
STOP_SHARE = 0.05
BANDS_HZ = ((100, 300), (300, 700), (700, 1500), (1500, 3000), (3000, 6000))
LAGS = 12


def heard(pressure, rate_hz=16000):
    """Levels of bands at both ears, and the correlation of the ears (PHAT) over 25 lags."""
    spectra = np.fft.rfft(pressure, 2 * pressure.shape[1], axis=1)
    hz = np.fft.rfftfreq(2 * pressure.shape[1], 1 / rate_hz)
    bands = [(hz >= low) & (hz < high) for low, high in BANDS_HZ]
    powers = np.array([(np.abs(spectra[:, band]) ** 2).sum(axis=1) for band in bands])
    levels = (np.log10(powers + 1e-9) + 2.0) / 3.0
    cross = spectra[0] * spectra[1].conj()
    correlation = np.fft.irfft(cross / (np.abs(cross) + 1e-12))
    return np.concatenate([levels.ravel(), 3.0 * np.roll(correlation, LAGS)[: 2 * LAGS + 1]])


def words(numbers):
    """Words or a class: a fixed random vector of each, summed, by itself and with its place."""
    told = np.zeros(2 * WORD_SIZE)
    known = [(place, int(number)) for place, number in enumerate(np.ravel(numbers)) if number]
    for place, number in known:
        told[:WORD_SIZE] += np.random.default_rng([number]).normal(size=WORD_SIZE)
        told[WORD_SIZE:] += np.random.default_rng([number, place]).normal(size=WORD_SIZE)
    return told / np.sqrt(max(1, len(known)))


def what_is_asked(observation):
    """What the episode asks for, which stays the same, as numbers near 1."""
    asked = []
    for name, value in sorted(observation.items()):
        if name == "imagegoal":
            fields = value.reshape(4, value.shape[0] // 4, 4, value.shape[1] // 4, 3)
            asked.append(fields.mean(axis=(1, 3)).ravel() / 128.0 - 1.0)
        elif name in ("roomgoal", "objectgoal") or name.endswith("_tokens"):
            asked.append(words(value))
    return np.concatenate([*asked, []])


def what_is_sensed(observation):
    """What changes from step to step, as numbers near 1."""
    now = []
    for name, value in sorted(observation.items()):
        if name == "pointgoal_with_gps_compass":
            far_m, angle = value
            now.append([np.log1p(far_m), min(far_m, 1.0), np.cos(angle), np.sin(angle)])
        elif name == "compass":
            now.append([np.cos(value[0]), np.sin(value[0])])
        elif name == "audio":
            now.append(heard(value))
        elif name == "semantic":
            is_goal = value[..., 0] == observation["objectgoal"][0]
            fields = is_goal.reshape(3, value.shape[0] // 3, 8, value.shape[1] // 8)
            now.append(np.sqrt(fields.mean(axis=(1, 3))).ravel())
        elif name == "lidar":
            now.append(np.minimum(value.ravel(), 4.0) / 2.0)
        elif name in ("gps", "proprioception", "rearrangegoal"):
            now.append(np.clip(np.ravel(value) / (5.0 if name == "gps" else 2.0), -3.0, 3.0))
    return np.concatenate(now)


class History:
    """Observations of some steps before, beside the newest."""

    def __init__(self):
        """Nothing was seen yet."""
        self.past, self.asked = [], None

    def add(self, observation):
        """The inputs of the network."""
        if self.asked is None:
            self.asked = what_is_asked(observation)
        self.past = [*self.past[-max(HISTORY) :], what_is_sensed(observation)]
        past = [self.past[max(0, len(self.past) - 1 - back)] for back in (0, *HISTORY)]
        return np.concatenate([*past, self.asked]).astype(np.float32)


class Heads:
    """What is chosen in a step: the action, and each field of an answer, in 16 parts of a range."""

    PARTS = 16

    def __init__(self, env):
        """Those of an environment."""
        space = env.action_space
        self.fields = dict(space["answer"].items()) if env.has_answers else {}
        self.sizes = [int(space["action"].n if env.has_answers else space.n)]
        for field in self.fields.values():
            self.sizes.append(int(getattr(field, "n", self.PARTS)))
        self.stop = env.actions().index("stop")

    def number(self, action):
        """The number of the discrete action."""
        return int(action["action"] if self.fields else action)

    def labels(self, action):
        """The number of the choice of each head."""
        chosen = [self.number(action)]
        for name, field in self.fields.items():
            value = np.ravel(action["answer"][name])[0]
            if not isinstance(field, spaces.Discrete):
                share = (value - field.low[0]) / (field.high[0] - field.low[0])
                value = min(int(share * self.PARTS), self.PARTS - 1)
            chosen.append(int(value))
        return chosen

    def action(self, logits, rng):
        """An action that is drawn by its chance, and the most likely answers.

        The most likely action alone would turn to and fro for ever where two are as likely.
        """
        ends = np.cumsum(self.sizes)[:-1]
        of_action, *of_answers = np.split(logits, ends)
        chances = np.exp(of_action - of_action.max())
        number = int(rng.choice(len(chances), p=chances / chances.sum()))
        rest = [int(part.argmax()) for part in of_answers]
        if not self.fields:
            return number
        answer = {}
        for (name, field), chosen in zip(self.fields.items(), rest, strict=True):
            answer[name] = chosen
            if not isinstance(field, spaces.Discrete):
                share = (chosen + 0.5) / self.PARTS
                answer[name] = np.float32(field.low + share * (field.high - field.low))
        return {"action": number, "answer": answer}


class Network:
    """Two hidden layers of rectified units, and softmax heads."""

    def __init__(self, inputs, heads, rng):
        """Weights as He et al. (2015) draw them for such units."""
        pairs = list(itertools.pairwise([inputs, HIDDEN, HIDDEN, sum(heads.sizes)]))
        scales = [np.sqrt(2.0 / size) for size, _ in pairs]
        self.heads = heads
        self.weights = [
            np.float32(scale * rng.normal(size=pair))
            for scale, pair in zip(scales, pairs, strict=True)
        ]
        self.biases = [np.zeros(size, np.float32) for _, size in pairs]

    def logits(self, inputs):
        """The layers' outputs; the last are the logits."""
        layers = [inputs]
        for k, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            value = layers[-1] @ weight + bias
            layers.append(np.maximum(value, 0.0) if k < 2 else value)
        return layers

    def gradients(self, inputs, labels, shares):
        """Of the mean cross entropy of all heads, each row with its share."""
        layers = self.logits(inputs)
        ends = np.cumsum(self.heads.sizes)[:-1]
        parts = []
        for head, part in enumerate(np.split(layers[-1], ends, axis=1)):
            chances = np.exp(part - part.max(axis=1, keepdims=True))
            chances /= chances.sum(axis=1, keepdims=True)
            chances[np.arange(len(part)), labels[:, head]] -= 1.0
            parts.append(chances * shares[:, None] / len(part))
        slope = np.concatenate(parts, axis=1)
        found = []
        for k in (2, 1, 0):
            found[:0] = [(layers[k].T @ slope, slope.sum(axis=0))]
            slope = (slope @ self.weights[k].T) * (layers[k] > 0)
        return found

    def fit(self, inputs, labels, steps, rng):
        """Adam with a rate that falls to zero, over so many batches."""
        is_stop = labels[:, 0] == self.heads.stop
        shares = np.ones(len(labels), np.float32)
        if 0.0 < is_stop.mean() < STOP_SHARE:
            shares[is_stop] = STOP_SHARE / is_stop.mean()
        values = [*self.weights, *self.biases]
        means = [np.zeros_like(value) for value in values]
        squares = [np.zeros_like(value) for value in values]
        for step in range(1, steps + 1):
            rows = rng.integers(len(labels), size=BATCH)
            found = self.gradients(inputs[rows], labels[rows], shares[rows])
            slopes = [one for one, _ in found] + [one for _, one in found]
            rate = RATE * (1.0 - step / (steps + 1))
            for value, mean, square, slope in zip(values, means, squares, slopes, strict=True):
                mean += 0.1 * (slope - mean)
                square += 0.001 * (slope**2 - square)
                size = np.sqrt(square / (1.0 - 0.999**step)) + 1e-8
                value -= rate * mean / (1.0 - 0.9**step) / size


class Learner:
    """The policy that ``dwell.evaluation.evaluate`` plays."""

    def __init__(self, network, center, scale):
        """A network, and what its inputs are centred and divided by."""
        self.network, self.center, self.scale = network, center, scale
        self.history = History()
        self.rng = np.random.default_rng(0)

    def reset(self, observation, info):
        self.history = History()
        self.rng = np.random.default_rng(0)

    def act(self, observation):
        inputs = (self.history.add(observation) - self.center) / self.scale
        return self.network.heads.action(self.network.logits(inputs)[-1], self.rng)


def learnt(inputs, labels, heads, updates):
    """A learner of all steps that were seen so far."""
    rng = np.random.default_rng(0)
    inputs, labels = np.array(inputs), np.array(labels)
    center, scale = inputs.mean(axis=0), inputs.std(axis=0) + 0.1
    network = Network(inputs.shape[1], heads, rng)
    network.fit((inputs - center) / scale, labels, updates, rng)
    return Learner(network, center, scale)


def demonstrate(env, heads, learner, max_steps):
    """An episode with the expert's choices; where there is a learner, it acts, and not the expert.

    Returns:
        Inputs and labels of each step.
    """
    observation, info = env.reset()
    history, inputs, labels = History(), [], []
    if learner is not None:
        learner.reset(observation, info)
    for _ in range(max_steps):
        told = env.expert_action()
        inputs.append(history.add(observation))
        labels.append(heads.labels(told))
        action = told if learner is None else learner.act(observation)
        if heads.stop in (labels[-1][0], heads.number(action)):
            # Here the episode ends where the expert ends it, and nowhere else.
            action = told
        observation, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            break
    return inputs, labels


def curve(args):
    """Success on houses of ``val`` after so many demonstrations; gives a row for each count."""
    counts = [int(count) for count in args.demonstrations.split(",")]
    sensors = {**GOAL_SENSORS[args.task], **BODY}
    settings = dict(TASK_SETTINGS.get(args.task, {"open_doors": True}))
    if args.max_distance_m is not None:
        settings["max_distance_m"] = args.max_distance_m
    env = DwellEnv(
        args.task,
        houses=f"split:train:0..{args.houses}",
        sensors=sensors,
        task_settings=settings,
        threads=1,
    )
    env.reset(seed=args.seed)
    heads, inputs, labels, learner = Heads(env), [], [], None
    for number in range(1, max(counts) + 1):
        by_learner = args.dagger and learner is not None and number % 3 != 1
        seen = demonstrate(env, heads, learner if by_learner else None, args.max_steps)
        inputs += seen[0]
        labels += seen[1]
        if number not in counts:
            continue
        learner = learnt(inputs, labels, heads, args.updates)
        result = evaluate(
            learner,
            task=args.task,
            houses=f"split:val:0..{min(args.houses, args.episodes)}",
            count=args.episodes,
            seed=args.seed,
            sensors=sensors,
            task_settings=settings,
            max_steps=args.max_steps,
            threads=1,
        )
        metrics = {name: result["metrics"][name] for name in METRICS if name in result["metrics"]}
        yield {"demonstrations": number, "steps": len(labels), "episodes": args.episodes, **metrics}


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("task", nargs="?", default="PointNav", choices=GOAL_SENSORS)
    parser.add_argument("--demonstrations", default="25,100", help="counts, with commas")
    parser.add_argument("--episodes", type=int, default=50, help="of val, for each count")
    parser.add_argument("--houses", type=int, default=50, help="of train, and of val at most")
    parser.add_argument("--max-steps", type=int, default=300, help="of every episode")
    parser.add_argument("--max-distance-m", type=float, help="the furthest start from the goal, m")
    parser.add_argument("--updates", type=int, default=6000, help="batches of each training")
    parser.add_argument("--dagger", action="store_true", help="the learner acts, the expert labels")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="the curve as JSON")
    args = parser.parse_args()
    rows = []
    for row in curve(args):
        rows.append(row)
        success = row["success"]
        print(
            f"{args.task}: {row['demonstrations']} demonstrations, {row['steps']} steps: success "
            f"{success['mean']:.3f} ({success['low']:.3f} to {success['high']:.3f}) of "
            f"{row['episodes']} episodes",
            flush=True,
        )
        if args.out is not None:
            told = {"task": args.task, "version": dwell.__version__, "curve": rows}
            args.out.write_text(json.dumps(told, indent=1), "utf-8")


if __name__ == "__main__":
    main()
