# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Damages files, the same ones in every run, and says which sizes the header of a damaged file claims."""
import math
import re
import struct
import zlib

import numpy as np

NUMBER = re.compile(rb"-?\d+(?:\.\d+)?")
TEXT_VALUES = (b"0", b"-1", b"-4", b"7", b"255", b"65536", b"2147483647", b"2147483648", b"4294967296",
               b"9223372036854775807",
               b"99999999999999999999999", b"1e308", b"1e-320", b"nan", b"inf", b"-inf", b"", b"0x10", b"3.5", b"%n%s",
               b"\0", b"\xff")
BINARY_VALUES = [struct.pack(order + form, value) for order in "<>" for form, value in (
    ("h", -1), ("h", 0), ("h", 32767), ("h", -32768), ("i", -1), ("i", 0), ("i", 2147483647), ("i", -2147483648),
    ("f", math.nan),
    ("f", math.inf), ("f", -1.0), ("f", 0.0), ("f", 1e38), ("f", 1e-40), ("q", 2**63 - 1), ("q", -1))]
# Fields of ten axes for the three and their sizes.
TEN_AXES = {
    "NRRD": lambda data: re.sub(rb"sizes: [^\n]*", b"sizes: " + b" ".join([b"2"] * 10), data.replace(
        b"dimension: 3", b"dimension: 10").replace(b"dimension: 4", b"dimension: 10")),
    "MetaImage": lambda data: re.sub(rb"DimSize = [^\n]*", b"DimSize = " + b" ".join([b"2"] * 10), data.replace(
        b"NDims = 3", b"NDims = 10")),
    "NIfTI": lambda data: data[:40] + struct.pack("<8h", 10, *[2] * 7) + data[56:],
    "NIfTI-2": lambda data: data[:16] + struct.pack("<8q", 10, *[2] * 7) + data[80:],
    "ANALYZE": lambda data: data[:40] + struct.pack("<8h", 10, *[2] * 7) + data[56:],
}


def damaged(sounds, count):
    """(name, format, files): count of each sound file, and its special ones."""
    for sound in sounds:
        title = "%s %s" % (sound.format, sound.name)
        for number in range(count):
            rng = np.random.default_rng([number, zlib.crc32(title.encode())])
            kinds = (_cut, _flip, _number, _number, _number, _long_word, _repeat, _garble)
            kind = kinds[number % len(kinds)]
            yield "%s: %s %d" % (title, kind.__name__[1:], number), sound.format, kind(sound, rng)
        if sound.format in TEN_AXES:
            yield "%s: ten axes" % title, sound.format, _of_header(sound, TEN_AXES[sound.format])


def _of_header(sound, change):
    """The main file with another header; through gzip, if it is compressed as a whole."""
    data = sound.files.data()
    if data[:2] == b"\x1f\x8b":
        return sound.files.with_data(_gzip(change(zlib.decompress(data, 31))))
    return sound.files.with_data(change(data))


def _gzip(data):
    squeeze = zlib.compressobj(wbits=31)
    return squeeze.compress(data) + squeeze.flush()


def _header_length(sound, data):
    return min(len(data), sound.files.header or 600)


def _is_text(sound):
    return sound.format in ("NRRD", "MetaImage", "VTK legacy", "VTK XML")


def _cut(sound, rng):
    part = sound.part or sound.files.main
    data = sound.files.data(part)
    return sound.files.with_data(data[:int(rng.integers(0, len(data)))], part)


def _flip(sound, rng):
    def change(data):
        data = bytearray(data)
        for at in rng.integers(0, _header_length(sound, data), rng.integers(1, 5)):
            data[at] ^= int(rng.integers(1, 256))
        return bytes(data)
    return _of_header(sound, change)


def _number(sound, rng):
    """One number of the header is another."""
    def change_text(data):
        found = list(NUMBER.finditer(data[:_header_length(sound, data)]))
        at = found[rng.integers(len(found))]
        return data[:at.start()] + TEXT_VALUES[rng.integers(len(TEXT_VALUES))] + data[at.end():]

    def change_binary(data):
        value = BINARY_VALUES[rng.integers(len(BINARY_VALUES))]
        at = 2 * int(rng.integers(0, _header_length(sound, data) // 2 - 4))
        return data[:at] + value + data[at + len(value):]

    return _of_header(sound, change_text if _is_text(sound) else change_binary)


def _long_word(sound, rng):
    def change(data):
        length = _header_length(sound, data)
        places = [m.start() for m in re.finditer(rb"[ =:\"\n]\w", data[:length])] if _is_text(sound) else range(length)
        at = places[rng.integers(len(places))] + 1
        return data[:at] + b"x" * 5000 + data[at:]
    return _of_header(sound, change)


def _repeat(sound, rng):
    """A line of the header, or some of its bytes, occur twice."""
    def change(data):
        length = _header_length(sound, data)
        if _is_text(sound):
            lines = data[:length].split(b"\n")
            number, times = int(rng.integers(len(lines))), int(rng.integers(2, 400))
            return b"\n".join(lines[:number] + [lines[number]] * times + lines[number + 1:]) + data[length:]
        at = int(rng.integers(length))
        return data[:at] + data[at - 4:at] + data[at:]
    return _of_header(sound, change)


def _garble(sound, rng):
    """Bytes of the voxels; those that are stored as they are may have any value."""
    part = sound.part or sound.files.main
    data = bytearray(sound.files.data(part))
    first = 0 if sound.part else min(sound.files.header, len(data) - 1)
    for at in rng.integers(first, len(data), 5):
        data[at] = int(rng.integers(256))
    return sound.files.with_data(bytes(data), part)


def claimed_sizes(format_name, data):
    """What the header may mean: lists of sizes. Those of 1 are left out."""
    try:
        if data[:2] == b"\x1f\x8b":
            data = zlib.decompressobj(31).decompress(data)
        return [sorted(size for size in sizes if size != 1) for sizes in _claims(format_name, data)]
    except (struct.error, zlib.error):  # there is no whole header
        return []


def _claims(format_name, data):
    if format_name == "NRRD":
        return _numbers_after(rb"\nsizes: *", data)
    if format_name == "MetaImage":
        return _numbers_after(rb"DimSize *= *", data)
    if format_name == "VTK legacy":
        return _numbers_after(rb"\nDIMENSIONS +", data)
    if format_name == "VTK XML":
        extents = _numbers_after(rb"WholeExtent=\"", data)
        return [[high - low + 1 for low, high in zip(e[::2], e[1::2])] for e in extents]
    if format_name == "MGH":
        return [struct.unpack_from(">4i", data, 4)]
    if format_name == "GIPL":
        return [[size for size in struct.unpack_from(">4H", data) if size]]
    if format_name == "MRC":
        return [struct.unpack_from(order + "3i", data) for order in "<>"]
    form, at = ("8q", 16) if format_name == "NIfTI-2" else ("8h", 40)
    dims = [struct.unpack_from(order + form, data, at) for order in "<>"]
    return [dim[1:1 + dim[0]] for dim in dims if 0 < dim[0] < 8]


def _numbers_after(pattern, data):
    return [list(map(int, m.group(1).split())) for m in re.finditer(pattern + rb"((?:[+-]?\d+[ \t]*)+)", data)]
