#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module in the process of the application: this test is the application.

It loads the library as Slicer does, hands over the address of a ModuleProcessInformation, and looks at what arrives
there; from the callback it asks for an end.
"""
import ctypes
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import images
import meshfiles
from module import LIBRARY, ModuleTestCase, parse_parameter_file

CALLBACK = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


class ModuleProcessInformation(ctypes.Structure):
    """The layout of the Slicer Execution Model, written down once more: C's own alignment."""
    _fields_ = [("Abort", ctypes.c_ubyte), ("Progress", ctypes.c_float), ("StageProgress", ctypes.c_float),
                ("ProgressMessage", ctypes.c_char * 1024), ("ProgressCallbackFunction", CALLBACK),
                ("ProgressCallbackClientData", ctypes.c_void_p), ("ElapsedTime", ctypes.c_double)]


class Host:
    """Keeps what the module told, and may react to it."""

    def __init__(self, react=None, client_data=4711):
        self.information = ModuleProcessInformation()
        # What was there before must not be taken for news.
        self.information.Progress = self.information.StageProgress = -1.0
        self.information.ProgressCallbackFunction = CALLBACK(self.on_progress)
        self.information.ProgressCallbackClientData = client_data
        self.react = react
        self.told = []  # (message, progress, progress of the stage, elapsed time)
        self.threads = set()
        self.client_data = set()

    def on_progress(self, client_data):
        i = self.information
        self.told.append((i.ProgressMessage.decode(), i.Progress, i.StageProgress, i.ElapsedTime))
        self.threads.add(threading.get_ident())
        self.client_data.add(client_data)
        if self.react:
            self.react(self)

    def abort(self):
        self.information.Abort = 1

    def address(self):
        return "0x%x" % ctypes.addressof(self.information)


