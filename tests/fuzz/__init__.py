# SPDX-License-Identifier: Apache-2.0
"""Nonsense for the firmware: structure-aware, seeded, repeatable."""
