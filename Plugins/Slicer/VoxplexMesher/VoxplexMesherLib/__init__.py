# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the module: Table (of parameters), Logic (no Slicer needed), Scene (Slicer's nodes), Program (runs voxplex),
ModuleLogic (these together, by a parameter node), Widget (the panel), SelfTest (inside Slicer)."""
