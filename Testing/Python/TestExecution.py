#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Progress, cancelling, Ctrl-C and other threads of Python."""

import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
import unittest.mock
from pathlib import Path

import numpy

import voxplex
from phantoms import ball

# Meshing these takes many seconds, so that what stops it comes in time on any machine.
LARGE = dict(image=ball(64, (30.0, 12.0)), delta=0.3)


def number_of_tetrahedra(delta):
    """For other processes, which import this module."""
    return len(voxplex.mesh(ball(), delta, threads=1).cells)


def children(process="self"):
    """The processes that this one, or another one, has started, beside the shell that waits to remove files."""
    started = [int(pid) for task in os.listdir(f"/proc/{process}/task")
               for pid in Path(f"/proc/{process}/task/{task}/children").read_text(encoding="ascii").split()]
    return [pid for pid in started if Path(f"/proc/{pid}/comm").read_text(encoding="utf-8") != "sh\n"]


def is_running(process):
    """A process that nobody has waited for has a state."""
    try:
        return Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def interrupt():
    os.kill(os.getpid(), signal.SIGINT)


class Progress(unittest.TestCase):
    def test_fractions(self):
        fractions = []
        threads = set()

        def progress(fraction):
            fractions.append(fraction)
            threads.add(threading.current_thread())

        voxplex.mesh(ball(32, (14.0,)), 0.8, progress=progress)
        self.assertGreater(len(fractions), 2)
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1.0)
        self.assertEqual(threads, {threading.current_thread()})

    def test_cancel(self):
        calls = []

        def progress(fraction):
            calls.append(fraction)
            return False

        with self.assertRaises(voxplex.MeshingCancelled):
            voxplex.mesh(**LARGE, progress=progress)
        self.assertEqual(len(calls), 1)

    def test_what_is_false_cancels(self):
        """But None, which functions without a return statement return."""
        for value in (None, True, numpy.True_, 1, "more"):
            self.assertGreater(len(voxplex.mesh(ball(), 2.0, progress=lambda _: value).cells), 0)
        for value in (False, numpy.False_, 0, ""):
            with self.subTest(value), self.assertRaises(voxplex.MeshingCancelled):
                voxplex.mesh(ball(), 2.0, progress=lambda _: value)

    def test_exception(self):
        def progress(_fraction):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            voxplex.mesh(**LARGE, progress=progress)


