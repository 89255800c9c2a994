# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for slicer.util. pip_install() brings the package of the build, or what `installation` does instead."""
import os
import sys

shownErrors = []
questions = []  # that were asked
answer = True  # to them
installations = []  # that were asked for
installation = None


def confirmOkCancelDisplay(text, windowTitle=None):
    questions.append(text)
    return answer


def pip_install(requirements):
    if not isinstance(requirements, str):
        raise TypeError("text is wanted: %r" % requirements)
    installations.append(requirements)
    (installation or install)()


def install():
    sys.path.append(os.environ["VOXPLEX_PACKAGE"])


def uninstall():
    while os.environ["VOXPLEX_PACKAGE"] in sys.path:
        sys.path.remove(os.environ["VOXPLEX_PACKAGE"])
    for name in [name for name in sys.modules if name.split(".")[0] == "voxplex"]:
        del sys.modules[name]


def arrayFromVolume(volumeNode):
    return volumeNode.array


def errorDisplay(text):
    shownErrors.append(text)


class VTKObservationMixin:
    def __init__(self):
        self.observations = []

    def addObserver(self, observed, event, method):
        if (observed, event, method) in [o[:3] for o in self.observations]:
            raise AssertionError("observed twice: %s" % ((observed, event),))
        self.observations.append((observed, event, method, observed.AddObserver(event, method)))

    def removeObserver(self, observed, event, method):
        for o in self.observations:
            if o[:3] == (observed, event, method):
                observed.RemoveObserver(o[3])
                self.observations.remove(o)
                return
        raise AssertionError("was not observed: %s" % ((observed, event),))

    def removeObservers(self):
        for observed, _, _, tag in self.observations:
            observed.RemoveObserver(tag)
        self.observations = []
