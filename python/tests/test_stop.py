"""Stopping and looking on."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import hexfill

#: Takes minutes, has a mesh at once.
LONG = {"surface": ":octagonal-spindle", "best_of": 10_000}


def interrupt(after: float, times: int = 1) -> list[float]:
    """Ctrl-C in so many seconds; the list holds when it came."""
    sent: list[float] = []

    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    for i in range(times):
        timer = threading.Timer(after + 0.01 * i, send)
        timer.daemon = True
        timer.start()
    return sent


def test_ctrl_c_brings_the_best_so_far():
    sent = interrupt(0.5)
    with pytest.raises(hexfill.Cancelled) as caught:
        hexfill.fill(**LONG)
    assert time.monotonic() - sent[0] < 2
    mesh = caught.value.mesh
    assert mesh.report["stopped"] == "cancelled" and hexfill.check(mesh, surface=":octagonal-spindle").levels["L2"] == "passed"
    assert isinstance(caught.value, KeyboardInterrupt) and not isinstance(caught.value, Exception)


def test_ctrl_c_without_a_result():
    sent = interrupt(0.5)
    with pytest.raises(hexfill.Cancelled) as caught:
        hexfill.enumerate(10, list=False)
    assert caught.value.mesh is None and time.monotonic() - sent[0] < 2


def test_ctrl_c_twice_leaves_at_once():
    program = """
        import os, signal, threading, hexfill
        for after in (0.5, 0.51, 0.52):
            threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        try:
            hexfill.fill(":octagonal-spindle", best_of=10_000)
        except KeyboardInterrupt:
            pass
        try:
            while len(threading.enumerate()) > 1: pass
        except KeyboardInterrupt:
            pass
        print(hexfill.fill(":cube").n_hexes)
    """
    run = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=60)
    assert run.stdout.strip() == "1" and run.returncode in (0, -signal.SIGINT), run.stderr


def test_other_signals_and_their_exceptions():
    def handler(*_):
        raise TimeoutError("alarm")

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(TimeoutError, match="alarm"):
            hexfill.fill(**LONG)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_a_time_limit_brings_the_best_so_far():
    start = time.monotonic()
    mesh = hexfill.fill(**LONG, time_limit=1)
    assert time.monotonic() - start < 4 and mesh.report["stopped"] == "time-limit"


def test_progress_is_told_on_the_calling_thread():
    news, threads = [], set()

    def listen(p):
        news.append(p)
        threads.add(threading.get_ident())

    hexfill.fill(**LONG, time_limit=1, progress=listen)
    assert news and threads == {threading.get_ident()}
    assert {"stage", "done", "total", "message"} == set(news[0]) and isinstance(news[0]["stage"], str)


def test_false_stops_and_keeps_the_best():
    start = time.monotonic()
    mesh = hexfill.fill(**LONG, progress=lambda p: False)
    assert mesh.report["stopped"] == "cancelled" and time.monotonic() - start < 10


def test_what_the_callback_raises_goes_on():
    def broken(p):
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        hexfill.fill(**LONG, progress=broken)


def test_progress_for_people(capfd, monkeypatch):
    hexfill.fill(**LONG, time_limit=1, progress=True)
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(hexfill.running._Lines, "EVERY", 0.0)
    capfd.readouterr()
    hexfill.fill(**LONG, time_limit=1, progress=True)
    assert "hexfill: " in capfd.readouterr().err


def test_python_goes_on_meanwhile():
    """The lock is released: another thread counts while the work is done."""
    count, done = 0, threading.Event()

    def work():
        try:
            hexfill.fill(**LONG, time_limit=1)
        finally:
            done.set()

    threading.Thread(target=work).start()
    while not done.wait(0.005):
        count += 1
    assert count > 50


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_forked_processes_work_on(bar):
    hexfill.fill(*bar)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        meshes = pool.starmap_async(hexfill.fill, [bar] * 4).get(timeout=60)
    assert [m.n_hexes for m in meshes] == [12] * 4