class Interruption(unittest.TestCase):
    def setUp(self):
        """Jobs in the background ignore Ctrl-C."""
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)

    def test_ctrl_c(self):
        before = signal.getsignal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            voxplex.mesh(**LARGE, progress=lambda _: interrupt())
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertGreater(len(voxplex.mesh(ball(), 2.0).cells), 0)

    def test_without_callback(self):
        timer = threading.Timer(0.5, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            voxplex.mesh(**LARGE)
        timer.join()

    def test_handler_of_the_program(self):
        """It decides: meshing goes on if it raises nothing."""
        calls = []
        before = signal.signal(signal.SIGINT, lambda number, frame: calls.append(number))
        try:
            mesh = voxplex.mesh(ball(), 2.0, progress=lambda _: interrupt())
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertEqual(set(calls), {signal.SIGINT})
        self.assertGreater(len(mesh.cells), 0)

    def test_program_ends(self):
        """Whatever ends the call ends the program; its files go with it."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        started = []

        def progress(_fraction):
            started.extend(children())
            raise ZeroDivisionError

        with unittest.mock.patch.dict(os.environ, TMPDIR=folder.name), unittest.mock.patch("tempfile.tempdir", None):
            with self.assertRaises(ZeroDivisionError):
                voxplex.mesh(**LARGE, progress=progress)
        self.assertEqual(len(started), 1)
        self.assertEqual((children(), os.listdir(folder.name)), ([], []))

    def test_interpreter_is_killed(self):
        """The program ends with it, though it would take minutes, and its folder is removed."""
        here = os.path.dirname(os.path.abspath(__file__))
        script = ("import sys; sys.path.insert(0, %r)\n"
                  "import voxplex; from phantoms import ball\n"
                  "voxplex.mesh(ball(64, (30.0, 12.0)), 0.04, force=True, progress=lambda _: print('started', flush=True))" % here)
        for number in (signal.SIGKILL, signal.SIGTERM):
            with tempfile.TemporaryDirectory() as folder:
                with subprocess.Popen([sys.executable, "-c", script], text=True, stdout=subprocess.PIPE,
                                      env={**os.environ, "TMPDIR": folder}) as process:
                    self.assertEqual(process.stdout.readline(), "started\n")
                    (program,) = children(process.pid)
                    process.send_signal(number)
                for _ in range(200):
                    if not is_running(program) and not os.listdir(folder):
                        break
                    time.sleep(0.1)
                self.assertFalse(is_running(program))
                self.assertEqual(os.listdir(folder), [])

    def test_killed(self):
        """As by a kernel that has no memory left."""
        def progress(_fraction):
            for child in children():
                os.kill(child, signal.SIGKILL)

        with self.assertRaisesRegex(voxplex.MeshingError, "was ended by signal 9 .*memory ran out"):
            voxplex.mesh(**LARGE, progress=progress)

    def test_ignored(self):
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            mesh = voxplex.mesh(ball(), 2.0, progress=lambda _: interrupt())
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertGreater(len(mesh.cells), 0)

    def test_process(self):
        """Ctrl-C ends a script as it ends any other: by the signal, with a traceback and no word of VTK's."""
        script = textwrap.dedent("""
            import sys, voxplex
            from phantoms import ball
            seen = []
            def progress(fraction):
                if not seen:
                    seen.append(fraction)
                    print("started", flush=True)
            voxplex.mesh(ball(64, (30.0, 12.0)), 0.3, progress=progress)
            """)
        environment = dict(os.environ)
        here = os.path.dirname(os.path.abspath(__file__))
        environment["PYTHONPATH"] = os.pathsep.join([here, environment.get("PYTHONPATH", "")])
        with subprocess.Popen([sys.executable, "-c", script], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            self.assertEqual(process.stdout.readline(), "started\n")
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertNotIn("Caught a Ctrl-C", errors)


class PythonThreads(unittest.TestCase):
    def test_others_run_meanwhile(self):
        """The interpreter's lock is free while the program works."""
        wakings = []
        stop = threading.Event()

        def other():
            while not stop.is_set():
                wakings.append(0)
                stop.wait(0.001)

        thread = threading.Thread(target=other)
        during = []

        def progress(_fraction):
            during.append(len(wakings))
            return None if len(during) < 5 else False

        thread.start()
        try:
            with self.assertRaises(voxplex.MeshingCancelled):
                voxplex.mesh(**LARGE, progress=progress)
        finally:
            stop.set()
            thread.join()
        # It wants the lock every millisecond. If meshing kept it, it would get it once for each report.
        self.assertGreater(during[-1] - during[0], 2 * (len(during) - 1), during)

    def test_mesh_in_another_thread(self):
        results = []
        thread = threading.Thread(target=lambda: results.append(voxplex.mesh(ball(), 1.0)))
        thread.start()
        results.append(voxplex.mesh(ball(), 1.0))
        thread.join()
        self.assertTrue(all(len(mesh.cells) > 0 for mesh in results))
        self.assertEqual(len(results), 2)

    def test_other_processes(self):
        """Of multiprocessing, in the ways in which it makes them."""
        for method in ("fork", "spawn", "forkserver"):
            with self.subTest(method), multiprocessing.get_context(method).Pool(2) as pool:
                counts = pool.map(number_of_tetrahedra, (2.0, 2.0, 3.0))
                self.assertEqual(counts[0], counts[1])
                self.assertGreater(counts[0], counts[2])

    def test_cancelled_in_another_thread(self):
        failures = []

        def run():
            try:
                voxplex.mesh(**LARGE, progress=lambda _: False)
            except voxplex.MeshingCancelled as failure:
                failures.append(failure)

        thread = threading.Thread(target=run)
        thread.start()
        thread.join()
        self.assertEqual(len(failures), 1)


if __name__ == "__main__":
    unittest.main()
