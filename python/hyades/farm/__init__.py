"""A farm's coordinator, over its HTTP API (docs/dashboard.md)."""

from .client import Farm
from .films import FilmLayer
from .states import Change, FrameState, JobState, LogLine, OutputFile, WorkerState

__all__ = ["Change", "Farm", "FilmLayer", "FrameState", "JobState", "LogLine", "OutputFile", "WorkerState"]
