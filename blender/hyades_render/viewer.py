"""Pictures that `hyades render --display` sends while they are rendered (docs/display.md): tev's packets over TCP."""

from __future__ import annotations

import socket
import struct
import threading
import time
from collections.abc import Sequence

import numpy

_CLOSE, _CREATE, _UPDATE = 2, 4, 6
_LONGEST = 1 << 28  # bytes of a packet: far more than a part of a picture with all layers
_MOST_PIXELS = 1 << 28


class Picture:
    """One picture as it is now. Its parts are replaced by the thread of a Viewer."""

    def __init__(self, width: int, height: int, channels: list[str]) -> None:
        self.width = width
        self.height = height
        self.channels = channels
        self.values = numpy.zeros((height, width, len(channels)), numpy.float32)
        self.changes = 0

    def pixels(self, names: Sequence[str] = "RGBA") -> numpy.ndarray:
        """The channels `names`, (height, width, len(names)), row 0 at the top; those that are not there are 1."""
        picture = numpy.ones((self.height, self.width, len(names)), numpy.float32)
        for at, name in enumerate(names):
            if name in self.channels:
                picture[:, :, at] = self.values[:, :, self.channels.index(name)]
        return picture


class Viewer:
    """Listens on a port of this machine alone, from a thread of its own, until it is closed."""

    def __init__(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._listener.settimeout(0.2)
        self._lock = threading.Lock()
        self._pictures: dict[str, Picture] = {}
        self._newest = ""
        self._closed = False
        self._silent = threading.Event()  # nobody is connected
        self._silent.set()
        self._thread = threading.Thread(target=self._run, name="hyades-viewer", daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        """HOST:PORT, as `--display` takes it."""
        return "127.0.0.1:%d" % self._listener.getsockname()[1]

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the thread."""
        self._closed = True
        self._thread.join()

    def wait_for_rest(self, seconds: float) -> None:
        """Waits until all that a renderer has sent before it ended is here, for so long at most."""
        time.sleep(0.02)  # for a connection that waits to be accepted
        self._silent.wait(seconds)

    def changes(self) -> int:
        """How many parts of the newest picture have come."""
        with self._lock:
            newest = self._pictures.get(self._newest)
            return newest.changes if newest else 0

    def pixels(self, names: Sequence[str] = "RGBA") -> numpy.ndarray | None:
        """The newest picture's channels, see Picture; None before there is one."""
        with self._lock:
            newest = self._pictures.get(self._newest)
            return newest.pixels(names) if newest else None

    def _run(self) -> None:
        with self._listener:
            while not self._closed:
                try:
                    connection, _ = self._listener.accept()
                except (TimeoutError, socket.timeout):
                    continue
                except OSError:
                    return
                self._silent.clear()
                with connection:
                    connection.settimeout(0.2)
                    try:
                        self._read(connection)
                    except (OSError, ValueError, struct.error, EOFError):
                        pass  # its end, or not what a renderer says: it may come again
                self._silent.set()

    def _read(self, connection: socket.socket) -> None:
        while not self._closed:
            (length,) = struct.unpack("<I", self._bytes(connection, 4))
            if not 5 <= length <= _LONGEST:
                raise ValueError(f"a packet of {length} bytes")
            self._take(_Packet(self._bytes(connection, length - 4)))

    def _bytes(self, connection: socket.socket, count: int) -> bytearray:
        data = bytearray(count)
        view, at = memoryview(data), 0
        while at < count:
            try:
                read = connection.recv_into(view[at:])
            except (TimeoutError, socket.timeout):
                if self._closed:
                    raise EOFError from None
                continue
            if read == 0:
                raise EOFError
            at += read
        return data

    def _take(self, packet: _Packet) -> None:
        operation = packet.byte()
        if operation == _CLOSE:
            with self._lock:
                self._pictures.pop(packet.text(), None)
        elif operation == _CREATE:
            packet.byte()  # whether it comes to the front: it does
            name, (width, height) = packet.text(), packet.ints(2)
            channels = packet.texts()
            if not (width > 0 < height and width * height * max(len(channels), 1) <= 8 * _MOST_PIXELS):
                raise ValueError(f"a picture of {width} x {height}")
            with self._lock:
                self._pictures[name] = Picture(width, height, channels)
                self._newest = name
        elif operation == _UPDATE:
            self._update(packet)

    def _update(self, packet: _Packet) -> None:
        packet.byte()
        name = packet.text()
        channels = packet.texts()
        x, y, width, height = packet.ints(4)
        count = len(channels)
        packet.skip(16 * count)  # offsets and strides: the channels of a pixel lie together
        values = packet.floats(width * height * count).reshape(height, width, count)
        with self._lock:
            picture = self._pictures.get(name)
            if picture is None or picture.channels != channels:
                return
            if not (0 <= x <= x + width <= picture.width and 0 <= y <= y + height <= picture.height):
                raise ValueError("a part outside of its picture")
            picture.values[y : y + height, x : x + width] = values
            picture.changes += 1


class _Packet:
    """Fields of a packet, one after the other; struct.error, ValueError where it is too short."""

    def __init__(self, data: bytearray) -> None:
        self._data = data
        self._at = 0

    def byte(self) -> int:
        self._at += 1
        return self._data[self._at - 1] if self._at <= len(self._data) else _short()

    def ints(self, count: int) -> tuple[int, ...]:
        found = struct.unpack_from(f"<{count}i", self._data, self._at)
        self._at += 4 * count
        return found

    def text(self) -> str:
        end = self._data.index(0, self._at)
        found = self._data[self._at : end].decode("utf-8", "replace")
        self._at = end + 1
        return found

    def texts(self) -> list[str]:
        (count,) = self.ints(1)
        if not 0 <= count <= len(self._data):
            _short()
        return [self.text() for _ in range(count)]

    def skip(self, count: int) -> None:
        self._at += count

    def floats(self, count: int) -> numpy.ndarray:
        if count < 0:
            _short()
        return numpy.frombuffer(self._data, "<f4", count, self._at)


def _short() -> int:
    raise ValueError("a packet that is too short")
