"""`python3 -m hyades`: whether the program is there, and how to begin."""

from __future__ import annotations

import sys
from pathlib import Path

from .errors import HyadesError
from .program import find_program, run_program

HELP = """\
hyades for Python: jobs out of objects and arrays, rendered here or on a farm

  package   {package}
  program   {program}

    import hyades
    from hyades import materials, objects

    job = hyades.Job(name="ball")
    job.objects["ball"] = objects.Sphere(material=materials.Lambert(color=[0.8, 0.1, 0.05]))
    job.environment = hyades.Environment(color=[0.5, 0.6, 0.8])
    picture = hyades.render(job, "out").picture()     # on this machine
    farm = hyades.Farm("http://127.0.0.1:8080")       # or on a farm
    farm.fetch(farm.wait(farm.submit(job)), "out")

help(hyades) and docs/python.md tell more; docs/job.md describes every key of a job."""


def main() -> int:
    if len(sys.argv) > 1 and sys.argv[1:] not in (["-h"], ["--help"]):
        print(f"hyades: unexpected {sys.argv[1]!r}: jobs are rendered by a script of yours, or by "
              "the program: hyades render job.yaml", file=sys.stderr)
        return 2
    try:
        path = find_program()
        program = f"{path} ({run_program(['--version'], path).strip()})"
    except HyadesError as error:
        program = f"none: {error}"
    print(HELP.format(package=Path(__file__).parent, program=program))
    return 0


if __name__ == "__main__":
    sys.exit(main())
