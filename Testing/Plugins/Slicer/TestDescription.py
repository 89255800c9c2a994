#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The description that the module gives of itself, against the rules of the Slicer Execution Model."""
import unittest
from xml.etree import ElementTree

from execution_model import find_faults
from module import ModuleTestCase


class Description(ModuleTestCase):
    def setUp(self):
        super().setUp()
        self.xml = self.run_module("--xml")

    def parameter(self, name):
        for group in ElementTree.fromstring(self.xml.encode()).findall("parameters"):
            for parameter in group:
                if parameter.findtext("name") == name:
                    return parameter
        self.fail("no parameter " + name)

    def test_follows_the_rules(self):
        self.assertEqual(find_faults(self.xml), [])

    def test_images_and_models(self):
        expected = {"inputLabels": ("image", "any", "input", "0"), "colorTable": ("table", "color", "input", None),
                    "outputMesh": ("geometry", "model", "output", "1"),
                    "outputSurfaces": ("geometry", "model", "output", None)}
        for name, parts in expected.items():
            p = self.parameter(name)
            self.assertEqual((p.tag, p.get("type"), p.findtext("channel"), p.findtext("index")), parts)
        # Slicer names temporary files by the first of these; a .vtp file could not hold tetrahedra.
        self.assertEqual(self.parameter("outputMesh").get("fileExtensions"), ".vtu")
        self.assertEqual(self.parameter("outputSurfaces").get("fileExtensions"), ".vtp")

    def test_every_flag_is_understood(self):
        """Each flag of the description works, with its default, which applications give."""
        arguments = []
        for group in ElementTree.fromstring(self.xml.encode()).findall("parameters"):
            for p in group.findall("*[longflag]"):
                if p.tag == "boolean":
                    arguments.append(p.findtext("longflag"))
                elif p.tag not in ("geometry", "table"):
                    arguments += [p.findtext("longflag"), p.findtext("default") or ""]
        self.assertGreater(len(arguments), 15)
        self.assert_refused(1, "there is no such file", *arguments, "no.nrrd", "mesh.vtu")


class Rules(ModuleTestCase):
    """The rules themselves: each notices what it is there for."""

    def setUp(self):
        super().setUp()
        self.xml = self.run_module("--xml")

    def assert_fault(self, old, new, fault):
        self.assertIn(old, self.xml)
        self.assertRegex("; ".join(find_faults(self.xml.replace(old, new, 1))), fault)

    def test_structure(self):
        self.assert_fault("<?xml", "\n<?xml", "begin with")
        self.assert_fault("</executable>", "", "well-formed")
        self.assert_fault("<category>Segmentation.Meshing</category>", "", "elements")
        self.assert_fault("<license>BSD-3-Clause</license>", "<license></license>", "license> is empty")
        self.assert_fault("<parameters>", "<parameters advanced='maybe'>", "of a group")
        self.assert_fault("<label>Quality</label>", "", "begins with label")
        self.assert_fault("<boolean>", "<bool>", "well-formed|unknown")

    def test_parameters(self):
        self.assert_fault("<name>delta</name>", "<name>delta-2</name>", "variable")
        self.assert_fault("<name>delta</name>", "<name>size</name>", "'size' is not unique")
        self.assert_fault("--label_size", "--label-size", "underscores")
        self.assert_fault("--label_size", "--labels", "'--labels' is not unique")
        self.assert_fault("--label_size", "--echo", "every module")
        self.assert_fault("<longflag>--delta</longflag>", "<flag>-dd</flag>", "one character")
        self.assert_fault("<index>1</index>", "<index>2</index>", "indices")
        self.assert_fault("<index>1</index>", "<index>1</index><longflag>--out</longflag>", "index and a flag")
        self.assert_fault("<channel>input</channel>", "", "channel")
        self.assert_fault("<channel>input</channel>", "<channel>in</channel>", "channel 'in'")
        self.assert_fault('type="any"', 'type="all"', "type 'all'")
        self.assert_fault('type="model"', 'type="mesh"', "type 'mesh'")
        self.assert_fault('type="model"', 'kind="model"', "attributes")
        self.assert_fault("<longflag>--size</longflag>", "", "neither flag nor index")

    def test_values(self):
        self.assert_fault("<default>lps</default>", "<default>las</default>", "not in the enumeration")
        self.assert_fault("<default>30</default>", "<default>31</default>", "constraints")
        self.assert_fault("<default>30</default>", "<default>thirty</default>", "not a number")
        self.assert_fault("<default>false</default>", "<default>true</default>", "default is false")
        self.assert_fault("<step>0.1</step>", "<step>0</step>", "step")
        self.assert_fault("<step>0.1</step>", "", "constraints")


if __name__ == "__main__":
    unittest.main(verbosity=2)
