"""A coordinator that does what a test tells it, right or wrong."""

import http.server
import threading
import unittest
from collections.abc import Callable
from contextlib import suppress
from typing import Any


class Request:
    def __init__(self, method: str, path: str, headers: Any, body: bytes) -> None:
        self.method, self.path, self.headers, self.body = method, path, headers, body


Answer = "tuple[int, dict[str, str], bytes] | None"  # None: the connection is closed without one


class FakeFarm:
    """`answer` is asked for each request; `requests` are all that came."""

    def __init__(self, test: unittest.TestCase, answer: Callable[[Request], Any]) -> None:
        self.requests: list[Request] = []
        farm = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def handle_one(self) -> None:
                size = int(self.headers.get("Content-Length") or 0)
                request = Request(self.command, self.path, self.headers, self.rfile.read(size))
                farm.requests.append(request)
                said = answer(request)
                if said is None:
                    return
                status, headers, body = said
                self.send_response(status)
                pieces = [body] if isinstance(body, bytes) else body  # else one after the other
                length = {"Content-Length": str(len(body))} if isinstance(body, bytes) else {}
                for name, value in {**length, **headers}.items():
                    self.send_header(name, value)
                self.end_headers()
                with suppress(OSError):  # who asked may be gone
                    for piece in pieces:
                        self.wfile.write(piece)
                        self.wfile.flush()

            do_GET = do_POST = do_PUT = handle_one

            def log_message(self, *_: Any) -> None:
                pass

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        test.addCleanup(self._server.server_close)
        test.addCleanup(self._server.shutdown)
        self.address = f"http://127.0.0.1:{self._server.server_port}"
