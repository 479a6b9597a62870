"""Calls to a coordinator: where it is, who calls, and what is tried again."""

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
from typing import Any, TypeVar
from urllib.parse import urlencode, urlsplit

from ..errors import FarmError
from .answers import MOST_JSON, decoded, part, read_bounded

_T = TypeVar("_T")
_FIRST_PATIENCE = 3.0  # seconds, for a coordinator that has never answered
_LONGEST_WAIT = 5.0
_LONGEST_CALL = 300.0  # seconds; 64 MB of JSON over a slow line
_AGAIN = (502, 503, 504)
_DEFAULT_PORT = 8080
_NETWORK = (OSError, http.client.HTTPException)


class Http:
    """HTTP/1.1 to one coordinator. Redirects are never followed: the token is for nobody else."""

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
        self.secure, self.host, self.port = _place(address or _default_address(), ca is not None)
        if not self.secure and not insecure and not is_loopback(self.host):
            raise ValueError(
                f"{self.host} is another machine: expected https:// and ca=, or insecure=True to send plain text"
            )
        self._tls = _tls_context(ca, certificate) if self.secure else None
        self._token = token if token is not None else _token_of_file(environment.get("HYADES_TOKEN_FILE"))
        self.has_token = bool(self._token)
        self._patience = patience
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
            connection.connect()
            with _ended_after(connection.sock, _LONGEST_CALL):
                with self._answer(connection, method, path, query, body, headers) as answer:
                    data = read_bounded(answer, MOST_JSON)
            return decoded(data) if data else None

        return self.patiently(once)

    def patiently(self, once: Callable[[], _T], reached: Callable[[], object] = lambda: None) -> _T:
        """`once`, again and again while there is hope: a coordinator that was there may restart.
        Whenever `reached` tells something new, patience begins anew."""
        deadline, wait, mark = None, 0.1, reached()
        while True:
            try:
                result = once()
                self._reached = True
                return result
            except ssl.SSLCertVerificationError as error:
                raise FarmError("untrusted", f"{self.host} cannot be trusted: {error}") from None
            except _Again as again:
                failure, self._reached = again.error, True
                wait = max(wait, again.after)
            except _NETWORK as error:
                failure = FarmError("unavailable", f"no coordinator answers at {self.host}:{self.port}: {error}")
            now = time.monotonic()
            if reached() != mark:
                deadline, wait, mark = None, 0.1, reached()
            deadline = deadline or now + (self._patience if self._reached else min(self._patience, _FIRST_PATIENCE))
            if now + wait > deadline:
                raise failure from None
            time.sleep(wait * random.uniform(0.75, 1.25))
            wait = min(2 * wait, _LONGEST_WAIT)

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
                raise _failure(answer)
            yield answer
        finally:
            connection.close()

    def _connection(self, timeout: float) -> http.client.HTTPConnection:
        if self._tls is None:
            return http.client.HTTPConnection(self.host, self.port, timeout=timeout)
        return http.client.HTTPSConnection(self.host, self.port, timeout=timeout, context=self._tls)


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


def is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _failure(answer: http.client.HTTPResponse) -> Exception:
    """What an answer that is no success says."""
    if 300 <= answer.status < 400:
        return FarmError("moved", f"the coordinator sends elsewhere (status {answer.status}), which is not followed")
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


def _wait_asked(milliseconds: Any) -> float:
    """Seconds; 0 where it is no time to wait."""
    good = isinstance(milliseconds, (int, float)) and milliseconds > 0
    return float(min(milliseconds, 1000 * _LONGEST_WAIT)) / 1000 if good else 0.0


def _default_address() -> str:
    """HYADES_HTTP; else the machine that HYADES_COORDINATOR names, or this one, at the usual port."""
    if address := os.environ.get("HYADES_HTTP"):
        return address
    coordinator = os.environ.get("HYADES_COORDINATOR", "127.0.0.1:7700")
    return f"{coordinator.rpartition(':')[0] or coordinator}:{_DEFAULT_PORT}"


def _place(address: str, secure: bool) -> tuple[bool, str, int]:
    """https?, host and port of "https://farm.example:8080", "farm.example:8080" or "[::1]:8080"."""
    text = address if "://" in address else f"{'https' if secure else 'http'}://{address}"
    try:
        parts = urlsplit(text)
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    good = host and parts.scheme in ("http", "https") and parts.path in ("", "/") and not parts.query
    if not good or parts.username is not None:
        raise ValueError(f"the coordinator's address is '{address}', expected http(s)://HOST:PORT")
    return parts.scheme == "https", str(host), port or _DEFAULT_PORT


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


