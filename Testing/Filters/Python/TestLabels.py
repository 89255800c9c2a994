#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Which labels are meshed, and what is said of those that are lost or thin."""
import json
import unittest

import numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING

import voxplex
from filter_testing import FilterTestCase, tets

N = 24
K, J, I = numpy.mgrid[:N, :N, :N]


def two_labels():
    distance = numpy.sqrt((I - 11.5) ** 2 + (J - 11.5) ** 2 + (K - 11.5) ** 2)
    return tets(voxplex.Image(numpy.where(distance < 8, numpy.where(I < 12, 1, 2), 0).astype(numpy.uint8)).to_vtk())


class Choice(FilterTestCase):
    def check(self, mesher, labels, pairs=None):
        mesher.Update()
        self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels), labels)
        if pairs:
            self.assertEqual({tuple(pair) for pair in voxplex.Interfaces.from_vtk(mesher.GetInterfaces()).labels}, pairs)

    def test_subset(self):
        mesher = two_labels()
        self.assertEqual(mesher.GetNumberOfSelectedLabels(), 0)
        mesher.AddLabel(2)
        self.assertEqual((mesher.GetNumberOfSelectedLabels(), mesher.GetSelectedLabel(0)), (1, 2))
        self.check(mesher, {2}, {(2, 0)})
        mesher.AddLabel(1)
        self.check(mesher, {1, 2})
        mesher.RemoveLabel(2)
        self.check(mesher, {1})
        mesher.RemoveAllLabels()
        self.check(mesher, {1, 2})

    def test_excluded(self):
        mesher = two_labels()
        mesher.ExcludeLabel(2)
        mesher.ExcludeLabel(2)
        self.assertEqual((mesher.GetNumberOfExcludedLabels(), *map(mesher.GetExcludedLabel, (0, 1, -1))), (1, 2, 0, 0))
        self.check(mesher, {1}, {(1, 0)})
        mesher.RemoveExcludedLabel(2)
        mesher.ExcludeLabel(1)
        self.check(mesher, {2})
        mesher.RemoveAllExcludedLabels()
        self.check(mesher, {1, 2})

    def test_rows(self):
        """Rows of a table are sizes and exclusions in other words."""
        mesher = two_labels()
        mesher.SetLabelRow(1, 1.5, True)
        mesher.SetLabelRow(2, 2.5, False)  # the size of what is not meshed does not count
        self.assertEqual((mesher.GetLabelSize(1), mesher.GetNumberOfLabelSizes()), (1.5, 1))
        self.assertEqual((mesher.GetNumberOfExcludedLabels(), mesher.GetExcludedLabel(0)), (1, 2))
        self.check(mesher, {1})
        fine = mesher.GetOutput().GetNumberOfCells()
        mesher.SetLabelRow(1, 0.0, True)
        self.assertEqual(mesher.GetNumberOfLabelSizes(), 0)
        self.check(mesher, {1})
        self.assertLess(mesher.GetOutput().GetNumberOfCells(), fine)
        mesher.SetLabelRow(2, 0.0, True)
        self.check(mesher, {1, 2})
        mesher.SetLabelRow(1, 1.0, True)
        mesher.SetLabelRow(2, 1.0, False)
        mesher.ClearLabelRows()
        self.assertEqual((mesher.GetNumberOfLabelSizes(), mesher.GetNumberOfExcludedLabels()), (0, 0))


