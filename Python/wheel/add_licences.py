#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Adds the licences of Debian's code to a wheel that auditwheel has repaired, and completes its list of components.

usage: add_licences.py UNPACKED_WHEEL STAND_IN...

Each package goes into the SBOM with its libraries, and its copyright file into .dist-info/licenses/. auditwheel's SBOM has
no licences, no code from header files, and no library that dpkg knows under /lib. A STAND_IN is a library of our own.
If a package is not in LICENCES, the exit status is 1.
"""
import hashlib
import json
import re
import shutil
import subprocess
import sys
import urllib.parse
from pathlib import Path

# What a wheel may have: packages whose copyright files were read, and the licence of the part that is used, which is never
# the GPL only.
LICENCES = {
    "Apache-2.0": "liblerc4 libssl3 libssl3t64 libtbb12",
    "BSD-2-Clause": "libaec0 liblz4-1 libopenjp2-7 libsz2 libxxhash0",
    "BSD-3-Clause": "libcharls2 libdouble-conversion3 libgdcm3.0 libgdcm3.0t64 libhdf5-103-1 libhdf5-310 libhwloc15 "
                    "libsharpyuv0 libuuid1 libvtk9.1 libvtk9.3 libwebp7",
    "BSD-3-Clause OR GPL-2.0-only": "libcap2 libzstd1",
    "BSL-1.0": "libboost1.74-dev libboost1.83-dev",
    "IJG AND BSD-3-Clause AND Zlib": "libjpeg62-turbo",
    "LGPL-2.1-or-later": "libudev1",
    "LGPL-3.0-or-later": "libcgal-dev",
    "LGPL-3.0-or-later OR GPL-2.0-or-later": "libgmp10",
    "LicenseRef-Public-Domain": "liblzma5",
    "MIT": "libdeflate0 libjson-c5 libjsoncpp25 nlohmann-json3-dev",
    "libpng-2.0": "libpng16-16 libpng16-16t64",
    "libtiff": "libtiff6",
}
LICENCE_OF = {package: licence for licence, packages in LICENCES.items() for package in packages.split()}
COMPILED_IN = ("/usr/include/CGAL/version.h", "/usr/include/boost/version.hpp", "/usr/include/nlohmann/json.hpp")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def owners(*patterns):
    """Package and path of each file that matches one of the patterns."""
    output = subprocess.run(["dpkg", "--search", *patterns], capture_output=True, text=True, check=False).stdout
    for line in output.splitlines():
        package, _, path = line.partition(": ")
        if not package.startswith("diversion by "):
            yield package.partition(":")[0], Path(path)


def files_of_packages(libraries, stand_ins):
    """The wheel's libraries by their packages. auditwheel adds eight digits of the original's digest to its name."""
    names = {}
    for library in libraries:
        base, short_digest, suffix = re.fullmatch(r"([^.]*)-(\w{8})(\..*)", library.name).groups()
        names[base + suffix, short_digest] = library
    for stand_in in stand_ins:
        names.pop((stand_in.name, digest(stand_in)[:8]), None)
    result = {package: [] for package, _ in owners(*COMPILED_IN)}
    for package, path in owners(*(f"*/{name}" for name, _ in names)):
        if path.is_file() and (library := names.pop((path.name, digest(path)[:8]), None)):
            result.setdefault(package, []).append(library)
    if names:
        sys.exit(f"add_licences: no package has {', '.join(name for name, _ in names)}")
    return result


def files(paths):
    return [{"type": "file", "name": path.name, "hashes": [{"alg": "SHA-256", "content": digest(path)}]}
            for path in sorted(paths)]


def component(package, libraries):
    version = subprocess.run(["dpkg-query", "--show", "--showformat=${Version}", package], capture_output=True, text=True,
                             check=True).stdout
    purl = f"pkg:deb/debian/{package}@{urllib.parse.quote(version, safe='')}"
    return {"type": "library", "bom-ref": purl, "name": package, "version": version, "purl": purl,
            "licenses": [{"expression": LICENCE_OF[package]}], "components": files(libraries)}


def add_texts(packages, folder):
    """Debian's copyright files, and the licences that these have in common and name by their paths."""
    common = set()
    for package in packages:
        text = Path("/usr/share/doc", package, "copyright").read_bytes()
        (folder / package).mkdir()
        (folder / package / "copyright").write_bytes(text)
        common |= set(re.findall(rb"/usr/share/common-licenses/([\w.+-]*\w)", text))
    (folder / "common-licenses").mkdir()
    for name in (Path("/usr/share/common-licenses", name.decode()) for name in common):
        if name.is_file():
            shutil.copy(name, folder / "common-licenses")


def main(wheel, *stand_ins):
    (information,) = wheel.glob("*.dist-info")
    packages = files_of_packages(list(wheel.glob("*.libs/*")), stand_ins)
    if unknown := sorted(packages.keys() - LICENCE_OF.keys()):
        sys.exit(f"add_licences: the wheel has code of {', '.join(unknown)}. Read /usr/share/doc/PACKAGE/copyright. If a wheel "
                 "may have it, add it to LICENCES in Python/wheel/add_licences.py.")
    add_texts(packages, information / "licenses")

    path = information / "sboms" / "auditwheel.cdx.json"
    bill = json.loads(path.read_text())
    ours = bill["metadata"]["component"]
    ours["licenses"] = [{"expression": "BSD-3-Clause"}]
    ours["components"] = files(path for stand_in in stand_ins
                               for path in wheel.glob(f"*.libs/{stand_in.name.partition('.')[0]}-*"))
    bill["components"] = [component(package, libraries) for package, libraries in sorted(packages.items())]
    bill["dependencies"] = [{"ref": ours["bom-ref"], "dependsOn": [part["bom-ref"] for part in bill["components"]]}]
    path.write_text(json.dumps(bill, indent=1) + "\n")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
