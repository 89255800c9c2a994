# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Phantoms and image files, written by hand so that the tests do not read what ITK wrote.

Arrays are indexed [k, j, i] (z, y, x), those with several time frames [n, k, j, i]. A geometry is an
origin, a spacing and a 3 x 3 matrix whose columns are the directions of the axes, all in LPS, and the
time of the first frame and from frame to frame.
"""
import gzip
import struct
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Geometry:
    origin: tuple = (0.0, 0.0, 0.0)
    spacing: tuple = (1.0, 1.0, 1.0)
    direction: np.ndarray = field(default_factory=lambda: np.eye(3))
    first_time: float = 0.0
    time_step: float = 1.0

    def times(self, frames):
        return self.first_time + self.time_step * np.arange(frames)

    def physical(self, index):
        """Physical points of continuous indices (i, j, k)."""
        steps = np.asarray(self.direction) @ np.diag(self.spacing)
        return np.asarray(self.origin) + np.asarray(index) @ steps.T

    def voxel_volume(self):
        return abs(np.linalg.det(np.asarray(self.direction) @ np.diag(self.spacing)))


def ball(size=24, radius=8.0, center=None, label=1, dtype=np.uint8):
    """A ball of one label in a cube of background."""
    center = center or ((size - 1) / 2,) * 3
    z, y, x = np.mgrid[:size, :size, :size]
    inside = (x - center[0]) ** 2 + (y - center[1]) ** 2 + (z - center[2]) ** 2 <= radius**2
    return (inside * label).astype(dtype)


def two_labels(size=24, radius=9.0, lower=3, upper=7, dtype=np.uint8):
    """A ball whose halves z < middle and z >= middle have two labels."""
    image = ball(size, radius, label=lower, dtype=dtype)
    image[size // 2:][image[size // 2:] > 0] = upper
    return image


def moving_balls(frames=5, size=20, radius=5.0, labels=(2, 6), dtype=np.uint8):
    """Two balls that do not touch: the first grows, the second wanders along x and shrinks."""
    z, y, x = np.mgrid[:size, :size, :size]
    array = np.zeros((frames, size, size, size), dtype=dtype)
    for n in range(frames):
        progress = n / (frames - 1)
        for label, center, r in ((labels[0], (0.32, 0.3, 0.3), 0.8 * radius + 0.2 * radius * progress),
                                 (labels[1], (0.6 + 0.08 * progress, 0.7, 0.65), radius - 0.15 * radius * progress)):
            c = [share * (size - 1) for share in center]
            array[n][(x - c[0]) ** 2 + (y - c[1]) ** 2 + (z - c[2]) ** 2 <= r * r] = label
    return array


_NRRD_TYPES = {
    "u1": "uint8", "i1": "int8", "u2": "uint16", "i2": "int16", "u4": "uint32", "i4": "int32",
    "u8": "uint64", "i8": "int64", "f4": "float", "f8": "double",
}


def write_nrrd(path, array, geometry=None, components=False, header_lines=None, key_values=None):
    """header_lines replaces or adds fields; components: the last axis of array is one of them.

    A fourth axis is a list."""
    geometry = geometry or Geometry()
    spatial = array.ndim - (1 if components else 0)
    steps = np.asarray(geometry.direction) @ np.diag(geometry.spacing)
    vectors = ["(%r,%r,%r)" % tuple(float(c) for c in steps[:, a]) for a in range(min(3, spatial))]
    vectors = (["none"] if components else []) + vectors + ["none"] * (spatial - 3)
    fields = {
        "type": _NRRD_TYPES[array.dtype.str[1:]],
        "dimension": str(array.ndim),
        "space": "left-posterior-superior",
        "sizes": " ".join(str(n) for n in array.shape[::-1]),
        "space directions": " ".join(vectors),
        "kinds": " ".join((["vector"] if components else []) + ["domain"] * min(3, spatial) +
                          ["list"] * (spatial - 3)),
        "endian": "little",
        "encoding": "gzip",
        "space origin": "(%r,%r,%r)" % tuple(float(c) for c in geometry.origin),
    }
    for name, value in (header_lines or {}).items():
        if value is None:
            fields.pop(name, None)
        else:
            fields[name] = value
    data = array.astype(array.dtype.newbyteorder("<")).tobytes()
    if fields["encoding"] == "gzip":
        data = gzip.compress(data, 1)
    head = "NRRD0005\n" + "".join("%s: %s\n" % item for item in fields.items())
    head += "".join("%s:=%s\n" % item for item in (key_values or {}).items())
    with open(path, "wb") as file:
        file.write(head.encode() + b"\n" + data)
    return str(path)


def write_space_time_nrrd(path, array, geometry=None, header_lines=None):
    """Four axes in a space of four dimensions."""
    geometry = geometry or Geometry()
    steps = np.asarray(geometry.direction) @ np.diag(geometry.spacing)
    vectors = ["(%r,%r,%r,0)" % tuple(float(c) for c in steps[:, a]) for a in range(3)]
    return write_nrrd(path, array, geometry, header_lines={
        "space": "left-posterior-superior-time",
        "space directions": " ".join(vectors + ["(0,0,0,%r)" % geometry.time_step]),
        "space origin": "(%r,%r,%r,%r)" % (*(float(c) for c in geometry.origin), geometry.first_time),
        "kinds": "space space space time",
        **(header_lines or {})})


def write_sequence(path, array, geometry=None, header_lines=None, key_values=None):
    """As 3D Slicer writes a sequence of volumes: a list of frames as the fastest axis."""
    geometry = geometry or Geometry()
    times = " ".join(repr(float(t)) for t in geometry.times(len(array)))
    keys = {"axis 0 index type": "numeric", "axis 0 index values": times} if key_values is None else key_values
    return write_nrrd(path, np.moveaxis(array, 0, -1), geometry, components=True, key_values=keys, header_lines={
        "kinds": "list domain domain domain", "labels": '"time" "" "" ""', **(header_lines or {})})


def write_metaimage(path, array, geometry=None, header_lines=None):
    geometry = geometry or Geometry()
    direction, origin, spacing = np.asarray(geometry.direction), list(geometry.origin), list(geometry.spacing)
    if array.ndim == 4:
        direction = np.block([[direction, np.zeros((3, 1))], [np.zeros((1, 3)), np.ones((1, 1))]])
        origin, spacing = origin + [geometry.first_time], spacing + [geometry.time_step]
    types = {"u1": "MET_UCHAR", "i2": "MET_SHORT", "u2": "MET_USHORT", "f4": "MET_FLOAT"}
    # TransformMatrix lists the directions of the axes one after the other.
    fields = {
        "ObjectType": "Image",
        "NDims": str(array.ndim),
        "BinaryData": "True",
        "BinaryDataByteOrderMSB": "False",
        "TransformMatrix": " ".join(repr(float(c)) for c in direction.T.ravel()),
        "Offset": " ".join(repr(float(c)) for c in origin),
        "ElementSpacing": " ".join(repr(float(c)) for c in spacing),
        "DimSize": " ".join(str(n) for n in array.shape[::-1]),
        "ElementType": types[array.dtype.str[1:]],
        "ElementDataFile": "LOCAL",
    }
    fields.update(header_lines or {})
    with open(path, "wb") as file:
        file.write("".join("%s = %s\n" % item for item in fields.items()).encode())
        file.write(array.astype(array.dtype.newbyteorder("<")).tobytes())
    return str(path)


def write_nifti(path, array, geometry=None, pixdim=None):
    """Compressed if the path ends in .gz. The sform and the qform hold the geometry in RAS; seconds."""
    geometry = geometry or Geometry()
    codes = {"u1": (2, 8), "i2": (4, 16), "i4": (8, 32), "f4": (16, 32), "f8": (64, 64), "u2": (512, 16)}
    code, bits = codes[array.dtype.str[1:]]
    flip = np.diag([-1.0, -1.0, 1.0])
    rotation = flip @ np.asarray(geometry.direction)
    matrix = rotation @ np.diag(geometry.spacing)
    origin = flip @ np.asarray(geometry.origin)
    qfac = 1.0 if np.linalg.det(rotation) > 0 else -1.0
    proper = rotation @ np.diag([1.0, 1.0, qfac])
    b, c, d = _quaternion(proper)
    dims = [array.ndim] + list(array.shape[::-1]) + [1] * (7 - array.ndim)
    steps = [qfac] + list(pixdim or [*geometry.spacing, geometry.time_step]) + [1.0] * 4
    header = bytearray(348)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, *dims)
    struct.pack_into("<2h", header, 70, code, bits)
    struct.pack_into("<8f", header, 76, *steps[:8])
    struct.pack_into("<f", header, 108, 352.0)
    struct.pack_into("<f", header, 112, 1.0)
    struct.pack_into("<B", header, 123, 2 + 8)
    struct.pack_into("<f", header, 136, geometry.first_time)
    struct.pack_into("<2h", header, 252, 1, 1)
    struct.pack_into("<6f", header, 256, b, c, d, *origin)
    for row in range(3):
        struct.pack_into("<4f", header, 280 + 16 * row, *matrix[row], origin[row])
    struct.pack_into("4s", header, 344, b"n+1\0")
    data = bytes(header) + b"\0" * 4 + array.astype(array.dtype.newbyteorder("<")).tobytes()
    with open(path, "wb") as file:
        file.write(gzip.compress(data, 1) if str(path).endswith(".gz") else data)
    return str(path)


def _quaternion(rotation):
    """b, c, d of the unit quaternion of a rotation matrix, with a >= 0."""
    values, vectors = np.linalg.eigh(np.array([
        [rotation[0, 0] - rotation[1, 1] - rotation[2, 2], 0, 0, 0],
        [rotation[0, 1] + rotation[1, 0], rotation[1, 1] - rotation[0, 0] - rotation[2, 2], 0, 0],
        [rotation[0, 2] + rotation[2, 0], rotation[1, 2] + rotation[2, 1],
         rotation[2, 2] - rotation[0, 0] - rotation[1, 1], 0],
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
         rotation[1, 0] - rotation[0, 1], np.trace(rotation)],
    ]) / 3.0)
    b, c, d, a = vectors[:, np.argmax(values)]
    return (b, c, d) if a >= 0 else (-b, -c, -d)


def write_dicom_series(folder, array, geometry=None, series="1.2.826.0.1.3680043.2.1125.1.1", number=1):
    """One uncompressed CT slice a file; uint16 voxels."""
    geometry = geometry or Geometry()
    direction = np.asarray(geometry.direction)
    paths = []
    for k, image in enumerate(array.astype("<u2")):
        instance = "%s.%d" % (series, k + 1)
        position = geometry.physical((0, 0, k))
        # The row direction is that of axis i.
        cosines = list(direction[:, 0]) + list(direction[:, 1])
        data = b"".join([
            _element(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2"),
            _element(0x0008, 0x0018, "UI", instance),
            _element(0x0008, 0x0060, "CS", "CT"),
            _element(0x0010, 0x0010, "PN", "Phantom"),
            _element(0x0020, 0x000D, "UI", "1.2.826.0.1.3680043.2.1125.1"),
            _element(0x0020, 0x000E, "UI", series),
            _element(0x0020, 0x0011, "IS", str(number)),
            _element(0x0020, 0x0013, "IS", str(k + 1)),
            _element(0x0020, 0x0032, "DS", "\\".join("%.10g" % c for c in position)),
            _element(0x0020, 0x0037, "DS", "\\".join("%.10g" % c for c in cosines)),
            _element(0x0028, 0x0002, "US", 1),
            _element(0x0028, 0x0004, "CS", "MONOCHROME2"),
            _element(0x0028, 0x0010, "US", image.shape[0]),
            _element(0x0028, 0x0011, "US", image.shape[1]),
            _element(0x0028, 0x0030, "DS", "%.10g\\%.10g" % (geometry.spacing[1], geometry.spacing[0])),
            _element(0x0028, 0x0100, "US", 16),
            _element(0x0028, 0x0101, "US", 16),
            _element(0x0028, 0x0102, "US", 15),
            _element(0x0028, 0x0103, "US", 0),
            _element(0x7FE0, 0x0010, "OW", image.tobytes()),
        ])
        meta = b"".join([
            _element(0x0002, 0x0001, "OB", b"\0\1"),
            _element(0x0002, 0x0002, "UI", "1.2.840.10008.5.1.4.1.1.2"),
            _element(0x0002, 0x0003, "UI", instance),
            _element(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1"),
            _element(0x0002, 0x0012, "UI", "1.2.826.0.1.3680043.2.1125.9"),
        ])
        length = _element(0x0002, 0x0000, "UL", len(meta))
        path = folder / ("%s-%03d.dcm" % (series.replace(".", "_"), k))
        path.write_bytes(b"\0" * 128 + b"DICM" + length + meta + data)
        paths.append(path)
    return paths


def _element(group, element, representation, value):
    if isinstance(value, str):
        value = value.encode()
        if len(value) % 2:
            value += b"\0" if representation == "UI" else b" "
    elif isinstance(value, int):
        value = struct.pack("<H" if representation == "US" else "<I", value)
    head = struct.pack("<2H2s", group, element, representation.encode())
    if representation in ("OB", "OW"):
        return head + struct.pack("<HI", 0, len(value)) + value
    return head + struct.pack("<H", len(value)) + value
