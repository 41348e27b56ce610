# SPDX-License-Identifier: Apache-2.0
"""The firmware on a simulated chip."""
