"""Localization of sounds: recordings with labels, measures, and baselines."""
