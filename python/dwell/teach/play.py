"""A clip in time: the person moves and speaks, the robot's cameras and ears take it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell.teach.cameras import MOUNTS
from dwell.teach.labels import KeyFrame, key_frame
from dwell.teach.motion import HandPath, Point, Stroke
from dwell.teach.person import PERSON, ROBOT, Pose
from dwell.teach.plan import SHORTEST_S
from dwell.teach.pointing import first_hit
from dwell.teach.session import LONGEST_S, Session
from dwell.teach.settings import PHYSICS_RATE_HZ

if TYPE_CHECKING:
    from dwell.engine_types import Channel

#: How high a hand rises over the straight line as it reaches over the table, m.
_ARC_M = 0.10
#: How long the head turns, and stays with the target when the clip shows what it is about, s.
_GAZE_TURN_S = 0.4
_GAZE_STAYS_S = 0.5
#: Depth is kept in mm, in 16 bits; 0 is no reading.
_MM_A_METRE = 1000.0
_MOST_MM = 65_535.0


@dataclasses.dataclass
class Ray:
    """The ray of pointing at the moment when the hand is there.

    Attributes:
        origin: The finger tip, m.
        direction: From the eyes over the finger tip, of length 1.
        hit_id: What it meets first, its id of instance images.
        distance_m: How far that is from the finger tip.
    """

    origin: Point
    direction: Point
    hit_id: int
    distance_m: float


@dataclasses.dataclass
class PlayedClip:
    """What a clip gave.

    Attributes:
        rgb: Pictures of each camera, by its name: (height, width, 3) uint8.
        depth: Depth of each Kinect, mm, 0 without a reading: (height, width) uint16.
        sound: Pressure at the robot's ears, left and right: (2, sample), Pa.
        times_s: When each picture was taken.
        tracks: Places of the acting hand's palm and finger tip, of the target and of the eyes, at
            each picture, m.
        key_frames: Masks and boxes of some pictures.
        utterances: What was said: the words, from when and until when, s.
        ray: Of a clip that points.
        grasp_gap_m: How far the palm was from where it takes the target; of a clip that shows.
    """

    rgb: dict[str, list[NDArray[np.uint8]]]
    depth: dict[str, list[NDArray[np.uint16]]]
    sound: NDArray[np.float32]
    times_s: list[float]
    tracks: dict[str, list[list[float]]]
    key_frames: list[KeyFrame]
    utterances: list[dict[str, Any]]
    ray: Ray | None
    grasp_gap_m: float | None


def play(session: Session) -> PlayedClip:
    """Plays a clip from its first picture to its last."""
    return _Player(session).run()


class _Player:
    """The state of a clip while it runs."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._world, self._person = session.world, session.person
        self._rest = Pose(session.robot_eyes, *session.ready)
        self._path, self._gaze = self._hand_path(), self._gaze_path()
        self._taken: Point | None = None
        self._turn = self._world.body(session.target)["rotation"]
        names = [mount.name for mount in MOUNTS]
        self._clip = PlayedClip(
            rgb={name: [] for name in names},
            depth={mount.name: [] for mount in MOUNTS if mount.has_depth},
            sound=np.zeros((2, 0), np.float32),
            times_s=[],
            tracks={"palm": [], "finger_tip": [], "target": [], "eyes": []},
            key_frames=[],
            utterances=[],
            ray=None,
            grasp_gap_m=None,
        )

    def run(self) -> PlayedClip:
        """Plays, and returns what the clip gave."""
        settings, world = self._session.settings, self._world
        rate = settings.control_rate_hz
        self._wait()
        world.listen(int(LONGEST_S * settings.sound_rate_hz), agent=ROBOT)
        waiting = self._session.phrase.utterances()
        keys = self._key_steps()
        last: int | None = None
        step = 0
        while True:
            time_s = step / rate
            self._act(time_s)
            if step % settings.steps_a_frame == 0:
                self._take(time_s)
                if step in keys or step == last:
                    self._key(keys.get(step, "end"), time_s)
            if step == last:
                break
            speaks = world.speaks(PERSON)
            if waiting and not speaks and time_s >= self._session.plan.timeline.speech_start_s:
                self._utter(waiting.pop(0), time_s)
            elif not waiting and not speaks and last is None and self._clip.utterances:
                last = self._last_step(time_s)
            was_speaking = world.speaks(PERSON)
            world.step()
            if was_speaking and not world.speaks(PERSON):
                self._clip.utterances[-1]["end_s"] = round((step + 1) / rate, 6)
            step += 1
        samples = step * world.samples_a_step
        self._clip.sound = world.listen(samples, agent=ROBOT)
        return self._clip

    def _wait(self) -> None:
        """Lets time pass, for each clip of a user another: noise is drawn from the step's number.

        All clips of a user have one seed, from which its voice is drawn.
        """
        settings, number = self._session.settings, self._session.plan.number
        whole, part = divmod(number, settings.steps_a_frame)
        self._person.take(self._rest)
        for _ in range(part + whole * int(LONGEST_S * settings.control_rate_hz)):
            self._world.step()

    def _hand_path(self) -> HandPath:
        session, times = self._session, self._session.plan.timeline
        start = session.ready[0 if self._person.hand == "left" else 1]
        reach = (times.reach_start_s, times.reach_end_s)
        if session.plan.type == "show":
            strokes = [
                Stroke(*reach, session.grasp, _ARC_M),
                Stroke(times.lift_start_s, times.lift_end_s, session.shown, _ARC_M),
            ]
        elif session.plan.type == "point":
            # Where the palm is in the end, the figure says.
            looking = dataclasses.replace(self._rest, look_at=session.meant)
            self._person.take(looking.pointing_to(self._person.hand, session.finger))
            palm = self._person.palm(self._person.joints())
            strokes = [Stroke(*reach, palm)]
        else:
            strokes = []
        return HandPath(start, strokes)

    def _gaze_path(self) -> HandPath:
        """What the head turns to: the robot, the target while the hand is under way, the robot."""
        session, times = self._session, self._session.plan.timeline
        back_s = times.apex_s + _GAZE_STAYS_S
        return HandPath(
            session.robot_eyes,
            [
                Stroke(times.reach_start_s, times.reach_start_s + _GAZE_TURN_S, session.meant),
                Stroke(back_s, back_s + _GAZE_TURN_S, session.robot_eyes),
            ],
        )

    def _act(self, time_s: float) -> None:
        """Gives person and target the pose of a moment."""
        session, times = self._session, self._session.plan.timeline
        hand, points = self._person.hand, session.plan.type == "point"
        pose = dataclasses.replace(self._rest, look_at=self._gaze.at(time_s))
        if points and time_s >= times.reach_end_s:
            pose = pose.pointing_to(hand, session.finger)
        else:
            pose = pose.with_palm(hand, self._path.at(time_s))
            if points and time_s > times.reach_start_s:
                pose = dataclasses.replace(pose, pointing=hand, point_at=session.finger)
        self._person.take(pose)
        if session.plan.type == "show" and time_s >= times.lift_start_s:
            self._carry(time_s)

    def _carry(self, time_s: float) -> None:
        """Moves what is shown with the palm, and gives it the velocity that it moves on with."""
        session, step_s = self._session, 1.0 / self._session.settings.control_rate_hz
        palm = self._person.palm(self._person.joints())
        if self._taken is None:
            place = np.asarray(self._world.body(session.target)["position"])
            self._taken = place - palm
            self._clip.grasp_gap_m = float(np.linalg.norm(palm - session.grasp))
        velocity = (self._path.at(time_s + step_s) - self._path.at(time_s)) / step_s
        # Gravity has taken this away by the middle of the step: it does not sink, nor fall back
        # on the table.
        gravity = self._world.parameter("world/gravity_m_s2")["value"]
        velocity[1] += gravity * (step_s + 1.0 / PHYSICS_RATE_HZ) / 2.0
        self._world.set_body(
            session.target,
            position=(palm + self._taken).tolist(),
            rotation=self._turn,
            linear_m_s=velocity.tolist(),
        )

    def _utter(self, words: str, time_s: float) -> None:
        self._world.say(PERSON, words)
        row = {"words": words, "start_s": round(time_s, 6), "end_s": None}
        self._clip.utterances.append(row)

    def _last_step(self, time_s: float) -> int:
        """The step of the last picture, once all is said."""
        settings = self._session.settings
        after_s = self._session.plan.timeline.after_speech_s
        end_s = min(max(time_s + after_s, SHORTEST_S), LONGEST_S - 1.0 / settings.fps)
        return int(end_s * settings.fps) * settings.steps_a_frame

    def _key_steps(self) -> dict[int, str]:
        """The steps of pictures that get masks, and their names; the last one is not known yet."""
        settings, times = self._session.settings, self._session.plan.timeline
        middle_s = (times.reach_start_s + times.reach_end_s) / 2.0
        # After the apex, not before it: the hand is there.
        apex = -int(-times.apex_s * settings.fps // 1)
        frames = {0: "start", round(middle_s * settings.fps): "reach", apex: "apex"}
        return {frame * settings.steps_a_frame: name for frame, name in frames.items()}

    def _take(self, time_s: float) -> None:
        """Takes the pictures of a moment."""
        clip = self._clip
        clip.times_s.append(round(time_s, 6))
        for mount in MOUNTS:
            channels: list[Channel] = ["rgb", "depth"] if mount.has_depth else ["rgb"]
            camera = mount.camera(self._session.settings)
            seen = self._world.render(agent=ROBOT, camera=camera, channels=channels)
            clip.rgb[mount.name].append(seen["rgb"])
            if mount.has_depth:
                depth_mm = np.rint(np.clip(seen["depth"][..., 0] * _MM_A_METRE, 0.0, _MOST_MM))
                clip.depth[mount.name].append(depth_mm.astype(np.uint16))
        joints = self._person.joints()
        places = {
            "palm": self._person.palm(joints),
            "finger_tip": joints[f"{self._person.hand}_finger_tip"],
            "target": np.asarray(self._world.object(self._session.target)["center"]),
            "eyes": joints["eyes"],
        }
        for name, place in places.items():
            clip.tracks[name].append([round(float(x), 5) for x in place])

    def _key(self, name: str, time_s: float) -> None:
        """Takes masks, and at the apex of a clip that points its ray."""
        frame = len(self._clip.times_s) - 1
        self._clip.key_frames.append(key_frame(self._session, name, frame, time_s))
        if name == "apex" and self._session.plan.type == "point":
            origin, direction = self._person.ray(self._person.joints())
            hit, distance_m = first_hit(self._world, origin, direction)
            self._clip.ray = Ray(origin, direction, hit, distance_m)
