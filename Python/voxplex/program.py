# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the command line program, which does the work, as Python functions run.

A process of its own meets no other VTK, needs nothing of Python's lock, and leaves Python alone if it ends badly. Errors
are raised, warnings issued; Ctrl-C and whatever a callback raises end the program.
"""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import warnings
from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple, Union

from . import installation
from .errors import ArgumentError, FileError, MeshingCancelled, MeshingError, MeshingWarning

_NAME = "voxplex: "  # before what is no message

Progress = Callable[[float], object]
"""Called with the fraction done, 0 to 1. False, or another value that is false except None, cancels."""


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
    messages: List[Dict[str, Any]] = []
    try:
        with process.stderr as stream:
            for line in stream:
                message = _message(os.fsdecode(line).rstrip("\n"))
                if message["kind"] != "progress":
                    messages.append(message)
                elif progress:
                    _report(progress, message["fraction"])
        process.wait()
        if progress and process.returncode == 0:
            _report(progress, 1.0)
    except BaseException:
        _end(process)
        raise
    for message in messages:
        for theirs, ours in words:
            message.update({key: message[key].replace(theirs, ours) for key in ("doing", "text")})
        if message["kind"] == "warning":
            _warn(message["text"])
    if process.returncode != 0:
        errors = [message for message in messages if message["kind"] != "warning"]
        raise _failure(process.returncode, errors, [ours for _, ours in words])


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


def _message(line: str) -> Dict[str, Any]:
    """Of the program; other lines are of the loader of libraries, or say how the program ended."""
    try:
        message = json.loads(line)
    except ValueError:
        message = None
    return message if isinstance(message, dict) else {"kind": "other", "doing": "", "text": line}


def _failure(status: int, messages: List[Dict[str, Any]], in_memory: List[str]) -> Exception:
    text = "\n".join(message["text"] for message in messages)
    text = text[len(_NAME):] if text.startswith(_NAME) else text
    if status == 2:
        return ArgumentError(text)
    if status > 128:
        return MeshingCancelled(text)
    if status < 0:
        end = f"the program was ended by signal {-status} ({signal.strsignal(-status)})"
        if -status == signal.SIGKILL:
            end += ", most likely because memory ran out: take larger elements, or a smaller image"
        return MeshingError(end + (": " + text if text else ""))
    if status in (1, 127) and messages and all(message["kind"] == "other" for message in messages):
        return RuntimeError(no_start(text))
    if status == 3:
        reading = [f"cannot read {name}: " for name in in_memory]
        found = next((start for start in reading if text.startswith(start)), None)
        return FileError(text) if found is None else MeshingError(text[len(found):])
    return MeshingError(text if status == 1 else f"the program ended with status {status}: {text}")


def _warn(text: str) -> None:
    """As of the caller's line, however deep this is called."""
    folder = os.path.dirname(os.path.abspath(__file__))
    depth = 1
    frame: Any = sys._getframe()
    while frame is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == folder:
        frame = frame.f_back
        depth += 1
    warnings.warn(text, MeshingWarning, stacklevel=depth)
