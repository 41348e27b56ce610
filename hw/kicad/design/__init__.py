# SPDX-License-Identifier: CERN-OHL-P-2.0
"""The board's schematic and layout, written as text."""
