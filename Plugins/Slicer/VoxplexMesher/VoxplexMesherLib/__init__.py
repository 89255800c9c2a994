# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the module: Logic (no Slicer needed), Scene (Slicer's nodes),
ModuleLogic (both together, by a parameter node), Widget (the panel), SelfTest (inside Slicer)."""
