# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong, as Python exceptions and warnings."""


class MeshingError(RuntimeError):
    """The image cannot be meshed; the message is the program's: what is wrong, and what to do."""


class ArgumentError(MeshingError, ValueError):
    """An argument is wrong, or does not go with another one or with the image."""


class MeshingCancelled(RuntimeError):
    """The progress callback returned False."""


class FileError(OSError):
    """A file cannot be read or written; the message says which and why."""


class MeshingWarning(UserWarning):
    """The mesh was made, but not quite as asked: a label was lost, say, or a size was raised."""
