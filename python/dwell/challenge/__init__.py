"""Cases with a hidden cause, for methods that name what a simulation lacks, and their scores.

The worlds are small integrators of their own, which share no code with the engines. A bundle holds
no trace of its cause: what is known of the situation is drawn before the cause, and names and order
are random.
"""

from dwell.challenge.baselines import least_squares, one_at_a_time
from dwell.challenge.cases import Case, ChallengeSettings, case
from dwell.challenge.rows import read_answers, read_verdicts
from dwell.challenge.running import calibrated_verdict, run
from dwell.challenge.scores import score
from dwell.challenge.writing import make

__all__ = [
    "Case",
    "ChallengeSettings",
    "calibrated_verdict",
    "case",
    "least_squares",
    "make",
    "one_at_a_time",
    "read_answers",
    "read_verdicts",
    "run",
    "score",
]
