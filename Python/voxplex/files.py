# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files through which images and meshes go to the program and back, and options that name them."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import subprocess
import tempfile
from typing import Any, Iterator, List, Sequence, Tuple, Union

from .errors import FileError

Path = Union[str, "os.PathLike[str]"]

_IS_FULL = re.compile(r"(/voxplex-\w{8}/|cannot write the (image|mesh):).*(No space left|quota exceeded)", re.DOTALL)


def input_options(paths: Union[Path, Sequence[Path]]) -> List[str]:
    """The options for an image, or for masks."""
    files = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    if not files:
        raise ValueError("the list of files is empty")
    return ["--input=" + existing(file) for file in files]


def existing(path: Path) -> str:
    """Raises FileNotFoundError where there is nothing."""
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fsdecode(path))
    return os.fsdecode(path)


def number_text(value: Any) -> str:
    """As an option and a message have it."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def number_list(option: str, values: Any) -> List[str]:
    """The option with its numbers; nothing if there are none."""
    text = ",".join(map(number_text, values))
    return [f"--{option}={text}"] if text else []


@contextlib.contextmanager
def temporary_folder() -> Iterator[str]:
    """For files that only pass data. Raises FileError if there is no room for them."""
    try:
        place = tempfile.gettempdir()
    except FileNotFoundError as error:
        raise FileError(f"{error.strerror}; name one with the environment variable TMPDIR") from None
    try:
        with tempfile.TemporaryDirectory(prefix="voxplex-") as folder, _removal(folder):
            yield folder
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT) or isinstance(error, FileError) and _IS_FULL.search(str(error)):
            raise FileError(f"the temporary folder {place} is full, which the image and the mesh pass through; choose "
                            "another one with the environment variable TMPDIR") from error
        raise


@contextlib.contextmanager
def _removal(folder: str) -> Iterator[None]:
    """If the interpreter is killed, nobody else removes the folder: a shell does that waits for the end of its input."""
    with contextlib.ExitStack() as stack:
        try:
            shell = stack.enter_context(subprocess.Popen(["/bin/sh", "-c", 'read -r _; rm -rf -- "$1"', "sh", folder],
                                                         stdin=subprocess.PIPE, start_new_session=True))
            stack.callback(shell.kill)
        except OSError:  # the program does not start either, and says so
            pass
        yield


def in_words(folder: str) -> List[Tuple[str, str]]:
    """What messages call the files of images and meshes that are in memory."""
    names = (("image.nrrd", "the image"), ("sizes.nrrd", "the image of sizes"), ("mesh.vtu", "the mesh"))
    return [(quote + os.path.join(folder, file) + quote, name) for file, name in names for quote in ("'", "")]
