# SPDX-License-Identifier: Apache-2.0
"""Motion of the firmware measured on the simulated chip against an independent reference."""
