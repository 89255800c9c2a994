#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What is written again elsewhere, against the table: ParaView's properties, the setters of the programs, the
documentation."""
import os
import re
import subprocess
import sys
import unittest
from xml.etree import ElementTree

from voxplex import vtkImageToPentatopeMeshFilter, vtkImageToTetMeshFilter, vtkSegmentationReader, vtkSegmentationRepair

from table import BY_PROPERTY, SOURCE, TABLE, default_of

sys.path.append(str(SOURCE / "Parameters"))
from write_documentation import page  # noqa: E402
from write_paraview import write  # noqa: E402
from write_slicer import text as slicers_text  # noqa: E402

XML = SOURCE / "Plugins" / "ParaView" / "XML"
# Of ParaView itself, or about its input.
OF_PARAVIEW = {"DeltaIsSuggestion", "InputMode", "InterfaceTable", "LabelTable", "Vocabulary"}


def elements(name):
    return list(ElementTree.fromstring(write(TABLE, XML / f"{name}.xml.in", XML / "Properties.xml.in")).iter())


def properties(name):
    """The properties of a proxy with numbers, by name."""
    return {p.get("name"): p for p in elements(name) if p.tag in ("IntVectorProperty", "DoubleVectorProperty") and
            p.get("command", "").startswith("Set") and p.get("name") not in OF_PARAVIEW}


class ParaView(unittest.TestCase):
    PROXIES = {"TetMesh": (vtkImageToTetMeshFilter, 3), "PentatopeMesh": (vtkImageToPentatopeMeshFilter, 4)}

    def test_defaults(self):
        """Those of the filters."""
        for name, (kind, _) in self.PROXIES.items():
            for prop in properties(name).values():
                with self.subTest(prop.get("name")):
                    self.assertEqual(float(prop.get("default_values")), getattr(kind(), "Get" + prop.get("name"))())

    def test_all_are_there(self):
        for name, (_, dimension) in self.PROXIES.items():
            wanted = {p["property"] for p in BY_PROPERTY.values()
                      if p["dimension"] in (0, dimension) and p["class"] not in ("Reader", "Repair")}
            self.assertEqual(wanted - set(properties(name)) - {"MemoryLimit"}, set(), name)

    def test_reading_and_repair(self):
        """Of one value, with the default of the class, or with a command for each row."""
        for name, kind, of in (("SegmentationReader", vtkSegmentationReader, "Reader"),
                               ("SegmentationRepair", vtkSegmentationRepair, "Repair")):
            found = {p.get("command"): p for p in elements(name) if p.get("command")}
            for parameter in (p for p in TABLE if p["class"] == of and p["panel"]):
                prop = found["Set" + parameter["property"]]
                if parameter in BY_PROPERTY.values():
                    self.assertEqual(float(prop.get("default_values")), getattr(kind(), "Get" + parameter["property"])())
                elif parameter["kind"] != "file":
                    self.assertTrue(prop.get("clean_command") or prop.get("default_values"), parameter["name"])
        self.assertLess({"SetOverlap", "SetMaskThreshold", "SetResampleMasks"},
                        {p.get("command") for p in elements("MasksToSegmentation")})

    def test_ranges(self):
        checked = 0
        for name in self.PROXIES:
            for prop in properties(name).values():
                domain = next((d for tag in ("IntRangeDomain", "DoubleRangeDomain") for d in prop.iter(tag)), None)
                parameter = BY_PROPERTY.get(prop.get("name"))
                if domain is None or parameter is None:
                    continue
                low, high = domain.get("min"), domain.get("max")
                with self.subTest(prop.get("name")):
                    # Sliders have both ends.
                    span = parameter["usual"] if high is not None else parameter["range"]
                    if high is not None:
                        self.assertEqual(float(high), span[1])
                    if low is not None:
                        self.assertEqual(float(low), 0 if parameter["default"] == "" else span[0])
                    checked += 1
        self.assertGreater(checked, 20)

    def test_words(self):
        for name in self.PROXIES:
            for prop in properties(name).values():
                entries = prop.findall("EnumerationDomain/Entry")
                if entries:
                    words = BY_PROPERTY[prop.get("name")]["words"]
                    self.assertEqual([int(entry.get("value")) for entry in entries], list(range(len(words))))


class Setters(unittest.TestCase):
    def test_every_parameter_reaches_its_property(self):
        """The compiler finds out whether the filter has the method."""
        text = subprocess.run([os.environ["VOXPLEX_PARAMETERS"], "setters"], check=True, capture_output=True, text=True).stdout
        found = re.findall(r'\{ "([\w-]+)", To\(&(\w+)::(?:Set|Add)(\w+)\) \}', text)
        wanted = {p["name"]: (p["property"], "Reader" if p["kind"] == "times" else p["class"]) for p in TABLE if p["kind"] != "image"}
        self.assertEqual({name: (prop, kind) for name, kind, prop in found}, wanted)


class Documentation(unittest.TestCase):
    def test_page_is_up_to_date(self):
        """If not: Parameters/write_documentation.py BUILD/Parameters/voxplexParameters > Documentation/Parameters.md"""
        self.assertEqual((SOURCE / "Documentation" / "Parameters.md").read_text(), page(TABLE))

    def test_slicers_table_is_up_to_date(self):
        """If not: Parameters/write_slicer.py says how it is written."""
        path = SOURCE / "Plugins" / "Slicer" / "VoxplexMesher" / "VoxplexMesherLib" / "Parameters.json"
        self.assertEqual(path.read_text(encoding="utf-8"), slicers_text(TABLE))

    def test_defaults_in_the_reference(self):
        """Tables whose rows begin with an option and a number, or a word."""
        known = {"--" + p["option"]: {p["default"]} for p in TABLE if p["option"]}
        known["--smoothing"].add(BY_PROPERTY["IsosurfaceSmoothingSigma"]["default"])
        text = (SOURCE / "Documentation" / "Reference.md").read_text()
        rows = re.findall(r"^\| `(--[\w-]+) [^`]*` \| `?([\d.]+|[\w-]+(?=`))`? \|", text, re.MULTILINE)
        self.assertGreater(len(rows), 10)
        for option, default in (row for row in rows if row[0] in known):
            self.assertIn(default, known[option], option)


class Table(unittest.TestCase):
    def test_names_are_unique(self):
        for key in ("name", "option", "slicer", "python", "property"):
            names = [p[key] for p in TABLE if p[key]]
            self.assertEqual(len(names), len(set(names)), key)

    def test_defaults_are_within_the_ranges(self):
        for p in TABLE:
            if p["kind"] in ("real", "whole") and p["default"]:
                for low, high in (p["range"], p["usual"]):
                    self.assertGreaterEqual(default_of(p), low, p["name"])
                    self.assertLessEqual(default_of(p), float("inf") if high is None else high, p["name"])

    def test_texts(self):
        for p in filter(lambda p: p["option"], TABLE):
            self.assertRegex(p["option_help"], r"^[a-z][^{}]*[^.{}]$", p["name"])


if __name__ == "__main__":
    unittest.main()
