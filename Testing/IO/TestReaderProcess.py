#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What libraries read is read by a process of its own, and by nothing else; all else in the host."""
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import images
import voxplex
from iotesting import FolderTestCase
from matrix import SOUND

READER = Path(voxplex.__file__).parents[4] / "lib" / "voxplex" / "voxplexImageReader"
ARRAY = images.two_labels(12, 4.0)
GEOMETRY = images.Geometry((1.5, -2.25, 3.125), (1.5, 0.75, 0.125))


def voxels(image):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(ARRAY.shape)


def status_of(process):
    """What Linux says of it; nothing if there is none."""
    try:
        return Path("/proc/%s/status" % process).read_text()
    except (FileNotFoundError, ProcessLookupError):
        return ""


def write_vti(path):
    image = vtkImageData()
    image.SetDimensions(ARRAY.shape[::-1])
    image.SetOrigin(GEOMETRY.origin)
    image.SetSpacing(GEOMETRY.spacing)
    image.GetPointData().SetScalars(numpy_to_vtk(ARRAY.ravel(), deep=True))
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    assert writer.Write()
    return str(path)


class ReadingProcess(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.path = write_vti(self.folder / "i.vti")

    def python(self, code, *arguments, **options):
        """Runs code in an interpreter of its own."""
        return subprocess.run([sys.executable, "-c", code, *arguments], cwd=self.folder, text=True, capture_output=True, timeout=120,
                              stdin=subprocess.DEVNULL, **options)

    @unittest.skipUnless(READER.exists(), "the tests do not run in a build tree")
    def test_greeting_and_answer(self):
        memory = os.memfd_create("voxels")
        if memory != 3:
            os.dup2(memory, 3)
        done = subprocess.run([READER, self.path, "", "0", "0.5"], capture_output=True, pass_fds=(3,), timeout=60)
        greeting, answer = done.stdout.decode().split("\n", 1)
        self.assertEqual(greeting, "voxplex image reader 5")
        self.assertIn('"spacing":[1.5,0.75,0.125]', answer)
        self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_processes_end(self):
        """None is left, whatever came of it; the host's own are not touched."""
        own = subprocess.Popen(["sleep", "60"])
        (self.folder / "damaged.vti").write_bytes(Path(self.path).read_bytes()[:-10])
        for path in (self.path, self.folder / "damaged.vti", self.folder / "none.vti"):
            self.reader(path)
        self.assertIsNone(own.poll())
        own.kill()
        own.wait()
        with self.assertRaises(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)

    def test_process_ends_with_its_host(self):
        """Also if it hangs: here it is stopped, as soon as it is confined."""
        code = ("import sys, voxplex; reader = voxplex.vtkSegmentationReader(); reader.SetFileName(sys.argv[1])\n"
                "while True: reader.Modified(); reader.Update()")
        host = subprocess.Popen([sys.executable, "-c", code, self.path])
        child, end = None, time.monotonic() + 60
        while child is None and host.poll() is None and time.monotonic() < end:
            for one in Path("/proc/%d/task/%d/children" % (host.pid, host.pid)).read_text().split():
                if "\nNoNewPrivs:\t1\n" in status_of(one):
                    os.kill(int(one), signal.SIGSTOP)
                    child = one
        host.kill()
        host.wait()
        self.assertIsNotNone(child)
        while "State:" in status_of(child) and "\nState:\tZ" not in status_of(child) and time.monotonic() < end:
            time.sleep(0.01)
        left = status_of(child)
        if "\nState:\tT" in left:
            os.kill(int(child), signal.SIGKILL)
        self.assertNotIn("\nState:\tT", left)

    def test_progress_and_abort(self):
        """Wherever it is read: a process ends, and the output is empty until the reader is modified."""
        own = images.write_nrrd(self.folder / "i.nrrd", np.zeros((64, 512, 1024), np.uint8))
        for path, names in ((self.path, [self.path]), (own, [own]), ("", [own, own, own])):
            with self.subTest(path=path):
                reader = voxplex.vtkSegmentationReader()
                for name in names:
                    reader.AddFileName(name)
                told = []

                def stop(*_):
                    told.append(reader.GetProgress())
                    reader.SetAbortExecute(1)

                tag = reader.AddObserver("ProgressEvent", stop)
                reader.Update()
                self.assertTrue(reader.GetAborted())
                self.assertEqual((reader.GetErrorMessage(), reader.GetNumberOfFrames(), reader.GetOutput().GetNumberOfPoints()), ("", 0, 0))
                self.assertLessEqual(told[0], 0.5)
                with self.assertRaises(ChildProcessError):
                    os.waitpid(-1, os.WNOHANG)
                reader.RemoveObserver(tag)
                told.clear()
                reader.Modified()
                reader.AddObserver("ProgressEvent", lambda *_: told.append(reader.GetProgress()))
                reader.Update()
                self.assertFalse(reader.GetAborted())
                self.assertGreater(reader.GetOutput().GetNumberOfPoints(), 0)
                if path != self.path:
                    self.assertGreaterEqual(len(set(told)), 2, told)

    def test_host_that_ignores_its_children(self):
        before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
        try:
            np.testing.assert_array_equal(voxels(self.read(self.path)), ARRAY)
        finally:
            signal.signal(signal.SIGCHLD, before)

    def test_no_descriptors_for_a_process(self):
        used = {int(name) for name in os.listdir("/proc/self/fd")}
        free = [number for number in range(max(used) + 8) if number not in used]
        limits = resource.getrlimit(resource.RLIMIT_NOFILE)
        for count in (0, 1, 2, 3):
            with self.subTest(count):
                resource.setrlimit(resource.RLIMIT_NOFILE, (free[count], limits[1]))
                try:
                    self.refused("cannot read '.*i.vti': the program that reads images, '.*voxplexImageReader', "
                                 "cannot be started: Too many open files", self.path)
                finally:
                    resource.setrlimit(resource.RLIMIT_NOFILE, limits)

    def test_process_that_ends_before_its_greeting(self):
        """A hostile file could want that the host reads it instead. Formats that no library reads do not need it."""
        (self.folder / "libtiff.so.6").write_bytes(b"no library")
        before = os.environ.get("LD_LIBRARY_PATH")
        os.environ["LD_LIBRARY_PATH"] = str(self.folder)
        try:
            for number, sound in enumerate(SOUND):
                path = sound.files.write(self.folder / str(number))
                with self.subTest(path.name):
                    if sound.format in ("VTK legacy", "VTK XML"):
                        self.refused("cannot read '.*': the program that reads images, '.*voxplexImageReader', does not answer, "
                                     "and ended with status 127: .*install Voxplex again", path)
                    else:
                        self.assertEqual(self.reader(path).GetErrorMessage(), "")
        finally:
            os.environ.pop("LD_LIBRARY_PATH")
            if before is not None:
                os.environ["LD_LIBRARY_PATH"] = before

    def test_limit_on_the_size_of_files(self):
        """Voxels are in shared memory, which counts as a file. A limit that may be raised is no obstacle."""
        code = ("import sys, voxplex; reader = voxplex.vtkSegmentationReader(); reader.SetFileName(sys.argv[1]); reader.Update()\n"
                "print(reader.GetErrorMessage())")
        for hard, expected in ((resource.RLIM_INFINITY, ""), (512, "cannot read '.*i.vti': it does not fit into memory")):
            with self.subTest(hard):
                done = self.python(code, self.path, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (512, hard)))
                self.assertRegex(done.stdout, "^%s\n$" % expected)

    def test_voxels_can_be_written(self):
        """They are the host's own memory."""
        image = self.read(self.path)
        voxels(image)[:] = 5
        np.testing.assert_array_equal(voxels(self.read(self.path)), ARRAY)

    def test_descriptors_and_memory_are_given_back(self):
        def descriptors():
            return len(os.listdir("/proc/self/fd"))

        def mapped():
            return Path("/proc/self/maps").read_text().count("voxplex-voxels")

        self.read(self.path)
        before = descriptors(), mapped()
        for _ in range(10):
            self.read(self.path)
        self.assertEqual((descriptors(), mapped()), before)

    def test_decimal_comma(self):
        """As QApplication sets it for a German user."""
        if not shutil.which("localedef") or not Path("/usr/share/i18n/locales/de_DE").exists():
            self.skipTest("localedef and its sources are not installed (apt-get install locales)")
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", self.folder / "de_DE.UTF-8"], check=False, capture_output=True)
        code = ("import locale, voxplex; locale.setlocale(locale.LC_ALL, 'de_DE.UTF-8')\n"
                "assert locale.localeconv()['decimal_point'] == ','\n"
                "reader = voxplex.vtkSegmentationReader(); reader.SetFileName(%r); reader.Update()\n"
                "print(reader.GetOutput().GetSpacing(), reader.GetOutput().GetOrigin())\n")
        text = images.write_nrrd(self.folder / "text.nrrd", ARRAY.astype(np.float32) + 0.5, GEOMETRY,
                                 header_lines={"encoding": "ascii", "type": "float"})
        data = Path(text).read_bytes().split(b"\n\n")[0]
        Path(text).write_bytes(data + b"\n\n" + " ".join(map(str, ARRAY.ravel() + 0.5)).encode())
        meta = images.write_metaimage(self.folder / "i.mha", ARRAY, GEOMETRY)
        raw = images.write_nrrd(self.folder / "i.nrrd", ARRAY, GEOMETRY)
        for path in (self.path, raw, text, meta, images.write_nifti(self.folder / "i.nii", ARRAY, GEOMETRY)):
            with self.subTest(path=path):
                done = self.python(code % str(path), env={**os.environ, "LOCPATH": str(self.folder)})
                self.assertEqual(done.stderr, "")
                self.assertEqual(done.stdout, "%r %r\n" % (GEOMETRY.spacing, GEOMETRY.origin))

    def test_forks_of_the_host(self):
        """A child of the host's, as multiprocessing makes them, reads as well."""
        self.read(self.path)
        child = os.fork()
        if child == 0:
            os._exit(0 if (voxels(self.reader(self.path).GetOutput()) == ARRAY).all() else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)


if __name__ == "__main__":
    unittest.main()
