"""Independent oracles for predicates: pictures, clouds of points, physics and walks.

An oracle knows a predicate's sentence in ``docs/predicates.md`` and its threshold, and nothing of
how the engine decides it. Where what it measures is too near to a threshold, or shows too little
of the things, its answer is ``grey``: it cannot decide. Margins stand beside each.

``python -m oracles`` asks in many houses; ``test_oracles.py`` asks in a few small ones.
"""
