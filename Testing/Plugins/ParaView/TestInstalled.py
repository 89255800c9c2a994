# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The installed plugin: nothing but PV_PLUGIN_CONFIG_FILE says where it is.

usage: TestInstalled.py PREFIX
"""
from voxplex_testing import *

import paraview.simple


def loaded_files():
    with open("/proc/self/maps", encoding="utf-8") as maps:
        return {path for path in (line.split()[-1] for line in maps) if "oxplex" in os.path.basename(path)}


def main():
    prefix = os.path.realpath(sys.argv[1])
    reader = paraview.simple.XMLImageDataReader(FileName=[write_image(make_image(two_balls), "balls.vti")])
    mesher = paraview.simple.MeshSegmentationTetrahedralize(Input=reader)
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {3, 7})
    files = loaded_files()
    check(any("libvtkVoxplex" in file for file in files), "the library is loaded", files)
    check(all(file.startswith(prefix) for file in files), "all of it is the installed one", files)
    installed = [os.path.join(folder, name) for folder, _, names in os.walk(prefix) for name in names]
    check(not [path for path in installed if "WindowTest" in path], "tests are not installed", installed)
    check(not [path for path in installed if path.endswith((".h", ".a", ".cmake"))], "nothing but the plugin", installed)


run(main)
