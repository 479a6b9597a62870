"""Calls to a coordinator: where it is, or those that stand by for it, who calls, and what is tried again."""

from __future__ import annotations

import http.client
import ipaddress
import json
import os
import random
import socket
import ssl
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple, TypeVar
from urllib.parse import urlencode, urlsplit

from ..errors import FarmError
from .answers import MOST_JSON, decoded, part, read_bounded

_T = TypeVar("_T")
_FIRST_PATIENCE = 3.0  # seconds, for a coordinator that has never answered
_FIRST_PATIENCE_OF_SEVERAL = 15.0  # none of them leads for a moment when the one that led is gone
_SOON = 5.0  # seconds to connect to one of several: another may have taken its place
_LONGEST_WAIT = 5.0
_LONGEST_CALL = 300.0  # seconds; 64 MB of JSON over a slow line
_AGAIN = (502, 503, 504)
_DEFAULT_PORT = 8080
_NETWORK = (OSError, http.client.HTTPException)


class Place(NamedTuple):
    """Where a coordinator answers."""

    secure: bool
    host: str
    port: int

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"


class Http:
    """HTTP/1.1 to the one of some coordinators that leads. Redirects are never followed, they only say that it is
    another one: the token is for nobody whom the user has not named."""

    def __init__(
        self,
        address: str | None,
        token: str | None,
        ca: str | os.PathLike[str] | None,
        certificate: tuple[str, str] | None,
        insecure: bool,
        patience: float,
    ) -> None:
        environment = os.environ
        ca = ca or environment.get("HYADES_TLS_CA")
        named = (address or _default_address()).split(",")
        self._places = list(dict.fromkeys(_place(one.strip(), ca is not None) for one in named))
        for place in self._places:
            if not place.secure and not insecure and not is_loopback(place.host):
                raise ValueError(
                    f"{place.host} is another machine: expected https:// and ca=, or insecure=True to send plain text"
                )
        self.place = self._places[0]
        """The current one: that which has answered last, or whose turn it is."""
        self._tls = _tls_context(ca, certificate) if any(place.secure for place in self._places) else None
        self._token = token if token is not None else _token_of_file(environment.get("HYADES_TOKEN_FILE"))
        self.has_token = bool(self._token)
        self._patience = patience
        self._several = len(self._places) > 1
        self._first_patience = min(patience, _FIRST_PATIENCE_OF_SEVERAL if self._several else _FIRST_PATIENCE)
        self._reached = False

    def call(
        self,
        method: str,
        path: str,
        *,
        query: Mapping[str, Any] | None = None,
        message: Any = None,
        body: bytes | None = None,
        timeout: float = 30.0,
    ) -> Any:
        """What a call answers, from JSON; None where it answers nothing. FarmError."""
        headers = {}
        if message is not None:
            body, headers = json.dumps(message).encode(), {"Content-Type": "application/json"}

        def once() -> Any:
            connection = self._connection(timeout)
            with _ended_after(connection.sock, _LONGEST_CALL):
                with self._answer(connection, method, path, query, body, headers) as answer:
                    data = read_bounded(answer, MOST_JSON)
            return decoded(data) if data else None

        return self.patiently(once)

    def patiently(self, once: Callable[[], _T], reached: Callable[[], object] = lambda: None) -> _T:
        """`once`, again and again while there is hope: a coordinator that was there may restart, or another one
        take the lead. Of several each has its turn before a wait, and the one that answers stays the current one.
        Whenever `reached` tells something new, patience begins anew."""
        deadline, wait, mark = None, 0.1, reached()
        failures: list[FarmError] = []  # of this round
        while True:
            place = self.place
            try:
                result = once()
                self._reached = True
                return result
            except ssl.SSLCertVerificationError as error:
                raise FarmError("untrusted", f"{place.host} cannot be trusted: {error}") from None
            except _Elsewhere as elsewhere:
                failure = elsewhere.error
                if not self._several:
                    raise failure from None
            except _Again as again:
                failure, self._reached = again.error, True
                wait = max(wait, again.after)
            except _NETWORK as error:
                failure = FarmError("unavailable", f"no coordinator answers at {place}: {error}")
            now = time.monotonic()
            if reached() != mark:
                deadline, wait, mark = None, 0.1, reached()
                failures = []
            failures.append(failure)
            self._pass_on(place)
            if len(failures) < len(self._places):
                continue
            deadline = deadline or now + (self._patience if self._reached else self._first_patience)
            if now + wait > deadline:
                raise _failure_of_all(failures) from None
            time.sleep(wait * random.uniform(0.75, 1.25))
            wait = min(2 * wait, _LONGEST_WAIT)
            failures = []

    def _pass_on(self, place: Place) -> None:
        """It is the next one's turn, unless another thread has said so."""
        if self.place == place:
            self.place = self._places[(self._places.index(place) + 1) % len(self._places)]

    @contextmanager
    def open(
        self,
        method: str,
        path: str,
        *,
        query: Mapping[str, Any] | None = None,
        body: bytes | None = None,
        headers: Mapping[str, str] | None = None,
        timeout: float = 30.0,
    ) -> Iterator[http.client.HTTPResponse]:
        """One try of a call, whose answer is read by whoever opened it."""
        with self._answer(self._connection(timeout), method, path, query, body, headers) as answer:
            yield answer

    @contextmanager
    def _answer(
        self,
        connection: http.client.HTTPConnection,
        method: str,
        path: str,
        query: Mapping[str, Any] | None,
        body: bytes | None,
        headers: Mapping[str, str] | None,
    ) -> Iterator[http.client.HTTPResponse]:
        try:
            known = {"Authorization": f"Bearer {self._token}"} if self._token else {}
            if query:
                path += "?" + urlencode({name: _text(value) for name, value in query.items() if value is not None})
            connection.request(method, path, body, {**known, **(headers or {})})
            answer = connection.getresponse()
            if answer.status not in (200, 201, 202, 204, 206):
                raise _failure(answer, f"{connection.host}:{connection.port}")
            yield answer
        finally:
            connection.close()

    def _connection(self, timeout: float) -> http.client.HTTPConnection:
        """One to the current coordinator, which is there."""
        place, soon = self.place, min(timeout, _SOON) if self._several else timeout
        if place.secure:
            secure = http.client.HTTPSConnection(place.host, place.port, timeout=soon, context=self._tls)
            connection: http.client.HTTPConnection = secure
        else:
            connection = http.client.HTTPConnection(place.host, place.port, timeout=soon)
        connection.connect()
        connection.sock.settimeout(timeout)
        return connection


