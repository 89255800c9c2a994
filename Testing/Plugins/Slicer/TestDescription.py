#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The description that the module gives of itself, against the rules of the Slicer Execution Model."""
import base64
import ctypes
import unittest
import zlib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

from execution_model import find_faults
from module import LIBRARY, ModuleTestCase

ICON = Path(__file__).resolve().parents[3] / "Plugins/Slicer/VoxplexMesher/Resources/Icons/VoxplexMesher.png"


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

    def test_library_has_the_same(self):
        library = ctypes.CDLL(LIBRARY)
        library.GetXMLModuleDescription.restype = ctypes.c_char_p
        self.assertEqual(library.GetXMLModuleDescription().decode(), self.xml)
        # Slicer takes the address of the symbol for that of the text.
        address = ctypes.addressof(ctypes.c_char.in_dll(library, "XMLModuleDescription"))
        self.assertEqual(ctypes.string_at(address).decode(), self.xml)

    def test_every_flag_is_understood(self):
        """The parser and the description cannot disagree: each flag of the description works, with its default."""
        arguments = []
        for group in ElementTree.fromstring(self.xml.encode()).findall("parameters"):
            for p in group.findall("*[longflag]"):
                if p.tag == "boolean":
                    arguments.append(p.findtext("longflag"))
                elif p.tag not in ("geometry", "table"):
                    arguments += [p.findtext("longflag"), p.findtext("default") or ""]
        self.assertGreater(len(arguments), 15)
        self.assert_refused(1, "there is no such file", *arguments, "no.nrrd", "mesh.vtu")

    def test_letters_are_understood(self):
        for letter, value in (("-d", "2"), ("-s", "1"), ("-t", "1")):
            self.assertIn("<flag>%s</flag>" % letter, self.xml)
            self.assert_refused(1, "there is no such file", letter, value, "no.nrrd", "mesh.vtu")

    def test_logo(self):
        lines = self.run_module("--logo").split("\n")
        self.assertEqual(lines[0], "LOGO")
        width, height, pixel_size, length = map(int, lines[1:5])
        self.assertEqual(len(lines[5]), length)
        pixels = zlib.decompress(base64.b64decode(lines[5]))
        self.assertEqual(len(pixels), width * height * pixel_size)
        self.assertEqual(lines[6:], [""])
        picture = np.frombuffer(pixels, np.uint8).reshape(height, width, pixel_size)
        self.assertEqual(picture[0, 0, 3], 0)  # corners are transparent, the middle is not
        self.assertEqual(picture[height // 2, width // 2, 3], 255)
        self.check_logo_of_library(width, height, pixel_size, lines[5])

    def check_logo_of_library(self, *expected):
        function = ctypes.CDLL(LIBRARY).GetModuleLogo
        function.restype = ctypes.c_char_p
        numbers = [ctypes.c_int(), ctypes.c_int(), ctypes.c_int(), ctypes.c_ulong()]
        text = function(*map(ctypes.byref, numbers)).decode()
        self.assertEqual((*[n.value for n in numbers[:3]], text), expected)
        self.assertEqual(numbers[3].value, len(text))

    def test_logo_is_the_icon(self):
        reader = vtkPNGReader()
        reader.SetFileName(str(ICON))
        reader.Update()
        image = reader.GetOutput()
        self.assertEqual(image.GetDimensions(), (128, 128, 1))  # what the Extensions Index wants
        icon = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(128, 128, 4)[::-1].astype(float)
        lines = self.run_module("--logo").split("\n")
        logo = np.frombuffer(zlib.decompress(base64.b64decode(lines[5])), np.uint8).reshape(64, 64, 4)
        coarse = icon.reshape(64, 2, 64, 2, 4).mean(axis=(1, 3))
        self.assertLess(np.abs(coarse - logo)[..., 3].mean(), 2.0)


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
        self.assert_fault("--labelsizes", "--label-sizes", "underscores")
        self.assert_fault("--labelsizes", "--labels", "'--labels' is not unique")
        self.assert_fault("--labelsizes", "--echo", "every module")
        self.assert_fault("<flag>-d</flag>", "<flag>-dd</flag>", "one character")
        self.assert_fault("<flag>-d</flag>", "<flag>-s</flag>", "'-s' is not unique")
        self.assert_fault("<index>1</index>", "<index>2</index>", "indices")
        self.assert_fault("<index>1</index>", "<index>1</index><longflag>--out</longflag>", "index and a flag")
        self.assert_fault("<channel>input</channel>", "", "channel")
        self.assert_fault("<channel>input</channel>", "<channel>in</channel>", "channel 'in'")
        self.assert_fault('type="any"', 'type="all"', "type 'all'")
        self.assert_fault('type="model"', 'type="mesh"', "type 'mesh'")
        self.assert_fault('type="model"', 'kind="model"', "attributes")
        self.assert_fault("<longflag>--size</longflag>", "", "neither flag nor index")

    def test_values(self):
        self.assert_fault("<default>LPS</default>", "<default>LAS</default>", "not in the enumeration")
        self.assert_fault("<default>30</default>", "<default>31</default>", "constraints")
        self.assert_fault("<default>30</default>", "<default>thirty</default>", "not a number")
        self.assert_fault("<default>false</default>", "<default>true</default>", "default is false")
        self.assert_fault("<step>0.1</step>", "<step>0</step>", "step")
        self.assert_fault("<step>0.1</step>", "", "constraints")


if __name__ == "__main__":
    unittest.main(verbosity=2)
