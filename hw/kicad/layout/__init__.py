# SPDX-License-Identifier: CERN-OHL-P-2.0
"""The board's layout: where parts stand, copper drawn by hand, silkscreen."""
