#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names of labels become names of sets and surfaces that each format allows."""
import json
from xml.etree import ElementTree

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

LONG = "n" * 200
NAMES = {1: "3rd ventricle", 2: "Liver", 3: "LIVER", 4: ' Größe "x" (<a>&b) ', 5: LONG, 7: "background", 8: "ä" * 100,
         9: "\\a\tb\\c", 10: "脳", 11: "label_6"}

# By format: the names of labels 1 to 11, and of some pairs. Labels without a name: 6.
QUOTED = {1: "3rd ventricle", 2: "Liver", 3: "LIVER", 4: "Größe _x_ (<a>&b)", 5: "n" * 125 + "_5", 6: "label_6",
          7: "background", 8: "ä" * 62 + "_8", 9: "a_b_c", 10: "脳", 11: "label_6_11"}
QUOTED_PAIRS = {(1, 0): "3rd ventricle__background", (4, 3): "Größe _x_ (<a>&b)__LIVER",
                (6, 5): "label_6__" + "n" * 114 + "_6_5", (7, 0): "background__background", (10, 9): "脳__a_b_c"}
ABAQUS = {1: "set_3rd_ventricle", 2: "Liver", 3: "LIVER_3", 4: "Gr_e_x_a_b", 5: "n" * 78 + "_5", 6: "label_6",
          7: "background", 8: "label_8", 9: "a_b_c", 10: "label_10", 11: "label_6_11"}
ABAQUS_PAIRS = {(1, 0): "set_3rd_ventricle__background", (4, 3): "Gr_e_x_a_b__LIVER_3",
                (6, 5): "label_6__" + "n" * 67 + "_6_5", (7, 0): "background__background", (10, 9): "label_10__a_b_c"}
FEBIO = {**QUOTED, 4: "Größe _x_ (_a_b)"}


class SetNames(ProgramTestCase):
    def setUp(self):
        super().setUp()
        # Slabs of one label each, one beside the other.
        array = np.zeros((12, 12, 48), dtype=np.uint8)
        array[2:-2, 2:-2, 2:-2] = 1 + np.arange(44) // 4
        self.input = images.write_nrrd(self.folder / "slabs.nrrd", array)
        self.table(NAMES)

    def table(self, names):
        (self.folder / "names.csv").write_text("".join('%d,"%s"\n' % (label, name.replace('"', '""'))
                                                       for label, name in names.items()))

    def write(self, name):
        self.mesh("--input", self.input, "--delta", 1.5, "--threads", 1, "--label-table", "names.csv", "--output", name)
        return self.folder / name

    def check(self, label_names, pair_names, labels, pairs):
        self.assertEqual(label_names, labels)
        for pair, name in pairs.items():
            self.assertEqual(pair_names[pair], name)
        every = [*label_names.values(), *pair_names.values()]
        self.assertEqual(len(set(every)), len(every))

    def test_gmsh_and_mfem(self):
        mesh = meshfiles.read_tetrahedra(self.write("mesh.mfem"))
        for labels, pairs in ((mesh.label_names, mesh.names), meshfiles.gmsh_names(self.write("mesh.msh"))):
            self.check(labels, pairs, QUOTED, QUOTED_PAIRS)
            self.assertEqual(max(len(text.encode()) for text in [*labels.values(), *pairs.values()]), 127)

    def test_medit(self):
        """Where the set's name is not the label's, that follows in brackets."""
        mesh = meshfiles.read_tetrahedra(self.write("mesh.mesh"))
        self.assertEqual(mesh.label_names, {**QUOTED, 5: QUOTED[5] + " (%s)" % ("n" * 127),
                                            8: QUOTED[8] + " (%s)" % ("ä" * 63), 11: "label_6_11 (label_6)"})
        for pair, name in QUOTED_PAIRS.items():
            self.assertEqual(mesh.names[pair], name)

    def test_xdmf(self):
        root = ElementTree.parse(self.write("mesh.xdmf"))
        information = {entry.get("Name"): entry.get("Value") for entry in root.iter("Information")}
        self.assertEqual(json.loads(information["CellTags"]), {name: label for label, name in QUOTED.items()})
        self.assertLessEqual(set(QUOTED_PAIRS.values()), set(json.loads(information["FacetTags"])))

    def test_febio(self):
        root = ElementTree.parse(self.write("mesh.feb"))
        self.assertEqual([part.get("name") for part in root.iter("Elements")], list(FEBIO.values()))
        self.assertEqual([domain.get("mat") for domain in root.iter("SolidDomain")], list(FEBIO.values()))
        surfaces = [surface.get("name") for surface in root.iter("Surface")]
        self.assertEqual(len(set(surfaces)), len(surfaces))
        self.assertIn("Größe _x_ (_a_b)__LIVER", surfaces)

    def test_abaqus(self):
        mesh = meshfiles.read_tetrahedra(self.write("mesh.inp"))
        self.check(mesh.label_names, mesh.names, ABAQUS, ABAQUS_PAIRS)
        self.assertEqual(set(mesh.surfaces), set(mesh.names.values()))
        every = [*mesh.label_names.values(), *mesh.names.values()]
        self.assertEqual(len({name.lower() for name in every}), len(every))
        for name in every:
            self.assertRegex(name, "^[A-Za-z][A-Za-z0-9_-]{0,79}$")

    def test_pair_like_another(self):
        """A label called background and the background; two labels that read as a pair."""
        self.table({2: "background", 3: "A", 4: "A__background"})
        labels, pairs = meshfiles.gmsh_names(self.write("mesh.msh"))
        self.assertEqual(labels[4], "A__background")
        self.assertEqual([pairs[pair] for pair in ((3, 0), (3, 2), (2, 0))],
                         ["A__background_3_0", "A__background_3_2", "background__background"])


if __name__ == "__main__":
    main()