@contextmanager
def _ended_after(line: socket.socket, seconds: float) -> Iterator[None]:
    """Cuts the line off where a call takes longer in all, as one does that comes drop by drop."""

    def cut() -> None:
        with suppress(OSError):
            line.shutdown(socket.SHUT_RDWR)

    timer = threading.Timer(seconds, cut)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


class _Again(Exception):
    """An answer that says: later."""

    def __init__(self, error: FarmError, after: float) -> None:
        super().__init__(str(error))
        self.error = error
        self.after = after


class _Elsewhere(Exception):
    """An answer that says: another one leads."""

    def __init__(self, error: FarmError) -> None:
        super().__init__(str(error))
        self.error = error


def is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _failure(answer: http.client.HTTPResponse, place: str) -> Exception:
    """What an answer that is no success says, of who answers at `place`."""
    if 300 <= answer.status < 400:
        return _Elsewhere(FarmError("moved", _sent_on(place, answer.status, answer.getheader("Location", ""))))
    data = answer.read(1 << 20)
    said: dict[str, Any]
    try:
        said = part(decoded(data), "error", dict)
        code, message = part(said, "code", str), part(said, "message", str)
    except FarmError:
        said, code = {}, "unavailable" if answer.status in _AGAIN else "unknown"
        message = f"status {answer.status}: {data[:200].decode('utf-8', 'replace')}"
    missing = part(said, "missing", list) if "missing" in said else []
    error = FarmError(code, message, tuple(digest for digest in missing if isinstance(digest, str)))
    if answer.status in _AGAIN or "retry_after_ms" in said:
        return _Again(error, _wait_asked(said.get("retry_after_ms", 0)))
    return error


def _sent_on(place: str, status: int, location: str) -> str:
    """What a redirect says; that of a stand-by names the coordinator that leads."""
    try:
        parts = urlsplit(location)
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    if status != 307 or not host or parts.scheme not in ("http", "https"):
        return f"the coordinator at {place} sends elsewhere (status {status}), which is not followed"
    leader = (f"[{host}]" if ":" in host else host) + (f":{port}" if port else "")
    return (
        f"the coordinator at {place} stands by, and the one at {parts.scheme}://{leader[:300]} leads: name that one, "
        "or all of them with commas between (it is not followed by itself)"
    )


def _failure_of_all(failures: list[FarmError]) -> FarmError:
    """What a round over all coordinators has come to: what the one that leads has answered, or why none has."""
    for failure in failures:
        if failure.code not in ("moved", "unavailable") or len(failures) == 1:
            return failure
    code = "unavailable" if any(failure.code == "unavailable" for failure in failures) else "moved"
    return FarmError(code, "; ".join(dict.fromkeys(str(failure) for failure in failures)))


def _wait_asked(milliseconds: Any) -> float:
    """Seconds; 0 where it is no time to wait."""
    good = isinstance(milliseconds, (int, float)) and milliseconds > 0
    return float(min(milliseconds, 1000 * _LONGEST_WAIT)) / 1000 if good else 0.0


def _default_address() -> str:
    """HYADES_HTTP; else the machines that HYADES_COORDINATOR names, or this one, at the usual port."""
    if address := os.environ.get("HYADES_HTTP"):
        return address
    coordinators = os.environ.get("HYADES_COORDINATOR", "127.0.0.1:7700").split(",")
    return ",".join(f"{one.rpartition(':')[0] or one}:{_DEFAULT_PORT}" for one in coordinators)


def _place(address: str, secure: bool) -> Place:
    """That of "https://farm.example:8080", "farm.example:8080" or "[::1]:8080"."""
    text = address if "://" in address else f"{'https' if secure else 'http'}://{address}"
    try:
        parts = urlsplit(text)
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    good = host and parts.scheme in ("http", "https") and parts.path in ("", "/") and not parts.query
    if not good or parts.username is not None:
        raise ValueError(f"the coordinator's address is '{address}', expected http(s)://HOST:PORT")
    return Place(parts.scheme == "https", str(host), port or _DEFAULT_PORT)


def _tls_context(ca: str | os.PathLike[str] | None, certificate: tuple[str, str] | None) -> ssl.SSLContext:
    context = ssl.create_default_context(cafile=ca)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    own = certificate or (os.environ.get("HYADES_TLS_CERT", ""), os.environ.get("HYADES_TLS_KEY", ""))
    if own[0]:
        context.load_cert_chain(own[0], own[1] or None)
    return context


def _token_of_file(path: str | None) -> str | None:
    return Path(path).read_text(encoding="ascii").strip() if path else None


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