class Warnings(FilterTestCase):
    def run_filter(self, labels, delta, keeps_parts=True):
        """The filter, its statistics, and a list that its warnings go into."""
        mesher, warnings = tets(voxplex.Image(labels.astype(numpy.uint8)).to_vtk()), []
        mesher.SetDelta(delta)
        if not keeps_parts:
            mesher.SetInterfaceRounds(0)
            mesher.ManifoldOff()

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            warnings.append(text)

        mesher.AddObserver("WarningEvent", keep)
        mesher.Update()
        return mesher, mesher.GetStatistics(), warnings

    def test_lost(self):
        labels = numpy.where((I - 12) ** 2 + (J - 12) ** 2 + (K - 12) ** 2 < 64, numpy.where(I < 12, 4, 5), 0)
        labels[12, 12, 12] = 9  # one voxel beside an interface
        mesher, statistics, warnings = self.run_filter(labels, 4.0)
        self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels), {4, 5, 9})
        self.assertEqual((statistics.GetNumberOfLostLabels(), warnings), (0, []))
        mesher.SetSmallestComponent(0)
        mesher.Update()
        self.assertEqual((statistics.GetNumberOfLostLabels(), statistics.GetLostLabel(0), statistics.GetLostLabel(5)), (1, 9, 0))
        self.assertEqual(json.loads(statistics.ToJSON())["lost_labels"], [9])
        self.assertEqual(len(warnings), 1)
        self.assertIn("lacks", warnings[0])

    def test_small_parts(self):
        """Balls that are small for Delta lose a part of their volume, and the worst is named first; a large one does not."""
        k, j, i = numpy.mgrid[:40, :40, :40]
        labels = numpy.where((i - 26) ** 2 + (j - 26) ** 2 + (k - 26) ** 2 < 11 ** 2, 1, 0)
        for label, radius in ((2, 3.6), (3, 3.0), (4, 2.4)):
            labels[(i - 7) ** 2 + (j - 10 * (label - 1)) ** 2 + (k - 7) ** 2 <= radius ** 2] = label
        _, statistics, warnings = self.run_filter(labels, 3.0, keeps_parts=True)
        shrunk = json.loads(statistics.ToJSON())["shrunk_labels"]
        self.assertNotIn(1, [one["label"] for one in shrunk])
        self.assertIn(3, [one["label"] for one in shrunk])
        self.assertEqual(shrunk, sorted(shrunk, key=lambda one: one["fraction"]))
        self.assertIn("the worst first): %d (%.0f %%)" % (shrunk[0]["label"], 100 * shrunk[0]["fraction"]), warnings[0])
        self.assertEqual(len(warnings), 1)

    def test_shrunk(self):
        """A sheet that is thin for Delta loses volume, and is in pieces, if nothing keeps it."""
        k, j, i = numpy.mgrid[:32, :32, :32]
        labels = numpy.where((k >= 8) & (k < 10) & (numpy.hypot(i - 16, j - 16) < 14), 9, 0)
        labels[(i - 18) ** 2 + (j - 18) ** 2 + (k - 22) ** 2 < 64] = 4
        mesher, statistics, warnings = self.run_filter(labels, 4.0, keeps_parts=False)
        self.assertEqual((statistics.GetNumberOfShrunkLabels(), statistics.GetShrunkLabel(0), statistics.GetShrunkLabel(1)),
                         (1, 9, 0))
        fraction = statistics.GetShrunkLabelFraction(0)
        self.assertTrue(0 < fraction < 0.5, fraction)
        self.assertEqual(statistics.GetShrunkLabelFraction(-1), 0)
        shrunk, = json.loads(statistics.ToJSON())["shrunk_labels"]
        self.assertEqual(shrunk["label"], 9)
        self.assertAlmostEqual(shrunk["fraction"], fraction, 5)
        self.assertEqual(len(warnings), 2)
        self.assertIn("a tenth or more of the volume of these labels, which are small or thin for a Delta of 4 (with what it has, the worst first): 9 (", warnings[0])
        self.assertIn("in several pieces that no common faces connect: ", warnings[1])
        mesher.SetInterfaceRounds(8)
        mesher.ManifoldOn()
        mesher.ExactComponentsOn()
        mesher.Update()
        figures = json.loads(statistics.ToJSON())
        self.assertEqual((statistics.GetNumberOfShrunkLabels(), figures["shrunk_labels"], figures["broken_components"]),
                         (0, [], []))
        self.assertEqual(len(warnings), 2)


if __name__ == "__main__":
    unittest.main()
