# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the command line program, which does the work, as Python functions run.

A process of its own meets no other VTK, needs nothing of Python's lock, and leaves Python alone if it ends badly. Errors
are raised, warnings issued; Ctrl-C and whatever a callback raises end the program.
"""

from __future__ import annotations

import errno
import os
import re
import signal
import subprocess
import sys
import warnings
from typing import Any, Callable, Iterable, List, Optional, Tuple, Union

from . import installation
from .errors import ArgumentError, FileError, MeshingCancelled, MeshingError, MeshingWarning

Progress = Callable[[float], object]
"""Called with the fraction done, 0 to 1. False, or another value that is false except None, cancels."""

_PROGRESS = re.compile(r"(\d+) %")
_WARNING = "voxplex: warning: "
_NAME = "voxplex: "
_DOING = re.compile(r"cannot (?:(?:mesh|measure|repair) '.*?'|(?:mesh|measure|read|repair) the (?:image|mesh)): ", re.DOTALL)


def path() -> str:
    """Of the program; CMake builds it where GDCM and Boost are found."""
    return os.path.normpath(installation.PROGRAM)


def no_start(why: Union[OSError, str]) -> str:
    """The message if the system, or its loader of libraries, does not start the program."""
    program = path()
    reason = f"{why}; "
    if not os.path.exists(program):
        reason = "it is not there; "
    elif isinstance(why, PermissionError):
        reason = "it may not be executed; take a disk that is not mounted with noexec, or "
    elif isinstance(why, OSError) and why.errno in (errno.ENOENT, errno.ENOEXEC) and why.filename in (None, program):
        reason = "it is made for another system or processor; "
    elif isinstance(why, OSError):
        return f"the program {program} cannot be started: {why}; limits (ulimit) may be too low"
    return f"the program {program} cannot be started: {reason}install Voxplex again, or build it on this system"


def run(arguments: List[str], progress: Optional[Progress] = None,
        words: Iterable[Tuple[str, str]] = ()) -> None:
    """Runs the program with these arguments.

    words: what messages are to say in place of texts of the program's, such as the names of files that only pass data.

    Raises MeshingError, ArgumentError or FileError with the program's message, MeshingCancelled, what the callback
    raises, and RuntimeError if the program cannot be started. Its warnings are issued as MeshingWarning, at the first
    caller outside of this package.
    """
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be a function, not {type(progress).__name__}")
    command = [path(), *arguments, "--messages=python", *(["--progress"] if progress else [])]
    try:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    except OSError as error:
        raise RuntimeError(no_start(error)) from None
    assert process.stderr is not None
    said: List[str] = []
    try:
        with process.stderr as stream:
            for line in stream:
                text = os.fsdecode(line).rstrip("\n")
                found = _PROGRESS.match(text) if progress else None
                if found and progress:
                    _report(progress, int(found[1]) / 100)
                else:
                    said.append(text)
        process.wait()
        if progress and process.returncode == 0:
            _report(progress, 1.0)
    except BaseException:
        _end(process)
        raise
    texts = _messages(said)
    for theirs, ours in words:
        texts = [text.replace(theirs, ours) for text in texts]
    for warning in texts:
        if warning.startswith(_WARNING):
            _warn(warning[len(_WARNING):])
    if process.returncode != 0:
        raise _failure(process.returncode, [text for text in texts if not text.startswith(_WARNING)])


def _end(process: subprocess.Popen[bytes]) -> None:
    """Gives it time to remove its temporary files."""
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _report(progress: Progress, fraction: float) -> None:
    answer = progress(fraction)
    if answer is not None and not answer:
        raise MeshingCancelled("it was cancelled")


def _messages(lines: List[str]) -> List[str]:
    """A message begins with the program's name, and may have several lines."""
    messages: List[str] = []
    for line in lines:
        if line.startswith(_NAME) or not messages:
            messages.append(line)
        else:
            messages[-1] += "\n" + line
    return messages


def _failure(status: int, messages: List[str]) -> Exception:
    texts = [text[len(_NAME):] if text.startswith(_NAME) else text for text in messages]
    text = "\n".join(texts)
    if status == 2:
        return ArgumentError(text)
    if status > 128:
        return MeshingCancelled(text)
    if status < 0:
        end = f"the program was ended by signal {-status} ({signal.strsignal(-status)})"
        if -status == signal.SIGKILL:
            end += ", most likely because memory ran out: take larger elements, or a smaller image"
        return MeshingError(end + (": " + text if text else ""))
    if status in (1, 127) and texts and texts == messages:  # it says nothing without its name
        return RuntimeError(no_start(text))
    if status != 1:
        return MeshingError(f"the program ended with status {status}: {text}")
    found = _DOING.match(text)
    if found or "out of memory" in text:
        return MeshingError(text[found.end():] if found else text)
    return FileError(text)


def _warn(text: str) -> None:
    """As of the caller's line, however deep this is called."""
    folder = os.path.dirname(os.path.abspath(__file__))
    depth = 1
    frame: Any = sys._getframe()
    while frame is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == folder:
        frame = frame.f_back
        depth += 1
    warnings.warn(text, MeshingWarning, stacklevel=depth)
