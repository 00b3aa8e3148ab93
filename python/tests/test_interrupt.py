"""Ctrl-C stops a run within a second, and other threads of Python run meanwhile."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

import toile
from conftest import PATTERN, QUICK

#: Runs a garment of a fine mesh, and says when it is at work and how it ended.
LONG_RUN = f"""
import time, toile
seen = []
def told(stage, panel, share, text):
    if stage == "StaticEquilibrium" and not seen:
        seen.append(stage)
        print("at work", flush=True)
try:
    toile.run({str(PATTERN)!r}, set={{"stages.GridMesher.edge": "5 mm"}}, cache=False, progress=told)
    print("done")
except KeyboardInterrupt:
    print("interrupted", flush=True)
    # The interpreter goes on: another run is done.
    run = toile.run({str(PATTERN)!r}, until="GridMesher", cache=False)
    print(len(run.artifacts["GridMesher"]) > 0)
"""


def test_ctrl_c_stops_a_run_within_a_second() -> None:
    program = subprocess.Popen([sys.executable, "-c", LONG_RUN], stdout=subprocess.PIPE, text=True)
    assert program.stdout is not None
    assert program.stdout.readline() == "at work\n"
    time.sleep(0.5)
    start = time.monotonic()
    program.send_signal(signal.SIGINT)
    assert program.stdout.readline() == "interrupted\n"
    took = time.monotonic() - start
    assert program.stdout.read() == "True\n"
    assert program.wait() == 0
    assert took < 1.0


def test_other_threads_run_meanwhile() -> None:
    ticks = 0
    done = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.01)

    clock = threading.Thread(target=tick)
    start = time.monotonic()
    clock.start()
    toile.run(PATTERN, set=QUICK, threads=1, cache=False)
    done.set()
    clock.join()
    # A thread that waits for the interpreter would tick once or twice.
    assert ticks > 20 * (time.monotonic() - start)


@pytest.mark.slow
def test_ten_garments_in_a_pool_take_about_half_the_time() -> None:
    if (os.cpu_count() or 1) < 2 or os.getloadavg()[0] > 0.8:
        pytest.skip("it needs two idle cores")
    edges = [f"{edge} mm" for edge in range(25, 35)]

    def garment(edge: str) -> str:
        return toile.run(PATTERN, set={"stages.GridMesher.edge": edge}, threads=1, cache=False).garment.digest

    start = time.monotonic()
    one_after_the_other = [garment(edge) for edge in edges]
    middle = time.monotonic()
    with ThreadPoolExecutor(2) as pool:
        at_once = list(pool.map(garment, edges))
    end = time.monotonic()
    assert at_once == one_after_the_other
    assert end - middle <= 0.55 * (middle - start)
