# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Client and server: the filter executes in a pvserver on loopback.

usage: TestServer.py PVSERVER (a plain Python with ParaView's modules is the client)
"""
import subprocess
import threading

from voxplex_testing import *

from paraview.simple import Connect, GetColorTransferFunction, XMLImageDataReader


def start_server(program):
    """Tries some ports. Returns the process and the port."""
    for port in range(11400, 11420):
        server = subprocess.Popen([program, "--server-port=%d" % port], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
        lines = []
        for line in server.stdout:
            lines.append(line)
            if "Accepting connection" in line:
                threading.Thread(target=lambda: [print("pvserver:", l, end="") for l in server.stdout], daemon=True).start()
                return server, port
        server.wait()
    raise RuntimeError("pvserver does not start: " + "".join(lines))


def main():
    server, port = start_server(sys.argv[1])
    try:
        Connect("localhost", port)
        check(servermanager.ActiveConnection.IsRemote(), "the connection is remote")
        load_plugin(remote=True, namespace=globals())
        reader = SegmentationReaderVoxplex(FileName=ATLAS)
        mesher = MeshSegmentationTetrahedralize(Input=reader)
        check_equal(mesher.Delta, 2.0, "default Delta, from the server")
        mesher.Delta = 4.0
        mesher.LabelTable = [1, 0, 0, 2, 3.0, 1]
        mesher.UpdatePipeline()
        check(mesher.SMProxy.GetClientSideObject() is None, "the filter is not in the client")
        check_equal(labels_of(mesher), set(range(2, 117)), "labels")
        check(20000 < count_cells(mesher) < 100000, "tetrahedra", count_cells(mesher))
        check(count_cells(mesher, 1) > 10000, "triangles")
        import voxplex_paraview

        voxplex_paraview.apply_label_colors(mesher)
        check_equal(len(GetColorTransferFunction("Label").Annotations), 2 * 115, "annotations from the server")
        check_equal(pairs(GetColorTransferFunction("Label").Annotations)["5"], "Frontal_Sup_Orb_L", "the atlas's names")

        named = MeshSegmentationTetrahedralize(Input=XMLImageDataReader(FileName=[write_named_image()]))
        for source in (named, named[1]):  # the interfaces have the same field data, but no array Label
            voxplex_paraview.apply_label_colors(source)
            colors = GetColorTransferFunction("Label")
            check_equal(pairs(colors.Annotations)["3"], NAME, "a name from the server")
            check_equal([round(c, 6) for c in colors.IndexedColors[:3]], list(COLOR), "a colour from the server")
        check_equal(set(pairs(colors.Annotations)), {"3"}, "labels of the second output")
        voxplex_paraview.apply_label_colors(mesher)
        screenshot(mesher, "server.png", ("CELLS", "Label"))
    finally:
        server.terminate()
        server.wait(timeout=30)


run(main)
