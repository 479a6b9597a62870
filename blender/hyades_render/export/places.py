"""Where copies stand, as matrices: `places` of an instance."""

from __future__ import annotations

from typing import Any

import numpy


class MatrixPlaces:
    """matrices (n, 4, 4), whose last row is 0, 0, 0, 1."""

    def __init__(self, matrices: Any) -> None:
        self.matrices = numpy.asarray(matrices)

    def encode(self) -> tuple[bytes, str]:
        """The bytes of a binary PLY file."""
        names = [f"m{row}{column}" for row in range(3) for column in range(4)]
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.matrices)}\n"
        head += "".join(f"property float {name}\n" for name in names) + "end_header\n"
        return head.encode() + self.matrices[:, :3, :].reshape(-1, 12).astype("<f4").tobytes(), ".ply"
