# SPDX-License-Identifier: Apache-2.0
"""What tests on the simulated chip share."""
