# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A row of the matrix: files, and what reading them must give.

A row has one or several outcomes. Several are for what a format leaves open: each of them is right.
"""
import os
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

ANY = "|"  # of warnings: there may be some
BROKEN_WORDS = re.compile("truncated|damaged", re.IGNORECASE)


@dataclass(frozen=True)
class Link:
    """A symbolic link."""
    target: str


class Fifo:
    """What waits for ever if it is opened."""


class Folder:
    """An empty folder."""


@dataclass(frozen=True)
class Files:
    """The content of a folder. main: the file to read; header: how many of its first bytes are no voxels."""
    main: str
    parts: dict
    header: int = 0

    def data(self, name=None):
        return self.parts[name or self.main]

    def with_data(self, data, name=None):
        return replace(self, parts={**self.parts, name or self.main: data})

    def replaced(self, old, new, name=None):
        data = self.data(name)
        assert data.count(old) == 1, (old, data[:2000])
        return self.with_data(data.replace(old, new), name)

    def beside(self, parts):
        return replace(self, parts={**self.parts, **parts})

    def renamed(self, main):
        """The same main file under another name."""
        parts = dict(self.parts)
        parts[main] = parts.pop(self.main)
        return replace(self, main=main, parts=parts)

    def write(self, folder):
        for name, part in self.parts.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(part, Link):
                path.symlink_to(part.target)
            elif isinstance(part, Fifo):
                os.mkfifo(path)
            elif isinstance(part, Folder):
                path.mkdir()
            else:
                path.write_bytes(part)
        return Path(folder) / self.main


@dataclass(frozen=True)
class Image:
    """What a file holds.

    voxels: [k, j, i], or [n, k, j, i] with several frames.
    affine: 3 x 4, in LPS and mm: the voxel (i, j, k) lies at affine @ (i, j, k, 1).
    any_integer: the voxels may have another type of integers.
    warns: a pattern that a warning has; empty: there is no warning.
    """
    voxels: np.ndarray
    affine: np.ndarray
    times: tuple = ()
    any_integer: bool = False
    warns: str = ""

    name = "equal"

    def differs(self, result):
        """What of the result is not so; None if all is."""
        if result.message:
            return "refused: " + result.message
        shape = self.voxels.shape if self.voxels.ndim == 4 else (1, *self.voxels.shape)
        if result.shape != shape:
            return "frames and sizes %s, not %s" % (result.shape, shape)
        voxels = result.voxels
        same_type = voxels.dtype == self.voxels.dtype.newbyteorder("=")
        if not (voxels.dtype.kind in "iu" if self.any_integer else same_type):
            return "voxels of type %s, not %s" % (voxels.dtype, self.voxels.dtype)
        different = np.argwhere(voxels != self.voxels.reshape(shape))
        if len(different):
            at = tuple(different[0])
            return "%d of %d voxels differ: %s, not %s, at [n, k, j, i] = %s" % (
                len(different), voxels.size, voxels[at], self.voxels.reshape(shape)[at], [int(n) for n in at])
        if np.any(np.abs(result.affine - self.affine) > 1e-6 * (np.abs(self.affine).max() + 1e-12)):
            return "affine %s, not %s" % (_numbers(result.affine), _numbers(self.affine))
        if self.voxels.ndim == 4 and not np.allclose(result.times, self.times, rtol=1e-6, atol=1e-9):
            return "times %s, not %s" % (result.times, self.times)
        return self._differs_in_warnings("\n".join(result.warnings))

    def _differs_in_warnings(self, text):
        if not self.warns and text:
            return "warns: " + text
        if not re.search(self.warns, text, re.IGNORECASE | re.DOTALL):
            return "no warning with '%s': '%s'" % (self.warns, text)
        return None


@dataclass(frozen=True)
class Refusal:
    """An error that names the file.

    words: a pattern that it has.
    broken: bytes are missing or broken; only then may the message say 'truncated' or 'damaged'.
    """
    words: str
    broken: bool = False

    name = "refused"

    def differs(self, result):
        if not result.message:
            return "read as %s of %s" % (" x ".join(map(str, result.shape)), result.type)
        if not any(name in result.message for name in result.names):
            return "the message names no file: " + result.message
        if not re.search(self.words, _without_path(result.message), re.IGNORECASE):
            return "refused without '%s': %s" % (self.words, result.message)
        if not self.broken and BROKEN_WORDS.search(result.message):
            return "refused as broken: " + result.message
        return None


def refused(words, broken=False):
    return Refusal(words, broken)


def broken(words="."):
    return Refusal(words, True)


@dataclass(frozen=True)
class Row:
    format: str
    name: str
    files: Files
    outcomes: tuple

    def judge(self, result):
        """('equal' or 'refused', None), or (None, what came out)."""
        if result.fault:
            return None, result.fault
        different = []
        for outcome in self.outcomes:
            difference = outcome.differs(result)
            if difference is None:
                return outcome.name, None
            different.append(difference)
        return None, different[0]


def row(format_name, name, files, *outcomes):
    assert outcomes, name
    return Row(format_name, name, files, outcomes)


def named(equal, names, beside=("i.img", "i.hdr", "visu_pars")):
    """Rows of a file under other names, and with FIFOs beside it. equal makes a row, and wrap changes its files."""
    for name in names:
        equal("named %s" % name, wrap=lambda f, name=name: f.renamed(name))
    for name in beside:
        equal("a FIFO named %s beside it" % name, wrap=lambda f, name=name: f.beside({name: Fifo()}))


def data_files(equal, refuse, key, name, header, numbers, more=()):
    """Rows of headers that name a data file. key: what is before its name; numbers: its bytes; more: names to refuse."""
    words = re.escape(name)
    for title, data in (("absolute", "/etc/passwd"), ("in the folder above", "../out.bin"),
                        ("by way of the folder above", "d/../../out.bin"), ("a device", "/dev/zero"), *more, ("empty", "")):
        refuse("data file %s" % title, "data ?file|name|" + (data or "data file"), file="in/" + header, data=name,
               wrap=lambda f, data=data: f.replaced((key + name).encode(), (key + data).encode()).beside({"out.bin": numbers}))
    for title, part in (("is a FIFO", Fifo()), ("is a folder", Folder()), ("is a link to itself", Link(name)),
                        ("is a link to a device", Link("/dev/zero"))):
        refuse("data file %s" % title, words, file=header, data=name, wrap=lambda f, part=part: f.with_data(part, name))
    refuse("data file is missing", words, file=header, data=name, is_broken=True,
           wrap=lambda f: Files(f.main, {f.main: f.data()}))
    refuse("data file is a link that leads out", words, file="in/" + header, data=name,
           wrap=lambda f: f.with_data(Link("../out.bin"), "in/" + name).beside({"out.bin": numbers}))
    refuse("data file in a folder that leads out", words, file="in/" + header, data="d/" + name,
           wrap=lambda f: Files(f.main, {f.main: f.data(), "in/d": Link("../out"), "out/" + name: numbers}))
    equal("data file is a link within", file=header, data=name,
          wrap=lambda f: f.with_data(Link("voxels.bin"), name).beside({"voxels.bin": numbers}))


@dataclass(frozen=True)
class Sound:
    """A file with more bytes of voxels than of header, to be damaged.

    encoding: raw, gzip, zlib, text or xml; part: which of the files has the voxels, by default the main one.
    """
    format: str
    encoding: str
    files: Files
    image: Image
    part: str = ""

    @property
    def name(self):
        return "%s %s" % (self.encoding, self.part or self.files.main)


def write_some(folder, pattern, named_files):
    """Writes the files whose name has the pattern, each into a folder of its own, to be looked at."""
    for number, (name, files) in enumerate(named_files):
        if re.search(pattern, name):
            print(files.write(Path(folder) / ("%04d" % number)), name)


def _without_path(message):
    """The message without the name of the image, whose extension may be one of the words."""
    return re.sub("cannot read '[^']*'", "", message)


def _numbers(affine):
    return np.array2string(np.asarray(affine).ravel(), precision=6, suppress_small=True, max_line_width=1000)
