#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The properties of the VTK filters against the table: defaults, ranges, the places of words, what needs Force."""
import math
import re
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk

import voxplex
from voxplex import vtkImageToPentatopeMeshFilter, vtkImageToTetMeshFilter, vtkSegmentationReader

from table import BY_PROPERTY, default_of, make_filter

LARGEST_WHOLE = 2**31 - 1
# Limits that filters do not have.
ANY_SEED = "RandomSeed"  # negative, too
ANY_THREADS = "NumberOfThreads"  # more than 4096 is a slip of the keyboard


def message_about(parameter, value, force):
    """None if the filter takes the value and begins to work with it."""
    labels = numpy.zeros((8, 8, 8), dtype=numpy.uint8)
    labels[2:6, 2:6, 2:6] = 1
    mesher = make_filter(parameter)
    image = voxplex.Image(labels).to_vtk()
    if parameter["dimension"] == 4:  # the components are frames
        image.GetPointData().SetScalars(numpy_to_vtk(numpy.repeat(labels.reshape(-1, 1), 2, axis=1), deep=True))
    if parameter["class"] != "Reader":
        mesher.SetInputData(image)
    if parameter["class"] not in ("Reader", "Repair"):
        mesher.SetForce(force)
    if parameter["property"] in ("Isovalue", "InsideLabel", "IsosurfaceSmoothingSigma"):
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(0.03)  # smoothing leaves little
    getattr(mesher, "Set" + parameter["property"])(int(value) if parameter["kind"] == "whole" else value)
    if str(float(getattr(mesher, "Get" + parameter["property"])())) != str(float(value)):
        return parameter["property"] + " was clamped"
    if parameter["class"] == "Reader":
        return None
    mesher.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(caller.GetProgress() > 0.3))
    mesher.AddObserver("ErrorEvent", lambda caller, event: None)
    mesher.GetExecutive().AddObserver("ErrorEvent", lambda caller, event: None)
    mesher.Update()
    return mesher.GetErrorMessage()


def is_accepted(*arguments):
    return not message_about(*arguments)


def other_value(parameter):
    """One that is allowed, and not the default."""
    default = default_of(parameter)
    if parameter["words"] or parameter["kind"] == "flag":
        return 1 - default
    low, high = parameter["range"]
    return next(value for value in (1, 2, 0.02) if value != default and (low or 0) <= value <= (high or math.inf))


class Filters(unittest.TestCase):
    def test_defaults(self):
        for parameter in BY_PROPERTY.values():
            with self.subTest(parameter["name"]):
                self.assertEqual(getattr(make_filter(parameter), "Get" + parameter["property"])(), default_of(parameter))

    def test_ranges(self):
        for parameter in BY_PROPERTY.values():
            low, high = parameter["range"]
            step = 1 if parameter["kind"] == "whole" else 1e-3
            with self.subTest(parameter["name"]):
                if low is not None and not (parameter["default"] == "" and low in (0, 1)) and parameter["property"] != ANY_SEED:
                    self.assertFalse(is_accepted(parameter, low if parameter["low_is_outside"] else low - step, True))
                if high is not None and high < LARGEST_WHOLE and parameter["property"] != ANY_THREADS:
                    self.assertFalse(is_accepted(parameter, high + step, True))
                    self.assertTrue(is_accepted(parameter, high, True))

    def test_not_finite(self):
        for parameter in (p for p in BY_PROPERTY.values() if p["kind"] == "real" and p["class"] != "Reader"):
            for value in (math.nan, math.inf, -math.inf):
                with self.subTest(parameter["name"], value=value):
                    about = "isovalue|smoothing of grey values" if "Iso" in parameter["property"] else parameter["property"]
                    self.assertRegex(message_about(parameter, value, True), about)

    def test_changes(self):
        """Another value makes the filter execute again; the same one does not. It is printed."""
        for parameter in BY_PROPERTY.values():
            with self.subTest(parameter["name"]):
                mesher, value, printed = make_filter(parameter), other_value(parameter), set()
                for is_other in (True, False):
                    printed.update(re.findall(rf"\b{parameter['property']}: .*", str(mesher)))
                    before = mesher.GetMTime()
                    getattr(mesher, "Set" + parameter["property"])(value)
                    self.assertEqual(mesher.GetMTime() > before, is_other)
                self.assertEqual(len(printed), 2, printed)

    def test_no_value(self):
        """0 where a value need not be given; less than that is nothing."""
        for parameter in BY_PROPERTY.values():
            if parameter["default"] == "" and parameter["kind"] in ("real", "whole") and parameter["range"][0] is not None:
                with self.subTest(parameter["name"]):
                    self.assertTrue(is_accepted(parameter, 0, False))
                    self.assertFalse(is_accepted(parameter, -1, True))

    def test_force(self):
        forced = {p["property"]: p for p in BY_PROPERTY.values() if p["force"] is not None}
        self.assertEqual(set(forced), {"RadiusEdgeRatio", "SliverAngle", "SliverBound"})
        for parameter in forced.values():
            limit = parameter["force"]
            beyond = math.nextafter(limit, 0.0 if parameter["property"] == "RadiusEdgeRatio" else 100.0)
            with self.subTest(parameter["name"]):
                self.assertTrue(is_accepted(parameter, limit, False))
                self.assertFalse(is_accepted(parameter, beyond, False))
                self.assertTrue(is_accepted(parameter, beyond, True))

    def test_words(self):
        tets, pentatopes, reader = vtkImageToTetMeshFilter, vtkImageToPentatopeMeshFilter, vtkSegmentationReader
        places = {"Overlap": (reader.OVERLAP_SMALLEST, reader.OVERLAP_ORDER),
                  "Space": (reader.SPACE_LPS, reader.SPACE_RAS), "Inside": (tets.INSIDE_ABOVE, tets.INSIDE_BELOW), "Grading": (tets.UNIFORM, tets.LOCAL_FEATURE_SIZE),
                  "RuleOrder": (pentatopes.RADIUS_EDGE_FIRST, pentatopes.SURFACE_FIRST),
                  "ContentionManager": (tets.CONTENTION_AGGRESSIVE, tets.CONTENTION_RANDOM, tets.CONTENTION_GLOBAL,
                                        tets.CONTENTION_LOCAL),
                  "LoadBalancer": (tets.RANDOM_WORK_STEALING, tets.HIERARCHICAL_WORK_STEALING)}
        words = {"Overlap": ["smallest", "order"], "Space": ["lps", "ras"], "Inside": ["above", "below"], "Grading": ["uniform", "lfs"], "RuleOrder": ["radius-edge", "surface"],
                 "ContentionManager": ["aggressive", "random", "global", "local"], "LoadBalancer": ["rws", "hws"]}
        self.assertEqual({p["property"]: p["words"] for p in BY_PROPERTY.values() if p["words"]}, words)
        for name, values in places.items():
            self.assertEqual(values, tuple(range(len(words[name]))), name)


if __name__ == "__main__":
    unittest.main()
