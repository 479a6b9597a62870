"""What a coordinator answers, taken with bounds: who runs a hostile one must get neither all memory here nor
an exception that nobody expects."""

from __future__ import annotations

import http.client
import json
from typing import Any, TypeVar

from ..errors import FarmError
from ..machine import usable_memory

_T = TypeVar("_T")
_PIECE = 1 << 20
# Bytes of an answer, of which Python makes up to thirty times as many; lists come in pages, which are far smaller.
MOST_JSON = min(64 << 20, max(8 << 20, usable_memory() // 64))


def read_bounded(answer: http.client.HTTPResponse, most: int) -> bytes:
    """The whole of an answer. FarmError where it has more than `most` bytes; IncompleteRead where it was cut off."""
    data = bytearray()
    while piece := answer.read(min(_PIECE, most + 1 - len(data))):
        data += piece
        if len(data) > most:
            raise too_much("an answer", most)
    if answer.length:
        raise http.client.IncompleteRead(b"", answer.length)
    return bytes(data)


def decoded(text: str | bytes) -> Any:
    """What JSON says; FarmError where it is none, or lists within lists without end."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        said = "too deep" if isinstance(error, RecursionError) else str(error)
        raise FarmError("unknown", f"the coordinator's answer is not the JSON that was expected: {said}") from None


def part(answer: Any, name: str, kind: type[_T]) -> _T:
    """The value `name` of an answer, or of a row of one; FarmError where it has none of this kind."""
    found = answer.get(name) if isinstance(answer, dict) else None
    if not isinstance(found, kind):
        raise FarmError("unknown", f"the coordinator's answer has not what was expected: '{name}' ({kind.__name__})")
    return found


def too_much(what: str, most: int) -> FarmError:
    """That `what` is longer than `most` bytes."""
    size = f"{most / (1 << 20):.1f} MiB" if most >= 1 << 20 else f"{most} bytes"
    return FarmError("resource_exhausted", f"the coordinator sends {what} of more than {size}")


def no_end() -> FarmError:
    """That a list promises more and does not go on."""
    return FarmError("unknown", "the coordinator's list does not go on, though it promises more")
