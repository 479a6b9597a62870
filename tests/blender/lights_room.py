"""What scenes of lamps and worlds show."""

from scene import floor, material, primitive


def room() -> None:
    """A floor with a matt ball."""
    floor()
    primitive("uv_sphere", material("Ball", Color=(0.8, 0.4, 0.2)), at=(0, 0, 1), smooth=True, segments=64, ring_count=32)
