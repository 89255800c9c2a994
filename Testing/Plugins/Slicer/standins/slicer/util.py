# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for slicer.util."""

shownErrors = []


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
