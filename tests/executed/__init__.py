# SPDX-License-Identifier: Apache-2.0
"""Which firmware the simulated tests have executed."""
