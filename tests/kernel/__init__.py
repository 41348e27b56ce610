# SPDX-License-Identifier: Apache-2.0
"""A real Linux kernel as host of the simulated device."""
