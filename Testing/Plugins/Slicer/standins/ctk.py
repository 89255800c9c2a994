# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for ctk."""
import qt


class ctkCollapsibleButton(qt.Object):
    PROPERTIES = ("text", "collapsed")
