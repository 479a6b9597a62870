"""Real coordinators and workers on this machine, ended by their ids whatever happens."""

import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from environment import HYADES


class FarmProcess:
    """One coordinator with its folder, and workers that come and go."""

    def __init__(self, test: unittest.TestCase, folder: pathlib.Path, *options: str) -> None:
        self._folder = folder
        self._options = options
        self.listen = self._http = "127.0.0.1:0"  # listen: where workers and commands find it
        self._processes: list[subprocess.Popen] = []
        folder.mkdir(parents=True)
        test.addCleanup(self._end)
        self.start()

    def start(self) -> None:
        """Begins (again), where it was."""
        log = self._folder / "coordinator.log"
        log.unlink(missing_ok=True)
        (self._folder / "data/address").unlink(missing_ok=True)
        command = ["coordinator", "--data", str(self._folder / "data"), "--listen", self.listen, "--http", self._http]
        self.coordinator = self._run([*command, *self._options], log)
        found = self._wait_for(lambda: re.search(r"dashboard at (https?)://([^\s/]+)", log.read_text()))
        self.address = f"{found[1]}://{found[2]}"
        self._http = found[2]
        self.listen = self._wait_for(lambda: re.search(r"listening on (\S+)", log.read_text()))[1]

    def worker(self) -> subprocess.Popen:
        cache = self._folder / f"cache-{len(self._processes)}"
        command = ["worker", "--coordinator", self.listen, "--threads", "1", "--cache", str(cache)]
        return self._run(command, self._folder / "workers.log")

    def kill(self, process: subprocess.Popen) -> None:
        """At once, as a power cut would; with all that it has started."""
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()

    def _run(self, command: list[str], log: pathlib.Path) -> subprocess.Popen:
        with open(log, "ab") as out:
            # Not even a test that is killed leaves them behind.
            alone = ["setpriv", "--pdeathsig", "KILL", str(HYADES)]
            process = subprocess.Popen([*alone, *command], stdout=out, stderr=out, start_new_session=True)
        self._processes.append(process)
        return process

    def _wait_for(self, look):
        for _ in range(300):
            if found := look():
                return found
            time.sleep(0.1)
        raise AssertionError("the coordinator does not start: " + (self._folder / "coordinator.log").read_text())

    def _end(self) -> None:
        for process in self._processes:
            self.kill(process)
