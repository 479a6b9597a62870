"""Whether two pictures of one scene mean the same: their means, and the means of their blocks."""

import numpy

BLOCK = 8
"""Side of a block [pixels]."""


class Comparison:
    """Two pictures (h, w, 3) of light, by channel where they are coloured."""

    def __init__(self, cycles: numpy.ndarray, hyades: numpy.ndarray) -> None:
        self.cycles, self.hyades = (picture.mean(axis=(0, 1)) for picture in (cycles, hyades))
        scale = max(float(self.cycles.mean()), 1e-9)
        # A channel that is nearly black counts against a tenth of the whole.
        self.mean = float(numpy.max(numpy.abs(self.hyades - self.cycles) / numpy.maximum(self.cycles, scale / 10)))
        a, b = blocks(cycles), blocks(hyades)
        # Dark blocks count against a quarter of the picture: there is little light in them to be off by.
        self.blocks = numpy.abs(a - b) / numpy.maximum(a, scale / 4)

    @property
    def block(self) -> float:
        """The largest difference of a block."""
        return float(self.blocks.max())

    def __str__(self) -> str:
        def colors(light):
            return " ".join(f"{channel:.4f}" for channel in light)

        return f"{colors(self.cycles)}  {colors(self.hyades)}  {100 * self.mean:5.2f} %  {100 * self.block:5.2f} %"


def blocks(picture: numpy.ndarray) -> numpy.ndarray:
    """Luminance of blocks; a rest at the edges is left out."""
    light = picture @ numpy.array([0.2126, 0.7152, 0.0722])
    rows, columns = light.shape[0] // BLOCK, light.shape[1] // BLOCK
    return light[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK).mean(axis=(1, 3))
