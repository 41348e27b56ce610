# SPDX-License-Identifier: Apache-2.0
"""The version of this package and of the firmware that belongs to it.

Generated from protocol.toml by generate_protocol.py: do not edit.
"""

__version__ = "0.1.0"
