# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The same faults in a sound file of each format and encoding."""
import re
from dataclasses import replace

from .rows import ANY, Fifo, broken, row


def rows(sounds):
    result = []
    for sound in sounds:
        result += [row("damaged " + sound.encoding, "%s %s: %s" % (sound.format, sound.name, name), files, *outcomes)
                   for name, files, *outcomes in _faults(sound)]
    return result


def _faults(sound):
    files, part = sound.files, sound.part or sound.files.main
    data, header = files.data(part), files.header
    same, lenient = sound.image, replace(sound.image, warns=ANY)

    def changed(new):
        return files.with_data(new, part)

    yield "sound", files, same
    yield "empty", changed(b""), broken()
    yield "half", changed(data[:len(data) // 2]), broken()
    yield "a tenth", changed(data[:len(data) // 10]), broken()
    yield "3 bytes", changed(data[:3]), broken()
    if part != files.main:
        yield "header of half its length", files.with_data(files.data()[:len(files.data()) // 2]), broken()
    if sound.encoding in ("raw", "gzip", "zlib"):
        # Of a binary legacy .vtk that is the line end.
        yield "a byte cut", changed(data[:-1]), broken(), *([same] if sound.format == "VTK legacy" else [])
        yield "2 bytes cut", changed(data[:-2]), broken()
        yield "bytes after the voxels", changed(data + b"garbage" * 3), same, lenient, broken()
        yield "zeros after the voxels", changed(data + bytes(512)), same, lenient, broken()
    if sound.encoding == "raw":
        for length in sorted({header, 256, 348, 352, 1024} - {0}):
            yield "%d bytes cut" % length, changed(data[:-length]), broken()
    if sound.encoding in ("gzip", "zlib"):
        middle = (header + len(data)) // 2
        for name, at in (("its middle", middle), ("its last quarter", (middle + len(data)) // 2),
                         ("its check sum", len(data) - 6)):
            flipped = bytes(b ^ 0x55 for b in data[at:at + 2])
            yield "flipped bytes in " + name, changed(data[:at] + flipped + data[at + 2:]), broken()
        yield "bytes missing in the middle", changed(data[:middle] + data[middle + 20:]), broken()
    if sound.encoding == "text":
        digits = not re.search(rb"\d \d|\d -\d", data[header:])  # hexadecimal ones
        less = data.rstrip()[:-2] if digits else data.rstrip().rpartition(b" ")[0]
        yield "the last line break cut", changed(data.rstrip()), same
        yield "a number missing at the end", changed(less), broken()
        yield "voxels end with the header", changed(data[:header]), broken()
    yield "a FIFO named as its table of labels", files.beside({files.main + ".txt": Fifo()}), same, lenient
