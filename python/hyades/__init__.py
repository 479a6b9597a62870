"""Jobs for Hyades, the path-tracing render farm, out of Python: describe, render, submit, fetch.

    import hyades
    from hyades import objects, materials

    job = hyades.Job(name="ball")
    job.objects["ball"] = objects.Sphere(material=materials.Lambert(color=[0.8, 0.1, 0.05]))
    picture = hyades.render(job, output="out").picture()

docs/python.md tells the rest; `python3 -m hyades` shows whether the program is found.
"""

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("the package hyades needs numpy (Debian: apt install python3-numpy)") from error

from .errors import Complaint, FarmError, FileRefused, HyadesError, JobError, KeyRefused, ProgramError
from .exr import Layers, read_exr, write_exr
from .farm import Farm
from .job import Job
from .job_types import cameras, integrators, lights, materials, media, objects, outputs, settings, textures, transforms
from .job_types.lights import Environment, Sky
from .job_types.settings import ColorManagement, Film, Filter, Frames, Render, Sampling
from .job_types.transforms import Rotation, Step
from .mesh import MeshData, Places, Strands
from .picture import Picture
from .program import check, find_program
from .render import Progress, Rendering, render
from .values import Keys


__all__ = [
    "ColorManagement", "Complaint", "Environment", "Farm", "FarmError", "FileRefused", "Film",
    "Filter", "Frames", "HyadesError", "Job", "JobError", "KeyRefused", "Keys", "Layers",
    "MeshData", "Picture", "Places", "ProgramError", "Progress", "Render", "Rendering",
    "Rotation", "Sampling", "Sky", "Step", "Strands", "cameras", "check", "find_program", "integrators", "lights",
    "materials", "media", "objects", "outputs", "read_exr", "render", "settings", "textures",
    "transforms", "write_exr",
]
