"""Scenes of the truth tests, a file for each subject."""