class Library(ModuleTestCase):
    @classmethod
    def setUpClass(cls):
        cls.loaded = ctypes.CDLL(LIBRARY)
        cls.loaded.ModuleEntryPoint.argtypes = [ctypes.c_int, ctypes.POINTER(ctypes.c_char_p)]

    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())

    def enter(self, *arguments):
        """Calls the entry point. @return its status, and what it printed on both streams"""
        words = [b"SegmentationToTetMesh", *(str(argument).encode() for argument in arguments)]
        argv = (ctypes.c_char_p * (len(words) + 1))(*words, None)
        sys.stdout.flush()
        sys.stderr.flush()
        texts = []
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            kept = os.dup(1), os.dup(2)
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            try:
                status = self.loaded.ModuleEntryPoint(len(words), argv)
                ctypes.CDLL(None).fflush(None)
            finally:
                for original, descriptor in zip(kept, (1, 2)):
                    os.dup2(original, descriptor)
                    os.close(original)
            for file in (out, err):
                file.seek(0)
                texts.append(file.read().decode())
        return (status, *texts)

    def run_with(self, host, *arguments, mesh="mesh.vtu"):
        return self.enter("--processinformationaddress", host.address(), *arguments, self.input, self.folder / mesh)

    def test_layout(self):
        offsets = [getattr(ModuleProcessInformation, name).offset for name, _ in ModuleProcessInformation._fields_]
        self.assertEqual(offsets, [0, 4, 8, 12, 1040, 1048, 1056])
        self.assertEqual(ctypes.sizeof(ModuleProcessInformation), 1064)

    def test_only_the_interface_is_exported(self):
        """Nothing else, so that no other module's functions of the same name are taken for ours."""
        lines = subprocess.run(["nm", "--dynamic", "--defined-only", LIBRARY], capture_output=True, text=True,
                               check=True).stdout.splitlines()
        strong = {line.split()[2] for line in lines if line.split()[1] in "TDBR"}
        self.assertEqual(strong, {"ModuleEntryPoint", "GetXMLModuleDescription", "GetModuleLogo", "XMLModuleDescription"})

    def test_progress(self):
        host = Host()
        status, out, err = self.run_with(host, "--delta", 0.7, "--surfaces", self.folder / "s.vtp",
                                         "--returnparameterfile", self.folder / "r.params")
        self.assertEqual((status, err), (0, ""))
        self.assertNotIn("<filter", out)
        messages = [message for message, *_ in host.told]
        self.assertEqual(list(dict.fromkeys(messages)), ["Reading the label map", "Meshing", "Writing the mesh"])
        progress = [told[1] for told in host.told]
        self.assertEqual((progress[0], progress[-1]), (0.0, 1.0))
        self.assertEqual(progress, sorted(progress))
        self.assertGreater(len({told[2] for told in host.told if told[0] == "Meshing"}), 3)
        for message in set(messages):
            stage = [told[2] for told in host.told if told[0] == message]
            self.assertEqual((stage[0], stage[-1], stage), (0.0, 1.0, sorted(stage)))
        elapsed = [told[3] for told in host.told]
        self.assertEqual(elapsed, sorted(elapsed))
        self.assertGreater(elapsed[-1], 0.0)
        self.assertEqual(host.threads, {threading.get_ident()})  # the application's own
        self.assertEqual(host.client_data, {4711})
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        self.assertEqual(parse_parameter_file(self.folder / "r.params")["numberOfTetrahedra"], str(len(mesh.cells)))
        self.assertEqual(set(mesh.labels), {3, 7})

    def test_no_callback(self):
        """Without client data, too, Slicer's modules do not call back; the structure is filled all the same."""
        for change in (lambda i: setattr(i, "ProgressCallbackClientData", None),
                       lambda i: setattr(i, "ProgressCallbackFunction", CALLBACK())):
            host = Host()
            change(host.information)
            self.assertEqual(self.run_with(host)[0], 0)
            self.assertEqual(host.told, [])
            self.assertEqual((host.information.Progress, host.information.ProgressMessage), (1.0, b"Writing the mesh"))

    def assert_aborted(self, host, *arguments):
        before = self.contents()
        status, out, err = self.run_with(host, "--surfaces", self.folder / "s.vtp",
                                         "--returnparameterfile", self.folder / "r.params", *arguments)
        # Another status would be an error to Slicer, which it shows although the user has cancelled.
        self.assertEqual((status, out, err), (0, "SegmentationToTetMesh: cancelled, no file was written\n", ""))
        self.assertEqual(self.contents(), before)

    def test_abort_before_the_start(self):
        host = Host()
        host.abort()
        self.assert_aborted(host)
        self.assertEqual({told[1:3] for told in host.told}, {(0.0, 0.0)})

    def test_abort_while_meshing(self):
        images.write_nrrd(self.input, images.ball(64, 28.0))

        def react(host):
            message, _, stage, elapsed = host.told[-1]
            if message == "Meshing" and elapsed > 1.0:
                host.abort()
        host = Host(react)
        start = time.monotonic()
        self.assert_aborted(host, "--delta", 0.05, "--force")  # hours of work
        self.assertLess(time.monotonic() - start, 60.0)
        self.assertEqual(host.told[-1][0], "Meshing")

    def test_abort_from_another_thread(self):
        images.write_nrrd(self.input, images.ball(64, 28.0))
        host = Host()
        timer = threading.Timer(1.5, host.abort)
        timer.start()
        self.assert_aborted(host, "--delta", 0.05, "--force")
        timer.join()
        self.assertEqual(host.told[-1][:3], ("Meshing", 0.0, 0.0))

    def test_abort_when_all_is_written(self):
        """At the last moment, when the files are complete but not in their places."""
        host = Host(lambda h: h.abort() if h.told[-1][1] == 1.0 else None)
        self.assert_aborted(host)
        self.assertEqual(host.told[-1][:2], ("Writing the mesh", 1.0))

    def test_abort_after_reading(self):
        host = Host(lambda h: h.abort() if h.told[-1][0] == "Reading the label map" and h.told[-1][2] == 1.0 else None)
        self.assert_aborted(host)
        self.assertEqual({told[0] for told in host.told}, {"Reading the label map"})

    def test_several_runs(self):
        """A run leaves nothing behind for the next one, even if it failed or was stopped."""
        host = Host()
        host.abort()
        self.assert_aborted(host)
        self.assertEqual(self.enter("--delta", "x", self.input, self.folder / "mesh.vtu")[0], 2)
        sizes = []
        for _ in range(2):
            self.assertEqual(self.run_with(Host(), "--threads", 1)[0], 0)
            sizes.append((self.folder / "mesh.vtu").stat().st_size)
            (self.folder / "mesh.vtu").unlink()
        self.assertEqual(sizes[0], sizes[1])

    def test_errors(self):
        for status, pattern, arguments in (
                (2, "^SegmentationToTetMesh: the input is missing", ()),
                (1, "^SegmentationToTetMesh: cannot read '.*': there is no such file", ("no.nrrd", "mesh.vtu")),
                (1, "^SegmentationToTetMesh: cannot mesh '.*': Label 5 was asked for",
                 ("--labels", 5, self.input, self.folder / "mesh.vtu"))):
            before = self.contents()
            done = self.enter(*arguments)
            self.assertEqual(done[0], status)
            self.assertRegex(done[2], pattern)
            self.assertLessEqual(len(done[2].strip().split("\n")), 2)
            self.assertEqual(self.contents(), before)

    def test_description(self):
        status, out, err = self.enter("--xml")
        self.assertEqual((status, err), (0, ""))
        self.assertTrue(out.startswith("<?xml"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
