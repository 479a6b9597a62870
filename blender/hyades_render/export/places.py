"""Where copies stand, as matrices: `places` of an instance."""

from __future__ import annotations

from typing import Any, Optional

import numpy


class MatrixPlaces:
    """matrices (n, 4, 4), whose last row is 0, 0, 0, 1.

    ids: what tells each copy from others at other moments, too; None: nobody asks.
    """

    def __init__(self, matrices: Any, ids: Optional[list[Any]] = None) -> None:
        self.matrices = numpy.asarray(matrices)
        self.ids = ids

    def encode(self) -> tuple[bytes, str]:
        """The bytes of a binary PLY file."""
        names = [f"m{row}{column}" for row in range(3) for column in range(4)]
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.matrices)}\n"
        head += "".join(f"property float {name}\n" for name in names) + "end_header\n"
        return head.encode() + self.matrices[:, :3, :].reshape(-1, 12).astype("<f4").tobytes(), ".ply"
