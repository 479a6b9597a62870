"""Lamps and worlds."""

import math

from lights_room import room
from scene import camera, light, scene, world


@scene()
def point() -> None:
    room()
    light("POINT", 300, at=(2, -2, 4), color=(1, 0.8, 0.5), shadow_soft_size=0)


@scene()
def point_with_radius() -> None:
    room()
    light("POINT", 300, at=(2, -2, 4), shadow_soft_size=0.4)


@scene()
def sun() -> None:
    room()
    light("SUN", 3, at=(2, -2, 4), color=(1, 0.9, 0.8), angle=math.radians(8))


@scene()
def sharp_sun() -> None:
    room()
    light("SUN", 3, at=(-2, -2, 4), angle=0)


@scene()
def spot() -> None:
    room()
    light("SPOT", 600, at=(2, -2, 5), towards=(0, 0, 0.5), spot_size=math.radians(50), spot_blend=0.5, shadow_soft_size=0)


@scene()
def spot_with_radius() -> None:
    room()
    light("SPOT", 600, at=(2, -2, 5), towards=(0, 0, 0.5), spot_size=math.radians(50), spot_blend=0.5, shadow_soft_size=0.4)


@scene()
def area_with_spread() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="RECTANGLE", size=2, size_y=1, spread=math.radians(70))


@scene()
def area_rectangle() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="RECTANGLE", size=2, size_y=1)


@scene()
def area_square_scaled() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="SQUARE", size=1).scale = (2, 0.5, 1)


@scene()
def area_disk() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="DISK", size=1.5)


@scene()
def area_ellipse() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="ELLIPSE", size=2, size_y=1)


@scene()
def area_from_behind() -> None:
    # The lamp shines away from the camera's side: it lights the floor, and is dark from above.
    room()
    light("AREA", 100, at=(0, 0, 2.6), towards=(0, 0, 0), shape="SQUARE", size=1.5)
    camera((0, -5, 4.5), (0, 0, 1))


@scene()
def plain_world() -> None:
    room()
    world((0.4, 0.5, 0.7), 1.5)
