# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs VTK algorithms as Python functions run: errors are raised, warnings issued, Ctrl-C works.

**Ctrl-C.** VTK ends the whole process when KeyboardInterrupt is raised inside of an observer. For as
long as an algorithm executes in the main thread, SIGINT is therefore only noted, by a handler that
raises nothing; the algorithm is stopped, and the handler that was there before is called when it has
returned. A program without a handler (SIG_IGN, SIG_DFL) keeps its ways.

**The global interpreter lock.** VTK 9.1 keeps it while a method runs, and meshing needs none of it:
it has threads of its own. Between progress events, which come fifty times a second, the thread that
waits for the mesh sleeps if the program has other Python threads, which so get the lock.
"""

from __future__ import annotations

import re
import signal
import threading
import time
from types import FrameType
from typing import Any, Callable, List, Optional, Tuple

from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_DOUBLE, VTK_STRING
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from .errors import MeshingCancelled, MeshingError

Progress = Callable[[float], object]
"""Called with the fraction done, 0 to 1. False, or another value that is false except None, cancels."""

# Between two progress events, in seconds.
_PAUSE = 0.02

# "ERROR: In FILE, line N" and "CLASS (ADDRESS): " before the message itself.
_PREAMBLE = re.compile(r"\A(?:\w+: In .*, line \d+\n)?\s*\w+ \((?:0x)?[0-9a-fA-F]+\): ")


class Execution:
    """One execution of an algorithm.

    errors, warnings: what the algorithms that were watched reported, without VTK's preamble.
    cancelled: whether the progress callback asked for it.
    """

    def __init__(self, algorithm: vtkAlgorithm, progress: Optional[Progress] = None) -> None:
        self.algorithm = algorithm
        self.errors: List[str] = []
        self.warnings: List[str] = []
        self.cancelled = False
        self._progress = progress
        self._failure: Optional[BaseException] = None
        self._interruption: Optional[Tuple[int, Optional[FrameType]]] = None
        self._observers: List[Tuple[Any, int]] = []
        self.watch(algorithm)
        self._observe(algorithm, "ProgressEvent", VTK_DOUBLE, self._on_progress)

    def watch(self, algorithm: vtkAlgorithm) -> None:
        """Collects the errors and warnings of an algorithm, here or upstream, instead of printing them."""
        self._observe(algorithm, "ErrorEvent", VTK_STRING, self.errors.append, _without_preamble)
        self._observe(algorithm, "WarningEvent", VTK_STRING, self.warnings.append, _without_preamble)
        # The executive only adds that the algorithm failed.
        self._observe(algorithm.GetExecutive(), "ErrorEvent", VTK_STRING, lambda _text: None)

    def run(self, update: Callable[[], object]) -> None:
        """Calls update(), which executes the algorithm.

        Raises what the progress callback raised, or KeyboardInterrupt (what the handler of SIGINT does).
        """
        previous = signal.getsignal(signal.SIGINT)
        handled = threading.current_thread() is threading.main_thread() and callable(previous)
        if handled:
            signal.signal(signal.SIGINT, self._on_interruption)
        try:
            update()
        finally:
            for subject, tag in self._observers:
                subject.RemoveObserver(tag)
            self._observers.clear()
            if handled:
                signal.signal(signal.SIGINT, previous)
        if self._interruption is not None and callable(previous):
            previous(*self._interruption)
        if self._failure is not None:
            raise self._failure

    def check(self, doing: str) -> None:
        """After run(). Raises MeshingCancelled, or MeshingError with the reason that the filter gives."""
        filter_: Any = self.algorithm
        if filter_.GetAborted() or self.cancelled:
            raise MeshingCancelled(f"{doing} was cancelled")
        message = filter_.GetErrorMessage() or "\n".join(self.errors)
        if message:
            raise MeshingError(message)

    def _observe(self, subject: Any, event: str, kind: Any, act: Callable[[Any], object],
                 convert: Callable[[Any], Any] = lambda data: data) -> None:
        @calldata_type(kind)  # type: ignore[misc]
        def call(_caller: Any, _event: str, data: Any) -> None:
            act(convert(data))

        self._observers.append((subject, subject.AddObserver(event, call)))

    def _on_interruption(self, number: int, frame: Optional[FrameType]) -> None:
        self._interruption = (number, frame)
        self.algorithm.SetAbortExecute(1)

    def _on_progress(self, fraction: float) -> None:
        """Must not raise: VTK would print a traceback and go on."""
        if self._progress is not None and self._failure is None and not self.cancelled:
            try:
                answer = self._progress(fraction)
                self.cancelled = answer is not None and not answer
            except BaseException as failure:  # pylint: disable=broad-except
                self._failure = failure
        if self.cancelled or self._failure is not None:
            self.algorithm.SetAbortExecute(1)
        elif threading.active_count() > 1:
            time.sleep(_PAUSE)


def _without_preamble(text: str) -> str:
    return _PREAMBLE.sub("", text).strip()
